#!/usr/bin/env python3
"""Random legal scenes, run by the program and judged by what does not come from it.

    python/tests/random_scenes.py --kind throws --count 3000 --program build/release/sinew

Each scene follows from its kind and its number alone. `throws`: rods, bodies and solids thrown, pushed and moved at
planes, plates, pegs and balls so fast that a step moves a tenth to twenty times the thickness of the thinner one. The
judge looks at recorded places: nothing may be on the wrong side, nothing deeper in another than docs/contact.md
promises. A run may stop with a status; it may not be wrong.
"""

from __future__ import annotations

import argparse
import concurrent.futures
import csv
import json
import math
import os
import random
import subprocess
import sys
import tempfile
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Callable

Scene = dict[str, Any]
Row = dict[str, float]
Vec = tuple[float, float, float]
Judge = Callable[[list[Row], Any], list[str]]
Maker = Callable[[random.Random], tuple[Scene, Judge]]

ROOT = Path(__file__).resolve().parents[2]


def sub(a: Vec, b: Vec) -> Vec:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def dot(a: Vec, b: Vec) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vec, b: Vec) -> Vec:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def mix(a: Vec, b: Vec, t: float) -> Vec:
    return (a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]), a[2] + t * (b[2] - a[2]))


def norm(a: Vec) -> float:
    return math.sqrt(dot(a, a))


def crosses(p: Vec, q: Vec, a: Vec, b: Vec, c: Vec) -> bool:
    """Whether the segment pq passes through the triangle abc."""
    n = cross(sub(b, a), sub(c, a))
    d, e = dot(sub(p, a), n), dot(sub(q, a), n)
    if d * e >= 0.0:
        return False
    x = mix(p, q, d / (d - e))
    sides = [dot(cross(sub(v, u), sub(x, u)), n) for u, v in ((a, b), (b, c), (c, a))]
    return min(sides) >= 0.0 or max(sides) <= 0.0


def segment_distance(p: Vec, q: Vec, a: Vec, b: Vec) -> float:
    """Of two segments."""
    u, v, w = sub(q, p), sub(b, a), sub(p, a)
    uu, uv, vv, uw, vw = dot(u, u), dot(u, v), dot(v, v), dot(u, w), dot(v, w)
    best = math.inf
    den = uu * vv - uv * uv
    places = [(0.0, None), (1.0, None), (None, 0.0), (None, 1.0)]
    if den > 1e-14 * max(uu * vv, 1e-300):
        places.append(((uv * vw - vv * uw) / den, (uu * vw - uv * uw) / den))
    for s, t in places:
        if s is None and t is not None:
            s = (t * uv - uw) / uu if uu > 0 else 0.0
        if t is None and s is not None:
            t = (s * uv + vw) / vv if vv > 0 else 0.0
        assert s is not None and t is not None
        s, t = min(max(s, 0.0), 1.0), min(max(t, 0.0), 1.0)
        best = min(best, norm(sub(mix(p, q, s), mix(a, b, t))))
    return best


@dataclass
class Case:
    kind: str
    number: int
    scene: Scene
    judge: Judge = lambda rows, report: []


@dataclass
class Verdict:
    case: Case
    end: str
    complaints: list[str] = field(default_factory=list)
    rows: list[Row] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)


def at(row: Row, name: str) -> Vec:
    return (row[name + ".x"], row[name + ".y"], row[name + ".z"])


def table(h: float, steps: int, u: Vec) -> dict[str, Any]:
    """A frame that moves evenly along u in all."""
    return {"times": [0, h * steps], "translate": [[0, 0, 0], list(u)]}


# Throws.


def rod_points(length: float, count: int) -> tuple[dict[str, Any], list[str]]:
    names = [f"p{i}" for i in range(count)]
    return {name: {"rod": "r", "at": length * (1 - 1e-9) * i / (count - 1)} for i, name in enumerate(names)}, names


def judge_rod_peg(names: list[str], axis: tuple[Vec, Vec], moves: Callable[[float], Vec], apart: float,
                  edge: float) -> Judge:
    """A rod's axis never passes the axis of a peg, and stays the two radii away from it."""

    def judge(rows: list[Row], _: Any) -> list[str]:
        told = []
        lines = [[sub(at(row, name), moves(row["time"])) for name in names] for row in rows]
        for before, after, row in zip(lines, lines[1:], rows[1:]):
            count = 0
            for i in range(len(names) - 1):
                a, b, c, d = before[i], before[i + 1], after[i], after[i + 1]
                count += crosses(axis[0], axis[1], a, b, c) + crosses(axis[0], axis[1], b, d, c)
            if count % 2:
                told.append(f"the rod passes the peg's axis at t = {row['time']:.4g} s")
            near = min(segment_distance(after[i], after[i + 1], *axis) for i in range(len(names) - 1))
            bend = max((norm(sub(mix(a, c, 0.5), b)) for a, b, c in zip(after, after[1:], after[2:])), default=0.0)
            if near < apart - edge - 0.3 * bend:  # of chords, which lie a quarter of that within the curve
                told.append(f"the rod is {1e3 * (apart - near):.3g} mm in the peg at t = {row['time']:.4g} s")
        return told[:3]

    return judge


