"""Frames that move things: energy from nowhere is told of only where steps are too long."""

from __future__ import annotations

import random
from typing import Any

from .faults.base import second
from .scene import Judge, Row, Scene, from_nowhere, shape_of


def gain_of(report: Any) -> Any:
    """The warning of energy that has come from nowhere, if there is one."""
    return next((warning for warning in report["warnings"] if warning["code"] == "energy_gain"), None)


def moving_frame(random_: random.Random) -> tuple[Scene, Judge]:
    """What a frame moves: a rod's base, its tip, a floor with a body on it, a held end of a solid."""
    h = random_.choice([1e-3, 5e-3, 1e-2])
    steps = random_.randint(10, 40)
    u = [random_.gauss(0, 0.03) for _ in range(3)]
    turn = [random_.gauss(0, 0.5) for _ in range(3)]
    half = 0.5 * h * steps
    motion = {"times": [0, half, 2 * half], "translate": [[0, 0, 0], u, random_.choice([u, [0, 0, 0]])],
              "rotate": [[0, 0, 0], turn, turn]}
    scene: Scene = {"time": {"step": h, "duration": h * steps}, "frames": {"hand": {"motion": motion}},
                    "view": {"interval": 1000}, "gravity": random_.choice([[0, 0, 0], [0, 0, -9.81]])}
    what = random_.choice(["rod", "rod", "tie", "floor", "solid"])
    if what in ("rod", "tie"):
        scene["rods"] = {"r": {
            "path": [[0, 0, 0.1], [0.15, 0, 0.1]], "sections": random_.randint(2, 8), "order": random_.choice([0, 1]),
            "section": {"circle": {"radius": random_.uniform(1e-3, 4e-3)}},
            "material": {"young": 10 ** random_.uniform(5.5, 8), "poisson": 0.45, "density": 1100,
                         "damping": random_.choice([0, 1e-2])}}}
        scene["outputs"] = {"tip": {"rod": "r", "at": 0.1499}}
        if what == "rod":
            scene["rods"]["r"]["frame"] = "hand"
        else:
            scene["rods"]["r"]["strains"] = ["torsion", "bending_y", "bending_z", "elongation"]
            motion["translate"] = [[0, 0, 0], [-abs(u[0]), u[1], u[2]], [-abs(u[0]), u[1], u[2]]]
            motion["rotate"] = [[0, 0, 0]] * 3
            scene["couplings"] = [{"tie": {"rod": "r", "frame": "hand"}}]
    elif what == "floor":
        shape, _, around = shape_of(random_, 0.02)
        motion["rotate"] = [[0, 0, 0]] * 3
        scene["gravity"] = [0, 0, -9.81]
        scene["bodies"] = {"b": {**shape, "density": 1000, "pose": {"translate": [0, 0, around + 0.001]}}}
        scene["obstacles"] = {"floor": {"box": {"size": [2, 2, 0.05]}, "pose": {"translate": [0, 0, -0.025]},
                                        "frame": "hand"}}
        scene["contact"] = {"friction": random_.choice([0.0, 0.5])}
        scene["outputs"] = {"b": {"body": "b"}}
    else:
        scene["solids"] = {"s": {"mesh": "block.vtk", "scale": 0.001,
                                 "material": {"law": random_.choice(["corotational", "neo_hookean"]),
                                              "young": 10 ** random_.uniform(4.5, 6), "poisson": 0.4}, "density": 1000,
                                 "rayleigh": {"mass": 0.1, "stiffness": 0.005},
                                 "fixed": {"plane": {"point": [0, 0, 0], "normal": [0, 0, 1], "within": 1e-4},
                                           "frame": "hand"}}}
        scene["outputs"] = {"e": {"solid": "s", "point": [0, 0, 0]}}

    def judge(rows: list[Row], report: Any) -> list[str]:
        gain = gain_of(report)
        if not gain:
            return from_nowhere(rows)
        # Long steps do add energy to what buckles or tilts, the less the shorter they are; work that is not counted is
        # missing in short ones, too.
        time = {**scene["time"], "step": h / 8}
        shorter = second({**scene, "time": time})[1]
        if shorter is None:
            return [gain["message"]]
        left = gain_of(shorter)
        return [gain["message"]] if left and left["worst"] > 0.25 * gain["worst"] else []

    return scene, judge
