#!/usr/bin/env python3
"""Plain use of contact: which runs go through.

A body of those below is pressed by an obstacle that a frame moves, or comes to lie on one: pulled by a displacement, by
a force (or a pressure), or by its weight; with and without friction, at rest and in motion, in long and short steps.

    bench/contact_runs.py -o out/contact_runs                    all of them
    bench/contact_runs.py -o out/contact_runs --only beam10 ball some: words that the names of runs have
    bench/contact_runs.py -o out/contact_runs --resume           those that runs.csv there does not have yet
    bench/contact_runs.py --table AFTER.csv [BEFORE.csv]         the table of a file of results, beside another's

Every run is one line of runs.csv: how it ended, why, how far it came, how many steps and iterations it took.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import csv
import itertools
import json
import math
import os
import shutil
import signal
import subprocess
import sys
import tempfile
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Callable

import numpy as np

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "scripts"))
from box_meshes import boxes, write_vtk  # noqa: E402

MESHES = ROOT / "examples/meshes"
Scene = dict[str, Any]
Row = dict[str, Any]
Vec = tuple[float, float, float]

OBSTACLES = ("post", "wall", "ball", "box", "hull", "mesh")
DRIVES = ("frame", "displacement", "force", "weight")
FRICTIONS = (0.0, 0.5)
STEPS = {"quasi_static": {"long": 0.05, "short": 0.01}, "dynamic": {"long": 0.01, "short": 0.002}}
DURATION = 1.0  # [s] until all has moved
TILT = 0.35  # [rad] of a wall, away from where the body is held


@dataclass
class Body:
    """A body that may be pressed: its scene without contact, and the place of its surface that an obstacle stands
    before, at `gap`, in direction `out`; `along` is the body's axis."""

    scene: Scene
    touched: str
    place: Vec
    out: Vec
    along: Vec
    gap: float  # [m]
    depth: float  # [m] that an obstacle goes on after it touches
    displacement: Callable[[Scene], None]
    force: Callable[[Scene], None]


def ramp(value: float) -> dict[str, Any]:
    return {"times": [0, DURATION], "values": [0, value]}


def actuator(name: str, kind: str, value: float) -> Callable[[Scene], None]:
    def drive(scene: Scene) -> None:
        scene["actuators"][name][kind] = ramp(value)

    return drive


def moved_base(translation: Vec) -> Callable[[Scene], None]:
    """What holds the body carries it there."""

    def drive(scene: Scene) -> None:
        scene["frames"] = {"base": {"motion": {"times": [0, DURATION], "translate": [[0, 0, 0], list(translation)]}}}
        for solid in scene.get("solids", {}).values():
            solid["fixed"] = [{**solid["fixed"], "frame": "base"}]
        for rod in scene.get("rods", {}).values():
            rod["frame"] = "base"

    return drive


def beam(cells: tuple[int, int, int]) -> Body:
    """A cantilever, with a cable above its middle."""
    solid = {"mesh": "beam{}x{}x{}.vtk".format(*cells), "scale": 0.001, "density": 1070, "rayleigh": {"stiffness": 0.02},
             "material": {"law": "corotational", "young": 490e3, "poisson": 0.34},
             "fixed": {"plane": {"point": [0, 0, 0], "normal": [1, 0, 0], "within": 1e-6}}}
    cable = {"path": [[0, 0, 0.008], [0.1, 0, 0.008]], "sections": 10, "section": {"circle": {"radius": 0.5e-3}},
             "material": {"young": 1e9, "poisson": 0.4, "density": 1100}}
    scene = {"solids": {"beam": solid}, "rods": {"cable": cable}, "actuators": {"pull": {"rod": "cable"}},
             "couplings": [{"slide": {"rod": "cable", "solid": "beam", "points": 9, "anchor_tip": "position"}}],
             "outputs": {"tip": {"solid": "beam", "point": [0.1, 0, 0]}}}
    return Body(scene, "beam", (0.09, 0.003, 0.015), (0, 0, 1), (1, 0, 0), 1e-3, 0.03,
                actuator("pull", "displacement", 4e-3), actuator("pull", "force", 10.0))


def example(name: str) -> Scene:
    import yaml

    return yaml.safe_load((ROOT / "examples" / f"{name}.yaml").read_text())


def finger() -> Body:
    scene = example("finger")
    del scene["actuators"]["pull"]["displacement"]
    return Body(scene, "finger", (0.085, 0.0, 0.0075), (0, 0, 1), (1, 0, 0), 3e-3, 0.02,
                actuator("pull", "displacement", 8e-3), actuator("pull", "force", 6.0))


