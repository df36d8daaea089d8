"""Runs that once stopped where they should go through."""

from __future__ import annotations

import math
import random
from typing import Any

from ..scene import Judge, Row, Scene, Vec, at, from_nowhere, norm, sub
from .base import codes, end_of, fault, second


def pressed(random_: random.Random) -> tuple[Scene, Judge]:
    """At rest a ball is pressed on a soft beam: the tip is where a slow motion of the damped beam brings it."""
    scene = fault("press_on_beam")
    radius, x, y = random_.uniform(0.008, 0.02), random_.uniform(0.05, 0.1), random_.uniform(-0.006, 0.006)
    scene["time"]["step"] = random_.choice([0.01, 0.02, 0.05])
    scene["contact"]["friction"] = random_.choice([0, 0.3, 0.5])
    scene["frames"]["hand"]["motion"]["translate"] = [[0, 0, 0], [0, 0, -random_.uniform(0.015, 0.04)]]
    scene["solids"]["beam"]["material"].update(young=10 ** random_.uniform(5, 6.5), poisson=random_.uniform(0.2, 0.42))
    scene["obstacles"]["ball"] = {"sphere": {"radius": radius}, "frame": "hand",
                                  "pose": {"translate": [x, y, 0.015 + radius + 0.003]}}

    def off_motion(tip: Vec, duration: float) -> float | str:
        """By how much a motion that takes so long ends elsewhere, of how far it goes; or why it does not end."""
        slow = {**scene, "time": {"step": 1e-3 * duration, "duration": duration}, "analysis": "dynamic"}
        slow["frames"] = {"hand": {"motion": {**scene["frames"]["hand"]["motion"], "times": [0, duration]}}}
        slow["solids"] = {"beam": {**scene["solids"]["beam"], "rayleigh": {"mass": 0.1, "stiffness": 0.02}}}
        other, of_other = second(slow)
        if end_of(of_other) != "done":
            return f"in motion: {end_of(of_other)}"
        place = at(other[-1], "tip")
        return norm(sub(tip, place)) / norm(sub(place, (0.1, 0.0, 0.0)))

    def judge(rows: list[Row], report: Any) -> list[str]:
        if end_of(report) != "done":
            return [end_of(report)]
        off = off_motion(at(rows[-1], "tip"), 20.0)
        if isinstance(off, str):
            return [off]
        if {"snapped", "unstable"} & codes(report):
            return []
        if off > 0.01:  # A beam that slides off a smooth ball is late: in 1 s it comes 3 % less far.
            slower = off_motion(at(rows[-1], "tip"), 100.0)
            if isinstance(slower, str):
                return [slower]
            if slower > min(0.4 * off, 0.015):
                return [f"the tip is {100 * off:.2g} % off a slow motion's, {100 * slower:.2g} % off a slower one's"]
        return []

    return scene, judge


def thin_struck(random_: random.Random) -> tuple[Scene, Judge]:
    """A light capsule is thrown at a thin soft rod: it runs, or says what does not converge."""
    scene = fault("thin_rod_struck")
    scene["time"] = {"step": random_.choice([5e-4, 1e-3, 2.2e-3]), "duration": 0.04}
    scene["contact"]["friction"] = random_.choice([0, 0.1, 0.5])
    rod, capsule = scene["rods"]["rod"], scene["bodies"]["capsule"]
    rod.update(sections=random_.randint(4, 14), section={"circle": {"radius": random_.uniform(0.4e-3, 1.5e-3)}})
    rod["material"].update(young=10 ** random_.uniform(5.5, 7), poisson=random_.uniform(0.2, 0.47))
    capsule.update(capsule={"radius": random_.uniform(3e-3, 8e-3), "length": random_.uniform(3e-3, 0.02)},
                   density=random_.uniform(100, 1000))
    capsule["pose"] = {"translate": [random_.uniform(0.04, 0.15), random_.uniform(-5e-3, 5e-3), 0.175],
                       "rotate": [random_.uniform(-3, 3) for _ in range(3)]}
    capsule["velocity"] = [random_.gauss(0, 1), random_.gauss(0, 1), -random_.uniform(0.5, 3)]

    def judge(rows: list[Row], report: Any) -> list[str]:
        told = from_nowhere(rows) if "energy_gain" not in codes(report) else []
        why = end_of(report)
        if why != "done" and not any(name in why for name in ("rod", "capsule")):
            told.append(f"names nothing: {why}")
        return told

    return scene, judge


def free_turn(random_: random.Random) -> tuple[Scene, Judge]:
    """A tie leaves one turn of a cable's end free, which lies at the frame's origin: as the frame makes it, nothing moves."""
    scene = fault("tie_free_turn")
    axis, sag = random_.randrange(3), random_.uniform(0.03, 0.1)
    turn = [0.0, 0.0, 0.0]
    turn[axis] = math.radians(random_.uniform(100, 900)) * random_.choice([-1, 1])
    scene["frames"]["two"]["motion"]["rotate"] = [[0, 0, 0], turn]
    scene["time"]["step"] = random_.choice([0.01, 0.02, 0.05])
    scene["rods"]["cable"].update(path=[[-0.3, 0, 0], [-0.15, 0, -sag], [0, 0, 0]], sections=random_.randint(8, 24))
    scene["rods"]["cable"]["section"]["stiffness"]["matrix"][0:3] = [10 ** random_.uniform(-4.5, -3)] * 3
    free = "xyz"[axis]
    scene["couplings"][0]["tie"]["about"] = [name for name in "xyz" if name != free]
    scene["analysis"] = random_.choice(["dynamic", "quasi_static"])

    def judge(rows: list[Row], report: Any) -> list[str]:
        if end_of(report) != "done":
            return [end_of(report)]
        quiet, of_quiet = second({**scene, "frames": {"two": {"motion": {"times": [0, 4], "rotate": [[0, 0, 0]] * 2}}}})
        if end_of(of_quiet) != "done":
            return [f"without the turn: {end_of(of_quiet)}"]
        off = norm(sub(at(rows[-1], "mid"), at(quiet[-1], "mid")))
        return [f"the free turn moves the middle by {off:.3g} m"] if off > 1e-5 else []

    return scene, judge