def rod_at_peg(random_: random.Random) -> tuple[Scene, Judge]:
    """A rod held by a frame, or loose, and a peg, one of which comes to the other."""
    length, sections = random_.uniform(0.05, 0.2), random_.randint(4, 12)
    radius = length * 10 ** random_.uniform(-2.2, -1.2)
    peg = length * 10 ** random_.uniform(-2.2, -0.9)
    h = random_.choice([1e-3, 2e-3, 5e-3, 1e-2])
    way = 2 * min(radius, peg) * 10 ** random_.uniform(-1.0, 1.3)  # in a step
    x = length * random_.uniform(0.15, 0.7)
    gap = random_.uniform(0.05, 1.0) * max(way, radius)
    steps = int(min(max((gap + 6 * (peg + radius)) / way + 4, 8), 60))
    total = way * steps
    outputs, names = rod_points(length, 6 * sections + 1)
    scene: Scene = {
        "time": {"step": h, "duration": h * steps},
        "rods": {"r": {
            "path": [[0, 0, 0], [length, 0, 0]], "sections": sections, "order": random_.choice([0, 0, 1, 2]),
            "section": {"circle": {"radius": radius}},
            "material": {"young": 10 ** random_.uniform(5.5, 9), "poisson": 0.45, "density": 1100,
                         "damping": random_.choice([0, 1e-3, 1e-2])},
        }},
        "contact": {"friction": random_.choice([0, 0.3, 0.8])},
        "obstacles": {},
        "outputs": outputs,
        "view": {"interval": 1000},
    }
    y = peg + radius + gap
    tilt = random_.uniform(-0.5, 0.5)
    shape = random_.choice(["cylinder", "capsule"])
    own: dict[str, Any] = {shape: {"radius": peg, "length": 4 * length},
                           "pose": {"translate": [x, y, 0], "rotate": [0, tilt, 0]}}
    axis: tuple[Vec, Vec] = ((x - 2 * length * math.sin(tilt), y, -2 * length * math.cos(tilt)),
                             (x + 2 * length * math.sin(tilt), y, 2 * length * math.cos(tilt)))
    still: Callable[[float], Vec] = lambda t: (0.0, 0.0, 0.0)
    moves = still
    how = random_.choice(["frame", "peg", "load"])
    if how == "frame":
        scene["frames"] = {"hand": {"motion": table(h, steps, (0, total, 0))}}
        scene["rods"]["r"]["frame"] = "hand"
    elif how == "peg":
        scene["frames"] = {"hand": {"motion": table(h, steps, (0, -total, 0))}}
        own["frame"] = "hand"
        moves = lambda t: (0.0, -total * t / (h * steps), 0.0)
    else:
        scene["rods"]["r"]["base"] = "free"
        mass = 1100 * math.pi * radius**2 * length
        push = mass * way / h**2 * random_.uniform(0.2, 1.0)
        scene["loads"] = {"push": {"rod": "r", "at": x, "force": [0, push, 0]}}
    scene["obstacles"]["peg"] = own
    scene["contact"]["pairs"] = [{"between": ["r", "peg"]}]
    edge = 0.3 * 2 * min(radius, peg) + 0.02 * (length / sections)
    return scene, judge_rod_peg(names, axis, moves, peg + radius, edge)


def shape_of(random_: random.Random, size: float) -> tuple[dict[str, Any], float, float]:
    """A body's shape, its least extent, and the radius of the ball about it."""
    kind = random_.choice(["sphere", "capsule", "box", "cylinder"])
    if kind == "sphere":
        return {"sphere": {"radius": size}}, 2 * size, size
    if kind == "box":
        edges = [2 * size * random_.uniform(0.1, 1.0) for _ in range(3)]
        return {"box": {"size": edges}}, min(edges), 0.5 * math.hypot(*edges)
    radius, length = size * random_.uniform(0.1, 1.0), 2 * size * random_.uniform(0.1, 1.0)
    if kind == "capsule":
        return {"capsule": {"radius": radius, "length": length}}, 2 * radius, radius + 0.5 * length
    return {"cylinder": {"radius": radius, "length": length}}, min(2 * radius, length), math.hypot(radius, 0.5 * length)


