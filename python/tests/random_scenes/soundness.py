"""Whether `sinew check` calls sound what a run at rest can begin, and only that.

    python -m random_scenes.soundness --count 2500 --program build/release/sinew    (in python/tests)

Scenes of rods, bodies and solids at random, of which many are held badly: free bases, bases that a motor frees, ties
about some axes, solids held along some. `check` must refuse those whose first step is `singular`, and none whose first step is made.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import json
import os
import random
import subprocess
import sys
import tempfile
from collections import Counter
from pathlib import Path
from typing import Any

from .scene import ROOT, Scene, circle

MOTIONS = ["x", "y", "z", "turn_x", "turn_y", "turn_z"]
STRAINS = ["torsion", "bending_y", "bending_z", "elongation", "shear_y", "shear_z"]
AXES = ["x", "y", "z"]


def some(random_: random.Random, of: list[str], least: int = 0) -> list[str]:
    return sorted(random_.sample(of, random_.randint(least, len(of))), key=of.index)


def direction(random_: random.Random) -> list[float]:
    """Along an axis more often than not, where what is singular is so exactly."""
    if random_.random() < 0.6:
        axis, sign = random_.randrange(3), random_.choice([-1, 1])
        return [sign * float(i == axis) for i in range(3)]
    return [random_.uniform(-1, 1) for _ in range(3)]


def rod(random_: random.Random) -> Scene:
    start, along = [random_.uniform(-0.1, 0.1) for _ in range(3)], direction(random_)
    made: Scene = {
        "path": [start, [x + 0.1 * u for x, u in zip(start, along)]], "sections": random_.randint(1, 6),
        "strains": random_.choice([STRAINS[:3], STRAINS[:4], STRAINS]), "section": {"circle": {"radius": 0.002}},
        "material": {"young": 10 ** random_.uniform(5.5, 8), "poisson": 0.45,
                     "density": random_.choice([0, 1100, 1100])}}
    base = random_.choice(["clamped", "clamped", "free", "some", "some"])
    if base == "some":
        made["base"] = some(random_, MOTIONS, 1)
    elif base == "free":
        made["base"] = "free"
    return made


def tie(random_: random.Random, scene: Scene) -> Scene:
    """Of a rod to the ground, a body or another rod."""
    rods, bodies = list(scene["rods"]), list(scene.get("bodies", {}))
    made: Scene = {"rod": rods[0], "at": random_.choice([0.0, 0.05, 0.1]),
                   "along": some(random_, AXES), "about": some(random_, AXES)}
    if not made["along"] and not made["about"]:
        made["along"] = AXES
    to = random_.choice(["ground", "body", "rod"])
    if to == "body" and bodies:
        made["body"] = bodies[0]
    elif to == "rod" and len(rods) > 1:
        made["other"], made["other_at"] = rods[1], random_.choice([0.0, 0.1])
    return {"tie": made}


def motor(random_: random.Random, name: str) -> Scene:
    drive = random_.choice([{"force": random_.uniform(-1, 1)}, {"displacement": random_.uniform(-0.005, 0.005)},
                            {"torque": random_.uniform(-1e-3, 1e-3)}, {"angle": random_.uniform(-0.2, 0.2)}])
    return {"rod": name, "axis": random_.choice(AXES), **drive}


def solid(random_: random.Random) -> Scene:
    held: Any = {"box": [[-0.001, -0.008, -0.008], [0.001, 0.008, 0.008]]}
    if random_.random() < 0.5:
        held["axes"] = some(random_, AXES, 1)
    made: Scene = {"mesh": "finger.vtk", "scale": 0.001, "density": 1070, "fixed": held,
                   "material": {"law": random_.choice(["corotational", "neo_hookean"]), "young": 3e5, "poisson": 0.4}}
    return made


def scene_of(random_: random.Random) -> Scene:
    analysis = random_.choice(["quasi_static", "quasi_static", "static", "modal"])
    scene: Scene = {"analysis": analysis, "view": {"interval": 1000}, "rods": {}}
    if random_.random() < 0.7:
        scene["gravity"] = [9.81 * x for x in direction(random_)]
    if analysis == "modal":
        scene["modes"] = 1
    else:
        scene["time"] = {"step": 0.01, "duration": 0.01}
    for i in range(random_.randint(1, 3)):
        scene["rods"][f"r{i}"] = rod(random_)
    if random_.random() < 0.3:
        scene["bodies"] = {"b": {"sphere": {"radius": 0.01}, "density": 1000,
                                 "pose": {"translate": scene["rods"]["r0"]["path"][1]}}}
        if random_.random() < 0.5:
            scene.setdefault("couplings", []).append(
                {"tie": {"rod": "r0", "at": 0.1, "body": "b", "along": AXES, "about": some(random_, AXES)}})
    if random_.random() < 0.2:
        scene["solids"] = {"s": solid(random_)}
        if random_.random() < 0.5:
            scene["rods"]["c"] = {**rod(random_), "path": [[0, 0, 0.002], [0.09, 0, 0.002]]}
            scene.setdefault("couplings", []).append(
                {"slide": {"rod": "c", "solid": "s", "points": [0.03, 0.06, 0.09],
                           "anchor_tip": random_.choice(["none", "position", "pose"])}})
    for _ in range(random_.choice([0, 0, 1, 2])):
        scene.setdefault("couplings", []).append(tie(random_, scene))
    if random_.random() < 0.4:
        scene["actuators"] = {"m": motor(random_, random_.choice(list(scene["rods"])))}
    if random_.random() < 0.3:
        bends = 1e6 * circle(0.002) / 0.01
        scene["loads"] = {"p": {"rod": "r0", "force": [bends * x for x in direction(random_)],
                                "follower": random_.random() < 0.3}}
    scene["outputs"] = {"tip": {"rod": "r0"}}
    return scene


def compare(number: int, program: str, keep: Path | None) -> tuple[int, str, str]:
    """What `check` says of a scene, and how its first step ends."""
    scene = scene_of(random.Random(f"soundness {number}"))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for body in scene.get("solids", {}).values():
            (folder / body["mesh"]).write_bytes((ROOT / "examples/meshes" / body["mesh"]).read_bytes())
        (folder / "scene.yaml").write_text(json.dumps(scene, indent=1))

        def called(*arguments: str) -> subprocess.CompletedProcess[str]:
            command = [program, *arguments]
            return subprocess.run(command, check=False, cwd=folder, capture_output=True, text=True, timeout=120)

        try:
            check = called("check", "scene.yaml")
            run = called("run", "scene.yaml", "-o", "out", "--quiet")
        except subprocess.TimeoutExpired:
            return number, "too long", "after 120 s"
        said = {0: "sound", 2: "refused"}.get(check.returncode, f"exit code {check.returncode}")
        report = folder / "out" / "report.json"
        if not report.exists():
            end = "refused" if run.returncode == 2 else f"exit code {run.returncode}"
        else:
            ended = json.loads(report.read_text())["end"]
            end = ended.get("status", "done")
            if end == "singular" and ended["time_s"] > 1e-9 * scene.get("time", {"duration": 0.0})["duration"]:
                end = "singular later"
        agrees = end not in ("refused", "singular") if said == "sound" else said == "refused" and end != "done"
        if not agrees and keep:
            keep.mkdir(parents=True, exist_ok=True)
            (keep / f"{number}.yaml").write_text(json.dumps(scene, indent=1))
        return number, f"{said}, {end}" + ("" if agrees else ": DISAGREE"), check.stderr[:200] + run.stderr[:300]


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--program", default=str(ROOT / "build/release/sinew"))
    parser.add_argument("--keep", type=Path, help="a folder for scenes on which they disagree")
    arguments = parser.parse_args()
    ends: Counter[str] = Counter()
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        numbers = range(arguments.first, arguments.first + arguments.count)
        for number, end, text in pool.map(lambda i: compare(i, arguments.program, arguments.keep), numbers):
            ends[end] += 1
            if "DISAGREE" in end or "too long" in end or "exit" in end:
                print(f"{number}: {end}: {' '.join(text.split())}", flush=True)
    for end, count in sorted(ends.items()):
        print(f"{end:40} {count}")
    wrong = sum(count for end, count in ends.items() if "DISAGREE" in end or "too long" in end or "exit" in end)
    print(f"{wrong} of {arguments.count} disagree")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
