"""Contact that is not there, overlaps that are, and energy from nowhere."""

from __future__ import annotations

import math
import random
from typing import Any

from ..scene import Judge, Row, Scene, Vec, at, norm, shape_of, sub
from .base import end_of, fault


def pass_by(random_: random.Random) -> tuple[Scene, Judge]:
    """A body that turns passes one that does not: nothing but inertia acts."""
    size = 10 ** random_.uniform(-2.5, -1.5)
    other, _, around = shape_of(random_, size)
    edges = [2 * size * random_.uniform(0.2, 1.5) for _ in range(3)]
    h, steps = random_.choice([1e-4, 1e-3, 5e-3]), 60

    def apart(p: Vec) -> float:
        return math.hypot(*(max(abs(x) - 0.5 * edge, 0.0) for x, edge in zip(p, edges)))

    while True:
        start: Vec = (6 * size * random_.uniform(-1, 1), 6 * size * random_.uniform(-1, 1), 6 * size * random_.uniform(-1, 1))
        end: Vec = (6 * size * random_.uniform(-1, 1), 6 * size * random_.uniform(-1, 1), 6 * size * random_.uniform(-1, 1))
        way = [tuple(a + (b - a) * i / 600 for a, b in zip(start, end)) for i in range(601)]
        least = min(apart((p[0], p[1], p[2])) for p in way)
        if around * 1.02 < least < 2 * around:
            break
    duration = h * steps
    scene: Scene = {
        "time": {"step": h, "duration": duration}, "view": {"interval": 1000},
        "bodies": {"a": {**other, "density": 1000, "pose": {"translate": list(start),
                                                            "rotate": [random_.uniform(-2, 2) for _ in range(3)]},
                         "velocity": [(b - a) / duration for a, b in zip(start, end)],
                         "spin": [random_.gauss(0, 2) / duration for _ in range(3)]},
                   "b": {"box": {"size": edges}, "density": 1000}},
        "outputs": {"a": {"body": "a"}, "b": {"body": "b"}}}

    def judge(rows: list[Row], report: Any) -> list[str]:
        if end_of(report) != "done":
            return [end_of(report)]
        told = []
        for row in rows:
            t = row["time"] / duration
            a = norm(sub(at(row, "a"), tuple(x + t * (y - x) for x, y in zip(start, end))))  # type: ignore[arg-type]
            if max(a, norm(at(row, "b"))) > 1e-7 * size:
                told.append(f"something pushes at t = {row['time']:.4g} s")
                break
        return told + [own["message"] for own in report["warnings"]]

    return scene, judge


def overlap(random_: random.Random) -> tuple[Scene, Judge]:
    """Two bodies of which the balls in them overlap."""
    size = 10 ** random_.uniform(-2.5, -1.5)
    shapes = [shape_of(random_, size) for _ in range(2)]
    inner = [0.5 * thin for _, thin, _ in shapes]
    away = [random_.gauss(0, 1) for _ in range(3)]
    far = sum(inner) * random_.uniform(0.3, 0.95)
    length = math.hypot(*away)
    places = [[0.0, 0.0, 0.0], [far * x / length for x in away]]
    scene: Scene = {
        "time": {"step": 5e-3, "duration": 0.05}, "view": {"interval": 1000},
        "bodies": {f"b{i}": {**shapes[i][0], "density": 1000,
                             "pose": {"translate": places[i], "rotate": [random_.uniform(-2, 2) for _ in range(3)]}}
                   for i in range(2)},
        "outputs": {"o": {"body": "b0"}}}

    def judge(rows: list[Row], report: Any) -> list[str]:
        for own in report["warnings"]:
            if own["code"] == "overlap_at_start":
                least = sum(inner) - far
                return [] if own["worst"] > 0.99 * least else [f"{own['value']:.3g} m told, at least {least:.3g} m"]
        return ["not told"]

    return scene, judge


def total(row: Row) -> float:
    return row["energy.kinetic"] + row["energy.elastic"] + row["energy.weight"]