def body_at_wall(random_: random.Random) -> tuple[Scene, Judge]:
    """A body thrown at a plane or a plate, or a plate moved at it: its centre stays on its side."""
    size = 10 ** random_.uniform(-2.3, -1)
    shape, thin, around = shape_of(random_, size)
    h = random_.choice([1e-3, 2e-3, 5e-3, 1e-2])
    thickness = size * 10 ** random_.uniform(-1.5, 0)
    wall = random_.choice(["plane", "plate", "plate"])
    least = thin if wall == "plane" else min(thin, thickness)
    way = least * 10 ** random_.uniform(-1.0, 1.3)
    gap = random_.uniform(0.1, 2.0) * max(way, 0.1 * around)
    steps = int(min(max(4 * (gap + around) / way, 8), 80))
    z = around + gap
    moving = wall == "plate" and random_.random() < 0.5
    scene: Scene = {
        "time": {"step": h, "duration": h * steps},
        "gravity": random_.choice([[0, 0, 0], [0, 0, -9.81]]),
        "contact": {"friction": random_.choice([0, 0.5, 1.0]), "restitution": random_.choice([0, 0, 0.7])},
        "bodies": {"b": {**shape, "density": 10 ** random_.uniform(2, 4),
                         "pose": {"translate": [0, 0, z], "rotate": [random_.uniform(-2, 2) for _ in range(3)]},
                         "spin": [random_.gauss(0, 0.3) / h for _ in range(3)]}},
        "outputs": {"b": {"body": "b"}},
        "view": {"interval": 1000},
    }
    speed = way / h
    side = 40 * size
    if wall == "plane":
        scene["obstacles"] = {"wall": {"plane": {"normal": [0, 0, 1]}}}
    else:
        scene["obstacles"] = {"wall": {"box": {"size": [side, side, thickness]},
                                       "pose": {"translate": [0, 0, -0.5 * thickness]}}}
    if moving:
        scene["frames"] = {"hand": {"motion": table(h, steps, (0, 0, way * steps))}}
        scene["obstacles"]["wall"]["frame"] = "hand"
    else:
        scene["bodies"]["b"]["velocity"] = [0.3 * speed * random_.uniform(-1, 1), 0, -speed]

    def judge(rows: list[Row], _: Any) -> list[str]:
        for row in rows:
            top = speed * row["time"] if moving else 0.0
            x, y, height = row["b.x"], row["b.y"], row["b.z"] - top
            if max(abs(x), abs(y)) > 0.5 * side - around and wall == "plate":
                return []  # it may fall off
            if height < 0.5 * thin - 0.3 * least:
                return [f"the body's centre is {1e3 * height:.3g} mm above the wall at t = {row['time']:.4g} s; "
                        f"its least half extent is {1e3 * 0.5 * thin:.3g} mm"]
        return []

    return scene, judge


def ball_at_peg(random_: random.Random) -> tuple[Scene, Judge]:
    """A ball or a capsule's ball thrown at a thin peg: it never passes through its axis."""
    size = 10 ** random_.uniform(-2.3, -1)
    peg = size * 10 ** random_.uniform(-1.5, 0)
    h = random_.choice([1e-3, 2e-3, 5e-3, 1e-2])
    way = 2 * peg * 10 ** random_.uniform(-1.0, 1.3)
    gap = random_.uniform(0.1, 2.0) * max(way, 0.1 * size)
    steps = int(min(max(4 * (gap + size) / way, 8), 60))
    off = random_.uniform(-0.6, 0.6) * (size + peg)
    shape = random_.choice(["cylinder", "capsule", "box"])
    reach = 40 * size
    own: dict[str, Any] = {"box": {"size": [2 * peg, 2 * peg, reach]}} if shape == "box" else {
        shape: {"radius": peg, "length": reach}}
    scene: Scene = {
        "time": {"step": h, "duration": h * steps},
        "contact": {"friction": random_.choice([0, 0.5])},
        "bodies": {"b": {"sphere": {"radius": size}, "density": 10 ** random_.uniform(2, 4),
                         "pose": {"translate": [-(size + 1.5 * peg + gap), off, 0]}, "velocity": [way / h, 0, 0],
                         "spin": [0, 0, random_.gauss(0, 0.3) / h]}},
        "obstacles": {"peg": own},
        "outputs": {"b": {"body": "b"}},
        "view": {"interval": 1000},
    }
    axis: tuple[Vec, Vec] = ((0, 0, -0.5 * reach), (0, 0, 0.5 * reach))

    def judge(rows: list[Row], _: Any) -> list[str]:
        for before, after in zip(rows, rows[1:]):
            near = segment_distance(at(after, "b"), at(after, "b"), *axis)
            on_way = segment_distance(at(before, "b"), at(after, "b"), *axis)
            if near < size + peg - 0.3 * 2 * peg or on_way < 0.5 * size:
                return [f"the ball is {1e3 * (size + peg - near):.3g} mm in the peg at t = {after['time']:.4g} s"]
        return []

    return scene, judge


