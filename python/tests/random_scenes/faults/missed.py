"""Contact that was missed, and forces of rods that touch."""

from __future__ import annotations

import copy
import math
import random
from typing import Any

from ..scene import Judge, Row, Scene, Vec, at, norm, sub
from ..throws import judge_rod_peg, rod_points
from .base import codes, end_of, fault, second


def hook(random_: random.Random) -> tuple[Scene, Judge]:
    """A frame starts to move a rod sideways at a peg."""
    scene = fault("contact_frame_moves")
    radius, peg = random_.uniform(0.5e-3, 2e-3), random_.uniform(1e-3, 4e-3)
    x, gap, way = random_.uniform(0.01, 0.04), random_.uniform(0.5e-3, 5e-3), random_.uniform(0.02, 0.12)
    h = random_.choice([1e-3, 2e-3, 5e-3, 1e-2])
    scene["time"]["step"] = h
    scene["rods"]["r"]["section"]["circle"]["radius"] = radius
    scene["frames"]["hand"]["motion"] = {"times": [0, 0.1], "translate": [[0, 0, 0], [0, way, 0]]}
    y = radius + peg + gap
    scene["obstacles"]["peg"] = {"cylinder": {"radius": peg, "length": 0.04}, "pose": {"translate": [x, y, 0]}}
    outputs, names = rod_points(0.06, 49)
    scene["outputs"] = {**outputs, "f": {"between": ["r", "peg"]}}
    axis: tuple[Vec, Vec] = ((x, y, -0.02), (x, y, 0.02))
    looks = judge_rod_peg(names, axis, lambda t: (0.0, 0.0, 0.0), peg + radius, 0.6 * min(radius, peg) + 1.5e-4)

    def judge(rows: list[Row], report: Any) -> list[str]:
        told = looks(rows, report)

        def touches(those: list[Row]) -> bool:
            return any(row["f.contacts"] > 0 for row in those)

        if end_of(report) == "done" and way > y + 0.01 and not touches(rows):  # it may swing round the peg
            shorter, _ = second({**scene, "time": {**scene["time"], "step": 0.1 * h}})
            if touches(shorter):
                told.append("the rod never touches the peg")
        return told

    return scene, judge


def pushed(random_: random.Random) -> tuple[Scene, Judge]:
    """A light rod that slides along itself is pushed at a wall."""
    scene = fault("contact_rod_pushed")
    force, gap, radius = 10 ** random_.uniform(-1, 0.7), random_.uniform(1e-3, 0.03), random_.uniform(0.5e-3, 3e-3)
    h = random_.choice([1e-3, 2e-3, 5e-3, 1e-2, 2e-2])
    scene["time"] = {"step": h, "duration": 20 * h if h > 2e-3 else 0.1}
    scene["rods"]["r"].update(sections=random_.randint(1, 8), section={"circle": {"radius": radius}})
    scene["loads"]["push"]["force"] = [force, 0, 0]
    scene["obstacles"]["wall"]["plane"]["point"] = [0.1 + radius + gap, 0, 0]

    def judge(rows: list[Row], report: Any) -> list[str]:
        told = [f"{1e3 * (row['tip.x'] - 0.1 - gap):.3g} mm in the wall" for row in rows
                if row["tip.x"] - 0.1 - gap > 0.25 * 2 * radius][:1]
        if end_of(report) != "done":
            return told + [end_of(report)]
        if abs(rows[-1]["f.normal"] - force) > 1e-3 * force:
            told.append(f"{rows[-1]['f.normal']:.4g} N instead of {force:.4g} N")
        return told

    return scene, judge


def loop(random_: random.Random) -> tuple[Scene, Judge]:
    """A rubber loop around a peg is pulled by its two ends: it stays on the peg."""
    scene = fault("contact_loop_pulled")
    peg = random_.uniform(3e-3, 6e-3)
    h = random_.choice([2e-3, 5e-3, 1e-2])
    scene["time"] = {"step": h, "duration": 0.2}
    scene["rods"]["band"]["material"]["young"] = 10 ** random_.uniform(5.7, 6.7)
    scene["frames"]["left"]["motion"]["translate"] = [[0, 0, 0], [-random_.uniform(0.02, 0.08), 0, 0]]
    scene["obstacles"]["peg"]["cylinder"]["radius"] = peg
    scene["contact"] = {"friction": random_.choice([0, 0.3])}

    def judge(rows: list[Row], report: Any) -> list[str]:
        return [f"the loop is through the peg at t = {row['time']:.4g} s" for row in rows
                if row["mid.x"] < 0.022 + 0.5 * peg][:1]

    return scene, judge