def trunk() -> Body:
    scene = example("reach")
    del scene["targets"], scene["newton"]
    scene["actuators"] = {"pull": {"rod": "right"}}
    for name in ("back", "left", "front"):
        del scene["rods"][name]
    scene["couplings"] = scene["couplings"][:1]
    return Body(scene, "trunk", (0.0086, 0.0, 0.185), (1, 0, 0), (0, 0, 1), 3e-3, 0.03,
                actuator("pull", "displacement", 10e-3), actuator("pull", "force", 3.0))


def chambers() -> Body:
    scene = example("chambers")
    del scene["loads"], scene["outputs"]["root"], scene["outputs"]["wall"]
    scene["solids"]["bar"]["rayleigh"] = {"stiffness": 0.02}

    def pressure(own: Scene) -> None:
        own["loads"] = {"air": {"solid": "bar", "group": "chambers", "pressure": 30e3, "factor": ramp(1.0)}}

    return Body(scene, "bar", (0.055, 0.0, -0.008), (0, 0, -1), (1, 0, 0), 1e-3, 0.01, moved_base((0, 0, -0.01)),
                pressure)


def tendon_arm() -> Body:
    scene = example("tendon_arm")
    scene["actuators"] = {"side": {"rod": "arm", "tendon": {"distance": "20 mm", "angle": "0 deg"}}}
    return Body(scene, "arm", (0.5, 0.0, 0.03), (0, 0, 1), (1, 0, 0), 0.01, 0.1,
                actuator("side", "displacement", 8e-3), actuator("side", "tension", 8.0))


def cable() -> Body:
    rod = {"path": [[0, 0, 0], [0.2, 0, 0]], "sections": 20, "section": {"circle": {"radius": 1e-3}},
           "material": {"young": 20e6, "poisson": 0.4, "density": 1100, "damping": "10 ms"}}

    def tip_force(own: Scene) -> None:
        own["loads"] = {"push": {"rod": "cable", "at": 0.2, "force": [0, 0, -0.02], "factor": ramp(1.0)}}

    return Body({"rods": {"cable": rod}, "outputs": {"tip": {"rod": "cable", "at": 0.2}}}, "cable", (0.15, 0.0, -1e-3),
                (0, 0, -1), (1, 0, 0), 2e-3, 0.03, moved_base((0, 0, -0.03)), tip_force)


BODIES: dict[str, Callable[[], Body]] = {
    "beam6": lambda: beam((6, 2, 2)), "beam10": lambda: beam((10, 3, 3)), "beam16": lambda: beam((16, 5, 5)),
    "finger": finger, "trunk": trunk, "chambers": chambers, "tendon_arm": tendon_arm, "cable": cable,
}


def cross(a: Vec, b: Vec) -> Vec:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def turn_z_to(axis: Vec) -> list[float]:
    """The angles about x and then about y that bring z to a unit vector."""
    return [-math.asin(max(-1.0, min(1.0, axis[1]))), math.atan2(axis[0], axis[2]), 0.0]


def obstacle(kind: str, body: Body) -> Scene:
    """An obstacle that is `gap` away from the place that it is to touch."""
    size = 0.1 if body.touched == "arm" else 0.02
    side = cross(body.along, body.out)
    shapes = {
        "post": ({"capsule": {"radius": 0.4 * size, "length": 10 * size}}, side, 0.4 * size),
        "wall": ({"plane": {"normal": [-math.cos(TILT) * n - math.sin(TILT) * t for n, t in zip(body.out, body.along)]}},
                 (0.0, 0.0, 1.0), 0.0),
        "ball": ({"sphere": {"radius": 0.6 * size}}, (0.0, 0.0, 1.0), 0.6 * size),
        "box": ({"box": {"size": [1.5 * size] * 3}}, (0.0, 0.0, 1.0), 0.75 * size),
        "hull": ({"mesh": {"file": "ring.stl", "scale": 0.05 * size, "hull": True}}, side, 1.75 * size),
        "mesh": ({"mesh": {"file": "ring.stl", "scale": 0.05 * size}}, side, 1.75 * size),
    }
    shape, axis, reach = shapes[kind]
    far = body.gap + reach
    pose = {"rotate": turn_z_to(axis), "translate": [p + far * n for p, n in zip(body.place, body.out)]}
    return {**shape, "pose": pose}