def rod_at_wall(random_: random.Random) -> tuple[Scene, Judge]:
    """A rod that falls, is pushed or is moved at a plane or a plate."""
    length, sections = random_.uniform(0.05, 0.2), random_.randint(3, 10)
    radius = length * 10 ** random_.uniform(-2.2, -1.2)
    thickness = length * 10 ** random_.uniform(-2, -1)
    wall = random_.choice(["plane", "plate"])
    h = random_.choice([1e-3, 2e-3, 5e-3, 1e-2])
    least = 2 * radius if wall == "plane" else min(2 * radius, thickness)
    way = least * 10 ** random_.uniform(-1.0, 1.3)
    gap = random_.uniform(0.1, 1.0) * max(way, radius)
    turn = random_.choice([0.0, 0.3, 1.2, math.pi / 2])
    steps = int(min(max(3 * (gap + 4 * radius) / way, 8), 60))
    start = (0.0, 0.0, radius + gap)
    end = (length * math.cos(turn), 0.0, radius + gap + length * math.sin(turn))
    outputs, names = rod_points(length, 2 * sections + 1)
    how = random_.choice(["load", "frame", "wall"])
    scene: Scene = {
        "time": {"step": h, "duration": h * steps},
        "rods": {"r": {
            "path": [list(start), list(end)], "sections": sections,
            "strains": ["torsion", "bending_y", "bending_z", "elongation"],
            "section": {"circle": {"radius": radius}},
            "material": {"young": 10 ** random_.uniform(5.5, 8), "poisson": 0.45, "density": 1100,
                         "damping": random_.choice([1e-3, 1e-2])},
        }},
        "contact": {"friction": random_.choice([0, 0.5]), "pairs": [{"between": ["r", "wall"]}]},
        "outputs": outputs,
        "view": {"interval": 1000},
    }
    if wall == "plane":
        scene["obstacles"] = {"wall": {"plane": {"normal": [0, 0, 1]}}}
    else:
        scene["obstacles"] = {"wall": {"box": {"size": [20 * length, 20 * length, thickness]},
                                       "pose": {"translate": [0, 0, -0.5 * thickness]}}}
    total = way * steps
    moving = how == "wall" and wall == "plate"
    if moving:
        total = min(total, gap + 0.3 * length)  # a clamped base does not let a plate through
        scene["frames"] = {"hand": {"motion": table(h, steps, (0, 0, total))}}
        scene["obstacles"]["wall"]["frame"] = "hand"
        scene["rods"]["r"]["base"] = "free"
    elif how == "frame":
        # Held at its upper end, so that only what is soft is pressed into the wall.
        scene["rods"]["r"]["path"] = [list(end), list(start)]
        total = min(total, gap + 0.2 * length)
        scene["frames"] = {"hand": {"motion": table(h, steps, (0, 0, -total))}}
        scene["rods"]["r"]["frame"] = "hand"
        if turn == 0.0:
            scene["rods"]["r"]["path"] = [[0, 0, radius + gap + 0.3 * length],
                                          [math.sqrt(0.91) * length, 0, radius + gap]]
    else:
        scene["rods"]["r"]["base"] = "free"
        mass = 1100 * math.pi * radius**2 * length
        scene["loads"] = {"push": {"rod": "r", "at": random_.choice([0, 0.5, 1]) * length,
                                   "force": [0, 0, -mass * way / h**2 * random_.uniform(0.1, 0.5)]}}

    def judge(rows: list[Row], _: Any) -> list[str]:
        for row in rows:
            top = total * row["time"] / (h * steps) if moving else 0.0
            low = min(row[name + ".z"] for name in names) - top
            if low < radius - 0.3 * least:
                return [f"the rod is {1e3 * (radius - low):.3g} mm in the wall at t = {row['time']:.4g} s"]
        return []

    return scene, judge


