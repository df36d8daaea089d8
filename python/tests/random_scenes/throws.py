"""Rods, bodies and solids thrown, pushed and moved at walls and pegs: nothing gets to the other side."""

from __future__ import annotations

import math
import random
from typing import Any, Callable

from .scene import Judge, Maker, Row, Scene, Vec, at, crosses, mix, norm, segment_distance, shape_of, sub, table


def rod_points(length: float, count: int, rod: str = "r") -> tuple[dict[str, Any], list[str]]:
    names = [f"p{i}" for i in range(count)]
    return {name: {"rod": rod, "at": length * (1 - 1e-9) * i / (count - 1)} for i, name in enumerate(names)}, names


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
    outputs, names = rod_points(length, 6 * sections + 1)
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
    lower: float = 0.5 * shape["box"]["size"][2] if "box" in shape else next(iter(shape.values()))["radius"]
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

    def depth(x: float, y: float, z: float) -> float:
        if "box" in shape:
            return min(0.01 - abs(x), 0.1 - abs(y), lower - abs(z))
        return lower - math.hypot(x, z if "capsule" in shape else math.hypot(y, z))

    def judge(rows: list[Row], _: Any) -> list[str]:
        for row in rows:
            height = place[2] + total * row["time"] / (h * steps)
            for name in points:
                x, y, z = at(row, name)
                if depth(x - 0.08, y, z - height) > 0.3 * min(0.016, 2 * lower):
                    return [f"the body is {1e3 * depth(x - 0.08, y, z - height):.3g} mm in the obstacle at t = {row['time']:.4g} s"]
        return []

    return scene, judge


THROWS: dict[str, Maker] = {
    "rod_at_peg": rod_at_peg,
    "body_at_wall": body_at_wall,
    "ball_at_peg": ball_at_peg,
    "rod_at_wall": rod_at_wall,
    "solid_at_wall": solid_at_wall,
}