def spinning(random_: random.Random) -> tuple[Scene, Judge]:
    """A body that spins is thrown on a floor."""
    scene = fault("cylinder_gains")
    shape, thin, around = shape_of(random_, random_.uniform(0.01, 0.05))
    scene["time"] = {"step": random_.choice([2e-3, 5e-3, 1e-2, 2e-2]), "duration": 1.5}
    scene["contact"] = {"friction": random_.choice([0.0, 0.2, 0.5, 1.0])}
    scene["bodies"]["b"] = {**shape, "density": 10 ** random_.uniform(2, 4),
                            "pose": {"translate": [0, 0, around + random_.uniform(0, 0.05)],
                                     "rotate": [random_.uniform(-2, 2) for _ in range(3)]},
                            "spin": [random_.gauss(0, 10) for _ in range(3)]}

    def judge(rows: list[Row], report: Any) -> list[str]:
        if end_of(report) != "done":
            return []
        told = [own["message"] for own in report["warnings"] if own["code"] == "penetration"]
        warned = any(own["code"] == "energy_gain" for own in report["warnings"])
        lowest, most = math.inf, 0.0
        for row in rows:
            most = max(most, row["energy.kinetic"] + row["energy.elastic"])
            # What the steps of a body's turning add is warned of from a thousandth on; contact does not add hundredths.
            if total(row) > lowest + (1e-2 if warned else 1e-3) * max(most, 1e-12):
                told.append(f"{total(row) - lowest:.3g} J from nowhere at t = {row['time']:.4g} s")
                break
            lowest = min(lowest, total(row))
        if rows[-1]["o.z"] < 0.5 * thin - 1e-3 * thin:
            told.append(f"it has sunk in to {rows[-1]['o.z']:.3g} m")
        return told

    return scene, judge


def struck(random_: random.Random) -> tuple[Scene, Judge]:
    """A rod falls on a cylinder: it never has more energy than it came with."""
    scene = fault("rod_impact_gain")
    turn = [random_.gauss(0, 1) for _ in range(3)]
    half = [random_.uniform(0.015, 0.04) * x / math.hypot(*turn) for x in turn]
    length = 2 * math.hypot(*half)
    scene["rods"]["r"].update(path=[[-half[0], -half[1], 0.06 - half[2]], [half[0], half[1], 0.06 + half[2]]],
                              sections=random_.randint(2, 8),
                              section={"circle": {"radius": length * random_.uniform(0.02, 0.06)}})
    scene["rods"]["r"]["material"]["young"] = 10 ** random_.uniform(5.5, 8)
    scene["obstacles"]["x"] = {"cylinder": {"radius": random_.uniform(3e-3, 1e-2), "length": random_.uniform(0.01, 0.04)},
                               "pose": {"rotate": [random_.uniform(-3, 3) for _ in range(3)]}}
    scene["time"]["step"] = random_.choice([5e-4, 1e-3, 2e-3, 5e-3])
    scene["contact"]["friction"] = random_.choice([0, 0.5])
    scene["outputs"]["p"]["at"] = 0.5 * length

    def judge(rows: list[Row], report: Any) -> list[str]:
        told = [own["message"] for own in report["warnings"] if own["code"] == "energy_gain"]
        most = max(row["energy.kinetic"] + row["energy.elastic"] for row in rows)
        lowest = math.inf
        for row in rows:
            if total(row) > lowest + 1e-3 * most:
                told.append(f"{total(row) - lowest:.3g} J from nowhere of {most:.3g} J at t = {row['time']:.4g} s")
                break
            lowest = min(lowest, total(row))
        return told

    return scene, judge


def lifted(random_: random.Random) -> tuple[Scene, Judge]:
    """A frame lifts a rod, a tie or a floor with a body on it: its work is counted."""
    name = random_.choice(["frame_lifts_rod", "frame_lifts_tie", "frame_lifts_floor"])
    scene = fault(name)
    for _, frame in scene["frames"].items():
        frame["motion"]["translate"] = [[random_.uniform(0.3, 1.2) * _length(x) for x in u]
                                        for u in frame["motion"]["translate"]]

    def judge(rows: list[Row], report: Any) -> list[str]:
        if end_of(report) != "done":
            return []
        return [own["message"] for own in report["warnings"] if own["code"] == "energy_gain"]

    return scene, judge


def _length(value: Any) -> float:
    """Of a number, or a text such as `60 mm`."""
    if isinstance(value, (int, float)):
        return float(value)
    number, unit = value.split()
    return float(number) * {"mm": 1e-3, "cm": 1e-2, "m": 1.0}[unit]