def solid_at_wall(random_: random.Random) -> tuple[Scene, Judge]:
    """A soft beam, held by a frame, moved at a plate or a peg, or these at it."""
    young = 10 ** random_.uniform(5, 6.5)
    h = random_.choice([2e-3, 5e-3, 1e-2])
    thick = 0.016 * 0.3
    way = thick * 10 ** random_.uniform(-1.0, 0.8)
    gap = random_.uniform(0.1, 1.0) * max(way, 0.004)
    steps = int(min(max((gap + 0.025) / way, 6), 25))
    total = min(way * steps, gap + 0.025)
    shape: dict[str, Any] = random_.choice([{"box": {"size": [0.02, 0.2, 0.01]}}, {"capsule": {"radius": 0.005, "length": 0.2}},
                            {"sphere": {"radius": 0.01}}])
    lower = 0.5 * shape["box"]["size"][2] if "box" in shape else next(iter(shape.values()))["radius"]
    place = [0.08, 0, -0.008 - lower - gap]
    pose: dict[str, Any] = {"translate": place}
    if "capsule" in shape:
        pose["rotate"] = [math.pi / 2, 0, 0]
    points = {f"q{i}": {"solid": "s", "point": [0.06 + 0.01 * i, 0, -0.008]} for i in range(4)}
    scene: Scene = {
        "time": {"step": h, "duration": h * steps},
        "solids": {"s": {"mesh": "finger.vtk", "scale": 0.001,
                         "material": {"law": "corotational", "young": young, "poisson": 0.45}, "density": 1070,
                         "rayleigh": {"mass": 0.1, "stiffness": 0.01},
                         "fixed": {"box": [[-0.001, -0.008, -0.008], [0.001, 0.008, 0.008]]}}},
        "obstacles": {"o": {**shape, "pose": pose}},
        "contact": {"friction": random_.choice([0, 0.5]), "pairs": [{"between": ["s", "o"]}]},
        "frames": {"hand": {"motion": table(h, steps, (0, 0, total))}},
        "outputs": points,
        "view": {"interval": 1000},
    }
    scene["obstacles"]["o"]["frame"] = "hand"

    def judge(rows: list[Row], _: Any) -> list[str]:
        for row in rows:
            height = place[2] + total * row["time"] / (h * steps)
            for name in points:
                x, y, z = at(row, name)
                if abs(x - 0.08) < 0.5 * lower and abs(y) < 0.5 * lower and z < height:
                    return [f"the body is {1e3 * (height + lower - z):.3g} mm in the obstacle at t = {row['time']:.4g} s"]
        return []

    return scene, judge


# Stability.


def circle(radius: float) -> float:
    """Second moment of area."""
    return 0.25 * math.pi * radius**4


def column(random_: random.Random) -> Scene:
    """A clamped rod under a load along it, straight or not, alone or tied to another, pulled by tendons or not."""
    length, radius = random_.uniform(0.1, 0.3), random_.uniform(0.5e-3, 4e-3)
    young = 10 ** random_.uniform(6, 10)
    material = {"young": young, "poisson": 0.4, "density": 1100}
    order, sections = random_.choice([0, 1, 2]), random_.randint(3, 10)
    full = ["torsion", "bending_y", "bending_z", "elongation", "shear_y", "shear_z"]
    strains = random_.choice([full, full[:4], full[:3], full[1:3]])
    rod: dict[str, Any] = {"path": [[0, 0, 0], [length, 0, 0]], "sections": sections, "order": order,
                           "strains": strains, "section": {"circle": {"radius": radius}}, "material": material}
    euler = math.pi**2 * young * circle(radius) / (4 * length**2)
    scene: Scene = {"time": {"step": 1, "duration": 1}, "rods": {"a": rod}, "view": {"interval": 1000},
                    "outputs": {"tip": {"rod": "a", "at": length * (1 - 1e-9)}}}
    if random_.random() < 0.4:
        rod["start"] = "path"
        rod["rest"] = {"bending_y": random_.uniform(-5, 5)}
    if random_.random() < 0.5:
        other = json.loads(json.dumps(rod))
        other["path"] = [[0, 0, 0], [length, 0, 0]]
        if "rest" in other:
            other["rest"] = {"bending_y": random_.uniform(-8, 8)}
        scene["rods"]["b"] = other
        count = random_.randint(1, min(4, sections))
        along = random_.choice([["y", "z"], ["x", "y", "z"]])
        if "elongation" not in strains:
            along = ["y", "z"]
        scene["couplings"] = [{"tie": {"rod": "a", "at": length * (i + 1) / (count + 1), "other": "b",
                                       "other_at": length * (i + 1) / (count + 1), "along": along}}
                              for i in range(count)]
    force = euler * random_.uniform(0.0, 2.5)
    scene["loads"] = {"push": {"rod": "a", "force": [-force, 0, 0]}}
    if random_.random() < 0.3:
        scene["loads"]["side"] = {"rod": "a", "force": [0, euler * random_.uniform(-0.5, 0.5), 0]}
    if random_.random() < 0.2:
        scene["gravity"] = [0, 0, -9.81]
    return scene