def scene_of(body_name: str, kind: str, drive: str, friction: float, analysis: str, step: float) -> Scene:
    body = BODIES[body_name]()
    scene = body.scene
    scene["analysis"] = analysis
    scene["time"] = {"step": step, "duration": DURATION if analysis == "quasi_static" else 1.5 * DURATION}
    scene["gravity"] = [9.81 * n for n in body.out] if drive == "weight" else [0, 0, 0]
    scene["view"] = {"interval": 1000}
    scene["contact"] = {"friction": friction}
    scene["obstacles"] = {"hard": obstacle(kind, body)}
    inside = [rod for rod in scene.get("rods", {}) if rod != body.touched]
    scene["contact"]["pairs"] = [{"between": [body.touched, "hard"]},
                                 *({"between": [rod, "hard"], "off": True} for rod in inside)]
    scene["outputs"]["press"] = {"between": [body.touched, "hard"]}
    if drive == "frame":
        way = [-(body.gap + body.depth) * n for n in body.out]
        scene["frames"] = {"hand": {"motion": {"times": [0, DURATION], "translate": [[0, 0, 0], way]}}}
        scene["obstacles"]["hard"]["frame"] = "hand"
    elif drive == "displacement":
        body.displacement(scene)
    elif drive == "force":
        body.force(scene)
    if drive in ("frame", "weight"):
        for one in scene.get("actuators", {}).values():  # stay loose
            one["tension" if "tendon" in one else "force"] = 0.0
    return scene


def names() -> list[tuple[str, str, str, float, str, str]]:
    return [(body, kind, drive, friction, analysis, step)
            for body, kind, drive, friction, analysis in itertools.product(BODIES, OBSTACLES, DRIVES, FRICTIONS, STEPS)
            for step in STEPS[analysis]]


COLUMNS = ("body", "obstacle", "drive", "friction", "analysis", "step", "end", "status", "reached", "steps", "iterations",
           "contacts", "force", "tip", "seconds", "detail")


def timed(command: list[Any], limit: float) -> tuple[int, str, float]:
    """How a command ended (as subprocess has it), what it said on stderr, and the processor time that it took, in
    seconds; it is killed after `limit` of them."""
    with tempfile.TemporaryFile("w+") as said:
        process = subprocess.Popen(["prlimit", f"--cpu={math.ceil(limit)}", "--", *command], stdout=subprocess.DEVNULL,
                                   stderr=said)
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        said.seek(0)
        return process.returncode, said.read(), round(usage.ru_utime + usage.ru_stime, 2)


def run(name: tuple[str, str, str, float, str, str], program: str, folder: Path, limit: float) -> Row:
    body, kind, drive, friction, analysis, step = name
    scene = scene_of(body, kind, drive, friction, analysis, STEPS[analysis][step])
    title = "-".join(str(part) for part in name)
    (folder / f"{title}.yaml").write_text(json.dumps(scene, indent=1))
    out = folder / title
    row: Row = dict(zip(COLUMNS, name))
    ended, words, row["seconds"] = timed([program, "run", folder / f"{title}.yaml", "-o", out, "--quiet", "--force",
                                          "--threads", "1"], limit)
    if ended == -signal.SIGKILL:
        row["end"], row["detail"] = "time", f"not through after {limit:g} s"
    else:
        row["end"] = {0: "done", 3: "stopped"}.get(ended, f"exit {ended}")
        row["detail"] = " ".join(words.split())[-200:] if ended else ""
    row["status"] = ""
    if (out / "signals.csv").exists():
        with open(out / "signals.csv", newline="") as stream:
            rows = list(csv.DictReader(stream))
        if rows:
            last = rows[-1]
            row.update(reached=float(last["time"]) / scene["time"]["duration"], steps=len(rows) - 1,
                       iterations=sum(int(line["newton"] or 0) for line in rows),
                       contacts=max(int(float(line["press.contacts"])) for line in rows),
                       force=f"{float(last['press.normal']):.4g}",
                       tip=" ".join(f"{float(last['tip.' + axis]):.5f}" for axis in "xyz"))
    if (out / "report.json").exists():
        row["status"] = json.loads((out / "report.json").read_text())["end"].get("status", "")
    shutil.rmtree(out, ignore_errors=True)
    return row


def read(path: Path) -> list[Row]:
    with open(path, newline="") as stream:
        return list(csv.DictReader(stream))


def key(row: Row) -> tuple[str, ...]:
    return tuple(str(row[column]) for column in COLUMNS[:6])