def pin_rod(random_: random.Random, scene: Scene, pins: list[tuple[float, float, float]]) -> None:
    """Pins across the rod at x, z, with a radius."""
    for i, (x, z, radius) in enumerate(pins):
        scene["obstacles"][f"p{i}"] = {"cylinder": {"radius": radius, "length": 0.05},
                                       "pose": {"rotate": [math.pi / 2, 0, 0], "translate": [x, 0, z]}}
    scene["rods"]["rod"]["sections"] = random_.randint(60, 100)


def tunnel(random_: random.Random) -> tuple[Scene, Judge]:
    """At rest, a rod that is pressed against a pin."""
    scene = fault("tunnel")
    pin, x = random_.uniform(1e-3, 4e-3), random_.uniform(0.1, 0.3)
    z = 0.002 + pin + random_.choice([0.0, random_.uniform(0, 2e-3)])
    pin_rod(random_, scene, [(x, z, pin)])
    scene["time"]["step"] = random_.choice([0.02, 0.05, 0.1])
    scene["loads"]["p"]["force"] = [0, 0, random_.uniform(0.2, 1.2)]
    outputs, names = rod_points(0.45, 181, "rod")
    scene["outputs"] = {**outputs, "c0": {"between": ["rod", "p0"]}}
    axis: tuple[Vec, Vec] = ((x, -0.025, z), (x, 0.025, z))
    looks = judge_rod_peg(names, axis, lambda t: (0.0, 0.0, 0.0), pin + 0.002, 0.6 * min(pin, 0.002) + 1e-4)

    def judge(rows: list[Row], report: Any) -> list[str]:
        told = looks(rows, report)
        if end_of(report) == "done" and not rows[-1]["c0.normal"] > 0.0:
            told.append("the pin does not hold the rod")
        return told

    return scene, judge


def two_pins(random_: random.Random) -> tuple[Scene, Judge]:
    """A rod between two pins, without friction: the force along it at its base is P sin(theta) of its tip."""
    scene = fault("contact_two_pins")
    pins = [random_.uniform(1.5e-3, 4e-3) for _ in range(2)]
    x = random_.uniform(0.15, 0.25)
    pin_rod(random_, scene, [(x, 0.002 + pins[0], pins[0]), (x - random_.uniform(0.02, 0.06), -0.002 - pins[1], pins[1])])
    push = random_.uniform(0.2, 0.8)
    scene["analysis"] = random_.choice(["dynamic", "quasi_static"])
    scene["time"] = {"step": 0.01 if scene["analysis"] == "dynamic" else 0.05, "duration": 1.0}
    scene["loads"]["p"]["force"] = [0, 0, push]
    scene["outputs"] = {name: scene["outputs"][name] for name in ("turn", "basef")}

    def judge(rows: list[Row], report: Any) -> list[str]:
        if end_of(report) != "done":
            return []
        along = push * math.sin(-rows[-1]["turn.y"])
        if abs(rows[-1]["basef.x"] - along) > 0.02 * along:
            return [f"{rows[-1]['basef.x']:.4g} N along the rod, right is {along:.4g} N"]
        return []

    return scene, judge