def verdict_of(random_: random.Random) -> tuple[Scene, Judge]:
    """An equilibrium told as stable or not, beside the sign of its lowest natural frequency."""
    scene = column(random_)
    scene["analysis"] = "quasi_static"

    def judge(rows: list[Row], report: Any) -> list[str]:
        modal = {**scene, "analysis": "modal", "modes": 3}
        for key in ("time",):
            modal.pop(key)
        other = run(Case("modal", 0, modal), judge_program())
        if other.end != "done" or len(other.rows) < 2 or not rows or rows[-1]["time"] < 1.0:
            return []
        if norm(sub(at(rows[-1], "tip"), at(other.rows[0], "tip"))) > 1e-3 * norm(at(rows[-1], "tip")):
            return []  # another equilibrium
        first = other.rows[1]["mode.frequency"]
        unstable = any(own["code"] == "unstable" for own in report["warnings"])
        if abs(first) < 1e-2 * abs(other.rows[-1]["mode.frequency"]):
            return []  # neutral
        if unstable != (first < 0.0):
            return [f"told as {'unstable' if unstable else 'stable'}, lowest frequency {first:.4g} Hz"]
        return []

    return scene, judge


_program = [str(ROOT / "build/release/sinew")]


def use_program(program: str) -> None:
    """That judges run, too."""
    _program[0] = program


def judge_program() -> str:
    return _program[0]


# Frames that move, and no energy from nowhere.


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
        return [own["message"] for own in report["warnings"] if own["code"] == "energy_gain"]

    return scene, judge


# Anything that a user may write.


def table_of(random_: random.Random, duration: float, most: float) -> dict[str, Any]:
    return {"times": [0, duration * random_.uniform(0.2, 0.9)], "values": [0, most]}


def finger(random_: random.Random, scene: Scene, duration: float) -> None:
    """A soft finger and its cable, pulled by a length, a force or what a target asks for."""
    scene["solids"] = {"finger": {
        "mesh": "finger.vtk", "scale": 0.001, "density": 1070,
        "material": {"law": random_.choice(["corotational", "neo_hookean", "saint_venant_kirchhoff"]),
                     "young": 10 ** random_.uniform(5, 6.5), "poisson": random_.uniform(0.2, 0.49)},
        "rayleigh": {"mass": 0.1, "stiffness": random_.choice([0.005, 0.02])},
        "fixed": {"box": [[-0.001, -0.008, -0.008], [0.001, 0.008, 0.008]]}}}
    points = sorted(round(random_.uniform(0.005, 0.085), 4) for _ in range(random_.randint(1, 8)))
    scene["rods"] = {"cable": {
        "path": [[0, 0, 0.002], [0.09, 0, 0.002]], "sections": random_.randint(2, 20),
        "strains": ["torsion", "bending_y", "bending_z"], "section": {"circle": {"radius": 10 ** random_.uniform(-3.7, -3)}},
        "material": {"young": 10 ** random_.uniform(8, 10), "poisson": 0.4, "density": 1100}}}
    scene["couplings"] = [{"slide": {"rod": "cable", "solid": "finger", "points": points + [0.09],
                                     "anchor_tip": "position"}}]
    pull: dict[str, Any] = {"rod": "cable"}
    how = random_.choice(["displacement", "force", "inverse"])
    scene["outputs"] = {"tip": {"solid": "finger", "point": [0.095, 0, 0]}}
    if how == "displacement":
        pull["displacement"] = table_of(random_, duration, random_.uniform(0, 0.015))
    elif how == "force" or scene["analysis"] in ("static", "modal"):
        pull["force"] = table_of(random_, duration, random_.uniform(0, 3))
    else:
        pull["force"] = "inverse"
        scene["targets"] = {"tip": {"at": [0.095, 0, random_.uniform(0, 0.03)], "weights": [0, 0, 1]}}
    scene["actuators"] = {"pull": pull}


