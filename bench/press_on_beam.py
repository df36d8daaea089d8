#!/usr/bin/env python3
"""What it takes to press a ball on a soft beam.

A ball of 12 mm goes 40 mm down on a cantilever of 100 x 30 x 30 mm: three meshes, three places, with and without
friction, at rest and in motion.

    bench/press_on_beam.py -o out/press_on_beam           all of them
    bench/press_on_beam.py --only dynamic 0.5             words that the names of runs have

One line a run: how it ended, steps of the grid, parts that they were made in, iterations a step, seconds, the tip.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import csv
import itertools
import json
import os
import statistics
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "scripts"))
from box_meshes import boxes, write_vtk  # noqa: E402

MESHES = ((6, 2, 2), (10, 3, 3), (16, 5, 5))
PLACES = (0.1, 0.08, 0.05)  # [m] along the beam
FRICTIONS = (0.0, 0.5)
STEPS = {"quasi_static": (0.01, 0.05), "dynamic": (0.01,)}  # [s]

Name = tuple[str, tuple[int, int, int], float, float, float]


def scene_of(name: Name) -> dict[str, Any]:
    analysis, cells, place, friction, step = name
    beam = {"mesh": mesh_name(cells), "scale": 0.001, "density": 1070,
            "material": {"law": "corotational", "young": 490e3, "poisson": 0.34},
            "fixed": {"plane": {"point": [0, 0, 0], "normal": [1, 0, 0], "within": 1e-6}}}
    if analysis == "dynamic":
        beam["rayleigh"] = {"mass": 0.1, "stiffness": 0.02}
    return {"time": {"step": step, "duration": 1.0}, "analysis": analysis, "contact": {"friction": friction},
            "view": {"interval": 1000},
            "frames": {"hand": {"motion": {"times": [0, 1], "translate": [[0, 0, 0], [0, 0, -0.04]]}}},
            "solids": {"beam": beam},
            "obstacles": {"ball": {"sphere": {"radius": 0.012}, "pose": {"translate": [place, 0.003, 0.03]},
                                   "frame": "hand"}},
            "outputs": {"tip": {"solid": "beam", "point": [0.1, 0, 0]}}}


def mesh_name(cells: tuple[int, int, int]) -> str:
    return "beam{}x{}x{}.vtk".format(*cells)


def run(name: Name, program: str, folder: Path) -> dict[str, Any]:
    title = "-".join(mesh_name(part)[:-4] if isinstance(part, tuple) else str(part) for part in name)
    scene = folder / f"{title}.yaml"
    scene.write_text(json.dumps(scene_of(name), indent=1))
    begin = time.time()
    done = subprocess.run([program, "run", scene, "-o", folder / title, "--quiet", "--force", "--threads", "1"],
                          capture_output=True, text=True)
    seconds = time.time() - begin
    with open(folder / title / "signals.csv", newline="") as stream:
        rows = list(csv.DictReader(stream))
    step = name[-1]
    iterations = sum(int(row["newton"] or 0) for row in rows)
    grid = int(float(rows[-1]["time"]) / step + 1e-6)
    return {"name": title, "end": "done" if done.returncode == 0 else done.stderr.split("Stopped")[-1].split("\n")[0],
            "grid": grid, "parts": len(rows) - 1, "iterations": iterations, "seconds": seconds,
            "tip": float(rows[-1]["tip.z"])}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, default=Path("out/press_on_beam"))
    parser.add_argument("--program", default=str(ROOT / "build/release/sinew"))
    parser.add_argument("--only", nargs="*", default=[])
    parser.add_argument("--step", type=float, help="[s] instead of those of the list")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    arguments = parser.parse_args()
    arguments.output.mkdir(parents=True, exist_ok=True)
    for cells in MESHES:
        nodes, tetrahedra = boxes(np.array(cells), np.array([100.0, 30.0, 30.0]), lambda x, y, z: True)
        write_vtk(arguments.output / mesh_name(cells), "beam, mm", nodes - [0, 15, 15], tetrahedra)
    names: list[Name] = [
        (analysis, cells, place, friction, step)
        for analysis, steps in STEPS.items()
        for cells, place, friction in itertools.product(MESHES, PLACES, FRICTIONS)
        for step in ((arguments.step,) if arguments.step else steps)
    ]
    names = [name for name in names
             if all(word in (*map(str, name), mesh_name(name[1])[:-4]) for word in arguments.only)]
    ends: dict[tuple[str, float], list[dict[str, Any]]] = {}
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        for name, row in zip(names, pool.map(lambda own: run(own, arguments.program, arguments.output), names)):
            per_step = row["iterations"] / max(1, row["grid"])
            print(f"{row['name']:40} {row['grid']:4} steps {row['parts']:5} parts {per_step:6.2f} iterations a step "
                  f"{row['seconds']:6.1f} s  tip {1e3 * row['tip']:7.2f} mm  {row['end']}", flush=True)
            ends.setdefault((name[0], name[3]), []).append({**row, "per_step": per_step})
    for (analysis, friction), rows in ends.items():
        done = [row for row in rows if row["end"] == "done"]
        print(f"{analysis}, friction {friction}: {len(done)} of {len(rows)} done, "
              f"{sum(row['iterations'] for row in rows)} iterations, {sum(row['parts'] for row in rows)} parts of "
              f"{sum(row['grid'] for row in rows)} steps, median {statistics.median(row['per_step'] for row in rows):.2f} "
              f"iterations a step, {sum(row['seconds'] for row in rows):.1f} s")


if __name__ == "__main__":
    main()