def table(rows: list[Row], before: list[Row]) -> str:
    """How many runs went through, for each body and drive, and the time of those that went through before as well."""
    old = {key(row): row for row in before}
    count: Counter[tuple[str, str, str]] = Counter()
    done: Counter[tuple[str, str, str]] = Counter()
    done_before: Counter[tuple[str, str, str]] = Counter()
    for row in rows:
        cell = (row["body"], row["analysis"], row["drive"])
        count[cell] += 1
        done[cell] += row["end"] == "done"
        done_before[cell] += key(row) in old and old[key(row)]["end"] == "done"

    def text(cell: tuple[str, str, str]) -> str:
        if not count[cell]:
            return ""
        return (f"{done_before[cell]} -> " if before else "") + f"{done[cell]} of {count[cell]}"

    columns = [(analysis, drive) for analysis in STEPS for drive in DRIVES]
    lines = ["| body | " + " | ".join(f"{a}, {d}" for a, d in columns) + " |", "|---" * (len(columns) + 1) + "|"]
    for body in BODIES:
        lines.append(f"| {body} | " + " | ".join(text((body, *column)) for column in columns) + " |")
    through = sum(done.values())
    lines.append(f"\n{through} of {len(rows)} ({100.0 * through / max(1, len(rows)):.1f} %) went through.")
    ends = Counter((row["end"], row["status"]) for row in rows if row["end"] != "done")
    lines += [f"{number} {end} {status}" for (end, status), number in ends.most_common()]
    missed = sum(row["end"] == "done" and not int(row["contacts"] or 0) for row in rows)
    lines.append(f"{missed} of those that went through never touched.")
    if before:
        both = [(row, old[key(row)]) for row in rows if key(row) in old]
        lines.append(f"Before, {sum(b['end'] == 'done' for _, b in both)} of the same {len(both)} went through.")
        both = [(a, b) for a, b in both if a["end"] == b["end"] == "done"]
        for what in ("seconds", "iterations"):
            now, then = (sum(float(row[what] or 0) for row in one) for one in zip(*both)) if both else (0.0, 0.0)
            lines.append(f"{what} of those {len(both)} that went through both times: {then:.0f} -> {now:.0f}"
                         f" ({then / max(now, 1e-9):.1f} times fewer).")
    return "\n".join(lines)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=Path, default=Path("out/contact_runs"))
    parser.add_argument("--program", default=str(ROOT / "build/release/sinew"))
    parser.add_argument("--only", nargs="*", default=[], help="words, each of which is in the names of the runs")
    parser.add_argument("--every", type=int, default=1, help="take every n-th run only")
    parser.add_argument("--limit", type=float, default=120.0, help="[s] of processor time that a run may take")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--resume", action="store_true", help="keep the results that there are, and run the others")
    parser.add_argument("--table", type=Path, nargs="+", metavar="CSV",
                        help="print the table of these results, beside earlier ones if told, and run nothing")
    arguments = parser.parse_args()
    if arguments.table:
        print(table(read(arguments.table[0]), read(arguments.table[1]) if len(arguments.table) > 1 else []))
        return 0
    chosen = [name for name in names() if all(word in map(str, name) for word in arguments.only)][::arguments.every]
    arguments.output.mkdir(parents=True, exist_ok=True)
    for mesh in ("finger.vtk", "trunk.vtk", "chambers.msh", "ring.stl"):
        (arguments.output / "meshes").mkdir(exist_ok=True)
        for folder in (arguments.output, arguments.output / "meshes"):
            (folder / mesh).write_bytes((MESHES / mesh).read_bytes())
    for cells in ((6, 2, 2), (10, 3, 3), (16, 5, 5)):
        nodes, tetrahedra = boxes(np.array(cells), np.array([100.0, 30.0, 30.0]), lambda x, y, z: True)
        write_vtk(arguments.output / "beam{}x{}x{}.vtk".format(*cells), "beam, mm", nodes - [0, 15, 15], tetrahedra)
    results = arguments.output / "runs.csv"
    rows = read(results) if arguments.resume and results.exists() else []
    there = {key(row) for row in rows}
    chosen = [name for name in chosen if tuple(map(str, name)) not in there]
    with open(results, "a" if rows else "w", newline="") as stream:
        writer = csv.DictWriter(stream, COLUMNS, restval="")
        if not rows:
            writer.writeheader()
        with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
            work = lambda name: run(name, arguments.program, arguments.output, arguments.limit)  # noqa: E731
            for number, row in enumerate(pool.map(work, chosen), 1):
                rows.append(row)
                writer.writerow(row)
                stream.flush()
                if sys.stderr.isatty():
                    print(f"\r{number} of {len(chosen)}", end="", file=sys.stderr)
    print(table(rows, []))
    return 0


if __name__ == "__main__":
    sys.exit(main())