def arm(random_: random.Random, scene: Scene, duration: float) -> None:
    """A rod that tendons, loads and a tie act on."""
    length, radius = random_.uniform(0.05, 0.6), random_.uniform(1e-3, 1e-2)
    young = 10 ** random_.uniform(5.5, 8)
    full = ["torsion", "bending_y", "bending_z", "elongation", "shear_y", "shear_z"]
    scene["rods"] = {"r": {
        "path": random_.choice([[[0, 0, 0.2], [length, 0, 0.2]],
                                [[0, 0, 0.2], [0.5 * length, 0, 0.2], [0.8 * length, 0.3 * length, 0.2]]]),
        "sections": random_.randint(1, 12), "order": random_.choice([0, 1, 2]), "strains": full[:random_.choice([3, 4, 6])],
        "section": {"circle": {"radius": radius}},
        "material": {"young": young, "poisson": 0.45, "density": 1100, "damping": random_.choice([0, 1e-3, 1e-2])}}}
    scene["outputs"] = {"tip": {"rod": "r", "at": 0.7 * length}}
    bends = young * circle(radius) / length**2
    if random_.random() < 0.6:
        scene["loads"] = {"p": {"rod": "r", "force": [bends * random_.uniform(-2, 2) for _ in range(3)],
                                "factor": table_of(random_, duration, 1)}}
    if random_.random() < 0.6:
        scene["actuators"] = {}
        for i in range(random_.randint(1, 3)):
            told = {"tension": table_of(random_, duration, bends * length / radius * random_.uniform(0, 1))}
            if random_.random() < 0.4:
                told = {"displacement": table_of(random_, duration, 0.5 * radius * random_.uniform(-1, 1))}
            scene["actuators"][f"t{i}"] = {"rod": "r", **told,
                                           "tendon": {"distance": 0.6 * radius, "angle": f"{120 * i} deg"}}
    if random_.random() < 0.25 and scene["analysis"] != "modal":
        scene["rods"]["r"]["strains"] = full[:4]
        scene["couplings"] = [{"tie": {"rod": "r", "at": 0.7 * length, "along": random_.choice([["y"], ["y", "z"]])}}]


def heap(random_: random.Random, scene: Scene, duration: float) -> None:
    """Bodies above a floor, and a rod between them at times."""
    scene["bodies"] = {}
    for i in range(random_.randint(1, 4)):
        shape, _, around = shape_of(random_, 0.02)
        scene["bodies"][f"b{i}"] = {
            **shape, "density": 10 ** random_.uniform(2, 4),
            "pose": {"translate": [random_.uniform(-0.02, 0.02), random_.uniform(-0.02, 0.02), 0.05 + 0.07 * i],
                     "rotate": [random_.uniform(-2, 2) for _ in range(3)]},
            "velocity": [random_.gauss(0, 0.2) for _ in range(3)]}
    scene["obstacles"] = {"floor": {"plane": {"normal": [0, 0, 1]}}}
    scene["contact"] = {"friction": random_.choice([0, 0.3, 0.8]), "restitution": random_.choice([0, 0.5])}
    scene["outputs"] = {"b0": {"body": "b0"}}
    if random_.random() < 0.3:
        scene["rods"] = {"r": {
            "path": [[-0.1, 0, 0.04], [0.1, 0, 0.04]], "sections": 6, "base": random_.choice(["free", ["z"]]),
            "section": {"circle": {"radius": 0.003}},
            "material": {"young": 10 ** random_.uniform(6, 8), "poisson": 0.45, "density": 1100, "damping": 0.01}}}
        scene["contact"]["pairs"] = [{"between": ["r", "floor"]}, {"between": ["r", "b0"]}]


def legal(random_: random.Random) -> tuple[Scene, Judge]:
    """Objects, analyses and solvers at random."""
    what = random_.choice([finger, arm, arm, heap])
    analysis = "dynamic" if what is heap else random_.choice(["dynamic", "dynamic", "quasi_static", "static", "modal"])
    h = random_.choice([1e-3, 5e-3, 1e-2, 2e-2])
    duration = h * random_.randint(5, 30)
    scene: Scene = {"analysis": analysis, "view": {"interval": 1000},
                    "gravity": [0, 0, -9.81] if what is heap or random_.random() < 0.6 else [0, 0, 0]}
    if analysis == "modal":
        scene["modes"] = random_.randint(1, 5)
    else:
        scene["time"] = {"step": h, "duration": duration}
    if random_.random() < 0.25 and analysis in ("dynamic", "quasi_static"):
        scene["newton"] = random_.choice([1, 2])
    what(random_, scene, duration)

    def judge(rows: list[Row], report: Any) -> list[str]:
        told = []
        codes = {own["code"] for own in report["warnings"]}
        summary = report["summary"]
        linearised = "newton" in scene
        if not linearised and summary["largest_violation_m"] > 1e-8:
            told.append(f"converged with constraints off by {summary['largest_violation_m']:.3g} m")
        deep = summary.get("contact", {}).get("deepest_penetration_m", 0.0)
        if deep > 1e-5 and "penetration" not in codes and "overlap_at_start" not in codes:
            told.append(f"overlaps of {1e3 * deep:.3g} mm without a word")
        for row in rows:
            for name, value in row.items():
                if name.endswith((".force", ".tension", ".normal")) and abs(value) > 1e9:
                    told.append(f"{name} is {value:.3g}")
        if analysis == "dynamic" and rows and "energy.dissipated" in rows[0]:
            most = lost = unsure = work = before = 0.0  # work counts with the mean of forces at the ends of steps
            for row in rows:
                most = max(most, row["energy.kinetic"] + row["energy.elastic"])
                if row["energy.dissipated"] > lost:
                    lost, unsure = row["energy.dissipated"], 0.0
                more, work = row["energy.work"] - work, row["energy.work"]
                unsure, before = unsure + abs(more - before), more
                gain = lost - row["energy.dissipated"] - unsure
                if gain > 3e-3 * most and most > 1e-12 and "energy_gain" not in codes:
                    told.append(f"{lost - row['energy.dissipated']:.3g} J from nowhere of {most:.3g} J, without a word")
                    break
        return told[:3]

    return scene, judge