def sleeve(random_: random.Random) -> tuple[Scene, Judge]:
    """A rod bent out of a slit between two flat faces: the force along it is P sin(theta) of its tip."""
    scene = fault("contact_sleeve")
    aligned = random_.random() < 0.5  # the mouth stands where a section ends, at 5/9 of the rod
    scene["rods"]["rod"].update(sections=random_.choice([90, 135, 180]) if aligned else random_.randint(9, 100),
                                order=0 if aligned else random_.randint(0, 2))
    push, slit = random_.uniform(0.2, 0.9), 10 ** random_.uniform(-5, -4)
    scene["loads"]["p"]["force"] = [0, 0, push]
    for name, side in (("top", 1), ("bottom", -1)):
        scene["obstacles"][name]["pose"]["translate"] = [0.1, 0, side * (0.012 + slit)]
    scene["outputs"] = {"turn": scene["outputs"]["turn"]}

    def judge(rows: list[Row], report: Any) -> list[str]:
        if end_of(report) != "done":
            return []
        along, found = push * math.sin(-rows[-1]["turn.y"]), rows[-1]["pull.force"]
        allowed = 0.02 if aligned else 0.13 if "touched_force_off" not in codes(report) else math.inf
        return [f"{found:.4g} N along the rod, right is {along:.4g} N"] if abs(found - along) > allowed * along else []

    return scene, judge


def folds(random_: random.Random) -> tuple[Scene, Judge]:
    """A peg draws a clamped rod into a fold within a section, around it."""
    scene = fault("rod_folds_around_peg")
    rod, peg, hand = scene["rods"]["r"], scene["obstacles"]["peg"], scene["frames"]["hand"]["motion"]
    length = rod["path"][1][0]
    duration = scene["time"]["duration"] = 0.02
    scene["time"]["step"] = random_.choice([1e-3, 2e-3])
    scene["contact"]["friction"] = random_.choice([0, 0.3, 0.8])
    rod["material"]["young"] *= 10 ** random_.uniform(-1, 1)
    rod["order"], rod["sections"] = random_.choice([0, 0, 1]), random_.randint(6, 14)
    radius, thickness = 10 ** random_.uniform(-3.7, -3.1), 10 ** random_.uniform(-3.7, -3.1)
    rod["section"]["circle"]["radius"] = radius
    peg["cylinder"]["radius"] = thickness
    x, y = length * random_.uniform(0.2, 0.6), peg["pose"]["translate"][1]
    peg["pose"]["translate"] = [x, y, 0]
    way = hand["translate"][1][1] * random_.uniform(0.5, 2)
    hand.update(times=[0, duration], translate=[[0, 0, 0], [0, way, 0]])
    tilt, half = peg["pose"]["rotate"][1], 0.5 * peg["cylinder"]["length"]
    along = (half * math.sin(tilt), 0.0, half * math.cos(tilt))
    axis: tuple[Vec, Vec] = ((x - along[0], y, -along[2]), (x + along[0], y, along[2]))
    scene["outputs"], names = rod_points(length, 289)
    edge = 0.56 * min(radius, thickness)
    return scene, judge_rod_peg(names, axis, lambda t: (0.0, way * t / duration, 0.0),
                                thickness + radius, edge)


def beside_post(random_: random.Random) -> tuple[Scene, Judge]:
    """At rest a rod sags; what stands where it never comes changes nothing."""
    scene = fault("sag_beside_post")
    length, radius = random_.uniform(0.05, 0.15), random_.uniform(0.4e-3, 1.5e-3)
    scene["rods"]["rod"].update(path=[[0, 0, 0.15], [length, 0, 0.15]], sections=random_.randint(3, 12),
                                section={"circle": {"radius": radius}})
    scene["outputs"]["tip"]["at"] = length * (1 - 1e-9)
    scene["time"]["step"] = random_.choice([0.02, 0.05, 0.1, 0.25])
    scene["obstacles"]["post"]["pose"]["translate"] = [random_.uniform(-0.05, 0.1), -random_.uniform(0.02, 0.1), 0.1]
    alone = copy.deepcopy(scene)
    del alone["obstacles"]

    def judge(rows: list[Row], report: Any) -> list[str]:
        other, of_other = second(alone)
        if end_of(of_other) != "done" or "unstable" in codes(report) | codes(of_other):
            return []
        if end_of(report) != "done":
            return [end_of(report)]
        off = norm(sub(at(rows[-1], "tip"), at(other[-1], "tip")))
        return [f"the post moves the tip by {off:.3g} m"] if off > 1e-7 * length else []

    return scene, judge
