"""Constraints that depend on each other, and rods that cannot give."""

from __future__ import annotations

import math
import random
from typing import Any

from ..scene import Judge, Row, Scene, Vec, circle
from .base import FULL, codes, end_of, fault


def tendons(random_: random.Random) -> tuple[Scene, Judge]:
    """Opposite tendons told opposite lengths, or such that they contradict each other; a weight may twist the arm."""
    length, radius = random_.uniform(0.1, 0.4), random_.uniform(4e-3, 12e-3)
    distance = radius * random_.uniform(0.3, 0.9)
    pairs = random_.randint(1, 3)
    gives = random_.random() < 0.3
    off = random_.choice([0.0, 0.0, 0.0, 0.3e-3])
    pulls = [distance * random_.uniform(-1, 1) for _ in range(pairs)]
    if pairs == 3:  # the third one's are those of the two others together
        pulls[2] = pulls[1] - pulls[0]
    analysis = random_.choice(["dynamic", "quasi_static", "static"])
    young = 10 ** random_.uniform(5.5, 7)
    scene: Scene = {
        "analysis": analysis, "time": {"step": 0.01, "duration": 0.3}, "view": {"interval": 1000},
        "rods": {"arm": {"path": [[0, 0, 0], [length, 0, 0]], "sections": random_.randint(1, 6), "order": random_.choice([0, 1]),
                         "strains": FULL[:4] if gives else FULL[:3], "section": {"circle": {"radius": radius}},
                         "material": {"young": young, "poisson": 0.5, "density": 1100, "damping": 0.02}}},
        "actuators": {}, "outputs": {"tip": {"rod": "arm", "at": 0.999 * length}}}
    for i, pull in enumerate(pulls):
        for side in (0, 1):
            told = (pull if side == 0 else -pull) + (off if i == 0 and side == 1 else 0.0)
            scene["actuators"][f"t{i}{side}"] = {
                "rod": "arm", "tendon": {"distance": distance, "angle": f"{60 * i + 180 * side} deg"},
                "displacement": {"times": [0, 0.2], "values": [0, told]}}
    loaded = random_.random() < 0.5
    if loaded:
        weight = young * circle(radius) / length**2
        scene["loads"] = {"weight": {"rod": "arm", "force": [random_.uniform(-1, 1) * weight for _ in range(3)],
                                     "factor": {"times": [0, 0.2], "values": [0, 1]}}}

    def judge(rows: list[Row], report: Any) -> list[str]:
        end = end_of(report)
        if off and (not gives or pairs > 1):  # (with elongation both pairs say how much there is of it)
            if not end.startswith("inconsistent") or "actuators.t00" not in end:
                return [f"contradicting lengths end with {end}"]
            return []
        if end != "done":
            return [end]
        last = rows[-1]
        depends = not gives or pairs > 1
        if ("redundant_constraints" in codes(report)) != depends:
            return [f"told as redundant: {not depends}"]
        largest = max(abs(last[f"t{i}{side}.force"]) for i in range(pairs) for side in (0, 1))
        limit = 20 * young * circle(radius) / (length * distance)
        told = [f"{largest:.3g} N, more than {limit:.3g} N"] if largest > limit else []
        for i in range(0 if gives or loaded else pairs):  # the least that do the same are opposite
            both = last[f"t{i}0.force"] + last[f"t{i}1.force"]
            if abs(both) > 1e-6 * max(largest, 1e-9):
                told.append(f"forces of pair {i} add up to {both:.3g} N of {largest:.3g} N")
        return told

    return scene, judge


def welds(random_: random.Random) -> tuple[Scene, Judge]:
    """Rods without shear welded side by side at several places."""
    length, radius = random_.uniform(0.1, 0.3), random_.uniform(2e-3, 6e-3)
    count, at_once = random_.randint(2, 3), random_.randint(2, 4)
    young = 10 ** random_.uniform(5.5, 8)
    scene: Scene = {"time": {"step": 5e-3, "duration": 0.1}, "view": {"interval": 1000}, "rods": {}, "couplings": [],
                    "outputs": {"t": {"rod": "r1", "at": 0.999 * length}},
                    "loads": {"p": {"rod": "r1", "force": [0, 0, young * circle(radius) / length**2]}}}
    for i in range(count):
        y = 2.5 * radius * i
        scene["rods"][f"r{i}"] = {
            "path": [[0, y, 0], [length, y, 0]], "sections": at_once, "strains": FULL[:4],
            "section": {"circle": {"radius": radius}},
            "material": {"young": young, "poisson": 0.5, "density": 1000, "damping": 0.02}}
        if i > 0:
            for k in range(at_once):
                s = length * (k + 1) / at_once
                scene["couplings"].append({"tie": {"rod": f"r{i - 1}", "at": s, "other": f"r{i}", "other_at": s,
                                                   "about": ["x", "y", "z"]}})

    def judge(rows: list[Row], report: Any) -> list[str]:
        told = [own for own in report["warnings"] if own["code"] == "redundant_constraints"]
        if end_of(report) != "done":
            return [end_of(report)]
        if not told:
            return ["not told as redundant"]
        return [] if any("shear" in own["remedy"] for own in told) else ["the remedy does not name shear"]

    return scene, judge


def endwise(random_: random.Random) -> tuple[Scene, Judge]:
    """A rod that cannot stretch is fed straight into something."""
    length, radius = random_.uniform(0.05, 0.3), random_.uniform(0.5e-3, 4e-3)
    scene = fault("rod_endwise")
    gap = random_.uniform(2e-3, 20e-3)
    turn = random_.choice([0.0, random_.uniform(-3, 3)])
    way: Vec = (math.cos(turn), math.sin(turn), 0.0)
    scene["rods"]["r"].update(path=[[0, 0, 0], [length * u for u in way]], sections=random_.randint(1, 8),
                              strains=random_.choice([FULL[:3], FULL[1:3], FULL[:3] + FULL[4:]]),
                              section={"circle": {"radius": radius}})
    scene["time"]["step"] = random_.choice([1e-3, 5e-3, 1e-2])
    scene["frames"]["feed"]["motion"] = {"times": [0, 0.5], "translate": [[0, 0, 0], [2 * gap * u for u in way]]}
    if random_.random() < 0.5:
        ball = random_.uniform(5e-3, 30e-3)
        scene["obstacles"]["ball"] = {"sphere": {"radius": ball},
                                      "pose": {"translate": [(length + radius + gap + ball) * u for u in way]}}
    else:
        scene["obstacles"]["ball"] = {"plane": {"point": [(length + radius + gap) * u for u in way],
                                                "normal": [-u for u in way]}}
    scene["outputs"]["tip"]["at"] = length * (1 - 1e-9)

    def judge(rows: list[Row], report: Any) -> list[str]:
        end = end_of(report)
        if not end.startswith("inconsistent") or "elongation" not in end:
            return [f"ends with {end}"]
        return [f"{row['f.normal']:.3g} N" for row in rows if row["f.normal"] > 1e3][:1]

    return scene, judge