THROWS: dict[str, Maker] = {
    "rod_at_peg": rod_at_peg,
    "body_at_wall": body_at_wall,
    "ball_at_peg": ball_at_peg,
    "rod_at_wall": rod_at_wall,
    "solid_at_wall": solid_at_wall,
}
KINDS: dict[str, dict[str, Maker]] = {
    "throws": THROWS,
    "verdicts": {"column": verdict_of},
    "scenes": {"legal": legal},
    "frames": {"moving_frame": moving_frame},
}


def make(group: str, number: int) -> Case:
    """The scene of a kind and a number."""
    kinds = KINDS[group]
    names = list(kinds)
    random_ = random.Random(f"{group} {number}")
    # Of several the last takes longest, and is every tenth.
    name = names[-1] if len(names) == 1 or number % 10 == 9 else names[number % (len(names) - 1)]
    scene, judge = kinds[name](random_)
    return Case(name, number, scene, judge)


def read_rows(path: Path) -> list[Row]:
    rows = []
    with open(path, newline="") as stream:
        for row in csv.DictReader(stream):
            rows.append({key: float(value) for key, value in row.items() if value and key not in ("status", "targets")})
    return rows


def run(case: Case, program: str, limit: float = 120.0, keep: Path | None = None) -> Verdict:
    """Runs a scene and judges it."""
    with tempfile.TemporaryDirectory() as name:
        folder = keep or Path(name)
        folder.mkdir(parents=True, exist_ok=True)
        for solid in case.scene.get("solids", {}).values():
            (folder / solid["mesh"]).write_bytes((ROOT / "examples/meshes" / solid["mesh"]).read_bytes())
        (folder / "scene.yaml").write_text(json.dumps(case.scene, indent=1))
        try:
            done = subprocess.run([program, "run", folder / "scene.yaml", "-o", folder / "out", "--quiet", "--force"],
                                  capture_output=True, text=True, timeout=limit)
        except subprocess.TimeoutExpired:
            return Verdict(case, "hangs", [f"not through after {limit:g} s"])
        if done.returncode < 0 or done.returncode not in (0, 1, 2, 3):
            return Verdict(case, "crash", [f"exit code {done.returncode}: {done.stderr[-300:]}"])
        report_file = folder / "out" / "report.json"
        if not report_file.exists():
            return Verdict(case, "refused", [done.stderr[-300:]])
        report = json.loads(report_file.read_text())
        rows = read_rows(folder / "out" / "signals.csv")
        complaints = case.judge(rows, report)
        for row in rows:
            if not all(math.isfinite(value) for value in row.values()):
                complaints.append(f"not finite at t = {row['time']:.4g} s")
                break
        end = "done" if done.returncode == 0 else "stopped: " + " ".join(done.stderr.split())[-300:]
        return Verdict(case, end, complaints, rows, [own["code"] for own in report["warnings"]])


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kind", choices=sorted(KINDS), default="throws")
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--program", default=str(ROOT / "build/release/sinew"))
    parser.add_argument("--keep", type=Path, help="a folder for scenes that are complained of")
    parser.add_argument("--verbose", action="store_true")
    arguments = parser.parse_args()
    use_program(arguments.program)
    ends: Counter[tuple[str, str]] = Counter()
    wrong = 0
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        cases = [make(arguments.kind, number) for number in range(arguments.first, arguments.first + arguments.count)]
        for verdict in pool.map(lambda case: run(case, arguments.program), cases):
            case = verdict.case
            ends[case.kind, verdict.end.split(":")[0]] += 1
            if verdict.complaints or (arguments.verbose and verdict.end != "done"):
                print(f"{case.kind} {case.number}: {verdict.end}; {'; '.join(verdict.complaints)}", flush=True)
            if verdict.complaints:
                wrong += 1
                if arguments.keep:
                    run(case, arguments.program, keep=arguments.keep / f"{case.kind}_{case.number}")
    for (kind, end), count in sorted(ends.items()):
        print(f"{kind:16} {end:10} {count}")
    print(f"{wrong} of {arguments.count} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
