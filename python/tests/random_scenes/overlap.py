"""Where bodies are, and how deep they lie in a floor and in each other, computed from their places alone."""

from __future__ import annotations

import math
from typing import Any

from .scene import Row, Scene, Vec, at, segment_distance

Matrix = tuple[Vec, Vec, Vec]  # rows


def product(a: Matrix, b: Matrix) -> Matrix:
    def row(r: Vec) -> Vec:
        return (sum(r[k] * b[k][0] for k in range(3)), sum(r[k] * b[k][1] for k in range(3)),
                sum(r[k] * b[k][2] for k in range(3)))
    return (row(a[0]), row(a[1]), row(a[2]))


def about(axis: Vec, angle: float) -> Matrix:
    """Rodrigues' formula; the axis has length 1."""
    x, y, z = axis
    c, s = math.cos(angle), math.sin(angle)
    d = 1.0 - c
    return ((c + d * x * x, d * x * y - s * z, d * x * z + s * y), (d * x * y + s * z, c + d * y * y, d * y * z - s * x),
            (d * x * z - s * y, d * y * z + s * x, c + d * z * z))


def by_vector(turn: Vec) -> Matrix:
    angle = math.sqrt(sum(x * x for x in turn))
    return about((turn[0] / angle, turn[1] / angle, turn[2] / angle), angle) if angle > 0 else about((1, 0, 0), 0)


def by_pose(rotate: list[float]) -> Matrix:
    """R = Rz Ry Rx."""
    return product(product(about((0, 0, 1), rotate[2]), about((0, 1, 0), rotate[1])), about((1, 0, 0), rotate[0]))


def reach(body: dict[str, Any], along: Vec) -> float:
    """How far the body reaches from its centre along a direction, which is given in its axes."""
    if "sphere" in body:
        return float(body["sphere"]["radius"])
    if "box" in body:
        return float(sum(0.5 * size * abs(x) for size, x in zip(body["box"]["size"], along)))
    name = "capsule" if "capsule" in body else "cylinder"
    radius, half = body[name]["radius"], 0.5 * body[name]["length"]
    round_ = radius if name == "capsule" else radius * math.sqrt(max(0.0, 1.0 - along[2] ** 2))
    return float(half * abs(along[2]) + round_)


def core(body: dict[str, Any], p: Vec, R: Matrix) -> tuple[Vec, Vec, float] | None:
    """Of a sphere or a capsule: a segment and a radius."""
    if "sphere" in body:
        return p, p, body["sphere"]["radius"]
    if "capsule" not in body:
        return None
    half = 0.5 * body["capsule"]["length"]
    up = (half * R[0][2], half * R[1][2], half * R[2][2])
    return (p[0] - up[0], p[1] - up[1], p[2] - up[2]), (p[0] + up[0], p[1] + up[1], p[2] + up[2]), body["capsule"]["radius"]


def outputs(scene: Scene) -> dict[str, Any]:
    """What `deepest` needs of the run."""
    bodies = scene.get("bodies", {})
    return {name: {"body": name} for name in bodies} | {
        f"{name}_turn": {"body": name, "quantity": "orientation"} for name in bodies}


def deepest(scene: Scene, row: Row) -> tuple[float, str]:
    """[m] of bodies in the floor z = 0, if there is one, and of spheres and capsules in each other; 0 if none is."""
    worst, who = 0.0, ""
    floor = any("plane" in own for own in scene.get("obstacles", {}).values())
    cores = {}
    for name, body in scene.get("bodies", {}).items():
        if f"{name}_turn.x" not in row:
            continue
        p = at(row, name)
        R = product(by_vector(at(row, f"{name}_turn")), by_pose(body.get("pose", {}).get("rotate", [0, 0, 0])))
        cores[name] = core(body, p, R)
        depth = reach(body, R[2]) - p[2]
        if floor and depth > worst:
            worst, who = depth, f"{name} in the floor"
    held = [(name, own) for name, own in cores.items() if own]
    for i, (name, a) in enumerate(held):
        for other, b in held[:i]:
            depth = a[2] + b[2] - segment_distance(a[0], a[1], b[0], b[1])
            if depth > worst:
                worst, who = depth, f"{name} in {other}"
    return worst, who
