"""Verdicts, and what a run must warn of."""

from __future__ import annotations

import math
import random
from typing import Any

from ..scene import Judge, Row, Scene, Vec, at, norm, sub
from .base import codes, end_of, fault, second


def tubes(random_: random.Random) -> tuple[Scene, Judge]:
    """Two tubes of rest curvature, one in the other: stable or not as their natural frequencies say."""
    scene = fault("false_unstable")
    scene["rods"]["outer"]["rest"]["bending_y"] = random_.uniform(-6, 6)
    scene["rods"]["inner"]["rest"]["bending_y"] = random_.uniform(-10, 10)
    scene["time"]["step"] = random_.choice([0.02, 0.05, 0.1])
    scene["couplings"] = scene["couplings"][:random_.randint(2, 4)]
    del scene["actuators"]

    def judge(rows: list[Row], report: Any) -> list[str]:
        modal = {key: value for key, value in scene.items() if key != "time"}
        other, of_other = second({**modal, "analysis": "modal", "modes": 3})
        if end_of(report) != "done" or end_of(of_other) != "done":
            return []
        if norm(sub(at(rows[-1], "tip"), at(other[0], "tip"))) > 1e-4:
            return []  # another equilibrium
        told, first = "unstable" in codes(report), other[1]["mode.frequency"]
        return [f"told as {'unstable' if told else 'stable'}, lowest frequency {first:.4g} Hz"] if told != (first < 0) else []

    return scene, judge


def curled(random_: random.Random) -> tuple[Scene, Judge]:
    """A rod that a moment curls many times: there always is an equilibrium."""
    scene = fault("path_limit")
    scene["rods"]["arm"]["material"]["young"] = 10 ** random_.uniform(3.8, 5)
    scene["rods"]["arm"]["sections"] = random_.randint(2, 12)
    scene["loads"]["t"]["moment"] = [0, random_.choice([-1, 1]) * 10 ** random_.uniform(-2, 0), 0]

    def judge(rows: list[Row], report: Any) -> list[str]:
        end = end_of(report)
        return [] if end == "done" or end.startswith("path_unfinished") else [end]

    return scene, judge


def one_linearisation(random_: random.Random) -> tuple[Scene, Judge]:
    """One long step by one linearisation, beside the same step converged."""
    scene = fault("long_step")
    h = random_.choice([0.1, 0.3, 1.0])
    scene["time"] = {"step": h, "duration": h}
    scene["solids"]["finger"]["material"]["young"] = 10 ** random_.uniform(5.3, 6.3)
    scene["actuators"]["pull"]["displacement"] = {"times": [0, h], "values": [0, random_.uniform(1e-3, 12e-3)]}

    def judge(rows: list[Row], report: Any) -> list[str]:
        other, of_other = second({**scene, "newton": {}})
        if end_of(report) != "done" or end_of(of_other) != "done":
            return []
        rest: Vec = (0.095, 0.0, 0.0)
        off = norm(sub(at(rows[-1], "tip"), at(other[-1], "tip"))) / norm(sub(at(other[-1], "tip"), rest))
        told = max((own["worst"] for own in report["warnings"] if own["code"] == "linearised_step_off"), default=0.0)
        if off > 0.07 and abs(max(told, 0.05) - off) > 0.05 + 0.3 * off:  # (less than 0.05 is not told)
            return [f"{100 * off:.3g} % off, told {100 * told:.3g} %"]
        return [f"{100 * off:.3g} % off, told {100 * told:.3g} %"] if off < 0.02 and told > 0.07 else []

    return scene, judge


def ripple(random_: random.Random) -> tuple[Scene, Judge]:
    """A bent rod slides out of a channel of points: ripples of its force are told where they are more than a tenth."""
    scene = fault("sleeve_ripple")
    rod = scene["rods"]["rod"]
    rod["sections"], rod["order"] = random_.choice([(35, 0), (70, 0), (105, 0), (140, 0), (280, 0), (70, 1), (140, 1), (70, 2)])
    push = random_.uniform(0.3, 0.8)
    scene["loads"]["p"]["force"] = [0, 0, push]
    scene["actuators"]["pull"]["displacement"]["values"] = [0, random_.uniform(0.012, 0.03)]

    def judge(rows: list[Row], report: Any) -> list[str]:
        if end_of(report) != "done":
            return [end_of(report)]
        most = max(abs(abs(row["base.x"] / (push * math.sin(row["turn.y"]))) - 1) for row in rows if row["time"] > 0.201)
        told = "sliding_force_ripples" in codes(report)
        return [f"ripples of {100 * most:.3g} %, told: {told}"] if told != (most > 0.1) and not 0.07 < most < 0.13 else []

    return scene, judge


def channel(random_: random.Random) -> tuple[Scene, Judge]:
    """Friction of a rod that bends in a channel of points grows with their number: that is told."""
    scene = fault("sleeve_friction")
    points = scene["couplings"][0]["slide"]["points"]
    every = random_.choice([1, 2, 4])
    scene["couplings"][0]["slide"]["points"] = points[::every]
    scene["couplings"][0]["slide"]["friction"] = random_.uniform(0.05, 0.4)
    scene["rods"]["rod"]["sections"] = 70
    scene["time"]["duration"] = 0.3
    scene["loads"]["p"]["factor"]["times"] = [0, 0.2]
    scene["actuators"]["pull"]["displacement"] = {"times": [0, 0.2, 0.3], "values": [0, 0, 0.001]}

    def judge(rows: list[Row], report: Any) -> list[str]:
        if end_of(report) != "done":
            return []
        told = [own for own in report["warnings"] if own["code"] == "friction_of_points"]
        return [] if told and f"({5 * every} mm)" in told[0]["message"] else ["not told"]

    return scene, judge


def pulled_far(random_: random.Random) -> tuple[Scene, Judge]:
    """The finger's cable is pulled a little, or so far that the finger passes through itself."""
    scene = fault("passes_through_itself")
    far = random_.random() < 0.5
    scene["solids"]["finger"]["material"]["young"] = 10 ** random_.uniform(5.5, 6.2)
    scene["time"] = {"step": 0.01, "duration": 1.2}
    pull = random_.uniform(0.055, 0.065) if far else random_.uniform(2e-3, 12e-3)
    scene["actuators"]["pull"]["displacement"]["values"] = [0, pull]

    def judge(rows: list[Row], report: Any) -> list[str]:
        if end_of(report) != "done":
            return []
        if far and "solid_crosses_itself" not in codes(report):
            return ["the finger passes through itself without a word"]
        return [own["message"] for own in report["warnings"]] if not far else []

    return scene, judge
