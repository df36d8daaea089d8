"""A real arm with tendons, measured by motion capture, as a rod and as a solid with cables; its modulus fitted."""

import json
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from paper import HERE, Result
from pictures import Array, View

import sinew

result = Result(__file__, "A tendon-driven arm, measured")
DATA = json.loads(result.scene("measured.json").read_text())
MEASURED = np.array([own["markers"] for own in DATA["pulls"]])  # (pulls, markers, 3) [m]
TENSIONS = [own["tension"] for own in DATA["pulls"]]
LENGTHS, RADII = [0.0, 0.305, 0.36], [0.01541, 0.00642, 0.0048]
# Of the cross-section: x along the arm, which hangs down, y the world's, z the world's x.
OFFSETS = np.array([[z, y, -x] for x, y, z in (own["offset"] for own in DATA["markers"])])
BEFORE, THEIRS = DATA["start"], DATA["identified"]


def disc(inner: int, outer: int) -> tuple[Array, npt.NDArray[np.int64]]:
    """Quadrilaterals that fill a circle of radius 1: a square of `inner` cells a side in its middle, `outer` around it.
    As wide as gives the polygon the circle's second moment of area."""
    t = np.linspace(-1.0, 1.0, inner + 1)
    a = 0.55
    patches = [a * np.stack(np.meshgrid(t, t, indexing="ij"), axis=-1)]
    angles = 0.25 * np.pi * t
    side, arc = np.stack([np.full_like(t, a), a * t], axis=1), np.stack([np.cos(angles), np.sin(angles)], axis=1)
    for turn in range(4):
        c, s = np.cos(0.5 * np.pi * turn), np.sin(0.5 * np.pi * turn)
        patch = np.stack([(1.0 - r) * side + r * arc for r in np.linspace(0.0, 1.0, outer + 1)])
        patches.append(patch @ np.array([[c, s], [-s, c]]))
    points, quads = [], []
    for patch in patches:
        number = sum(len(own) for own in points) + np.arange(patch.shape[0] * patch.shape[1]).reshape(patch.shape[:2])
        quads.append(np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4))
        points.append(patch.reshape(-1, 2))
    once, place = np.unique(np.round(np.concatenate(points), 9), axis=0, return_inverse=True)
    step = 2.0 * np.pi / (4 * inner)
    second = 4 * inner / 24.0 * np.sin(step) * (2.0 + np.cos(step))
    return once * (0.25 * np.pi / second) ** 0.25, place.reshape(-1)[np.concatenate(quads)]


def arm(layers: tuple[int, int], inner: int = 4, outer: int = 2) -> sinew.Mesh:
    """The two cones in hexahedra, so many layers in each, hanging down from the origin."""
    flat, quads = disc(inner, outer)
    heights = np.concatenate([np.linspace(0.0, LENGTHS[1], layers[0] + 1), np.linspace(LENGTHS[1], LENGTHS[2], layers[1] + 1)[1:]])
    radii = np.interp(heights, LENGTHS, RADII)
    points = np.concatenate([np.column_stack([r * flat, np.full(len(flat), -s)]) for s, r in zip(heights, radii, strict=True)])
    cells = [np.concatenate([quads + (k + 1) * len(flat), quads + k * len(flat)], axis=1) for k in range(len(heights) - 1)]
    return sinew.Mesh(points, {"hexahedron": np.concatenate(cells)})


def turned(vector: Array) -> Array:
    """The rotation of a rotation vector, (3, 3)."""
    angle = float(np.linalg.norm(vector))
    if angle == 0.0:
        return np.eye(3)
    x, y, z = vector / angle
    K = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.asarray(np.eye(3) + np.sin(angle) * K + (1.0 - np.cos(angle)) * (K @ K))


@dataclass
class Found:
    """Where markers are, (pulls, markers, 3), and what it looks like."""

    markers: Array
    states: list[sinew.State]

    @property
    def errors(self) -> Array:
        """[mm] (pulls, markers)"""
        return np.asarray(1e3 * np.linalg.norm(self.markers - MEASURED, axis=2))

    @property
    def rmse(self) -> float:
        return float(np.sqrt((self.errors**2).mean()))


def pulled(kind: str, young: float, density: float) -> Found:
    """The arm at rest under the four tensions."""
    scene = sinew.Scene.from_file(result.scene(f"{kind}.yaml"))
    if kind == "rod":
        for part in scene.rods["arm"].parts:
            assert isinstance(part.material, sinew.RodMaterial)
            part.material.young, part.material.density = young, density
    else:
        body = scene.solids["arm"]
        assert isinstance(body.material, sinew.SolidMaterial)
        body.material.young, body.density = young, density
    run = sinew.simulate(scene, progress=False)
    states = [run.state(int(np.argmin(np.abs(run.time - (k + 1.0))))) for k in range(len(TENSIONS))]
    markers = [[own.output(f"place{k}") + turned(own.output(f"turn{k}")) @ offset for k, offset in enumerate(OFFSETS)] for own in states]
    return Found(np.array(markers), states)


def least(of: Callable[[float], float], low: float, high: float, tolerance: float) -> float:
    """Where a function of one number is least (golden section)."""
    g = 0.5 * (np.sqrt(5.0) - 1.0)
    a, b = high - g * (high - low), low + g * (high - low)
    at_a, at_b = of(a), of(b)
    while high - low > tolerance:
        if at_a < at_b:
            high, b, at_b = b, a, at_a
            a = high - g * (high - low)
            at_a = of(a)
        else:
            low, a, at_a = a, b, at_b
            b = low + g * (high - low)
            at_b = of(b)
    return float(0.5 * (low + high))


mesh = arm((60, 10))
mesh.save(HERE / "meshes" / "arm.msh")
cases: dict[tuple[str, str], tuple[float, float, Found]] = {}
for kind in ("rod", "solid"):
    cases[kind, "before"] = (BEFORE["E"], BEFORE["rho"], pulled(kind, BEFORE["E"], BEFORE["rho"]))
    cases[kind, "theirs"] = (THEIRS["E"], THEIRS["rho"], pulled(kind, THEIRS["E"], THEIRS["rho"]))
    density = BEFORE["rho"]
    young = float(np.exp(least(lambda log: pulled(kind, float(np.exp(log)), density).rmse, np.log(2e5), np.log(8e5), 0.004)))
    cases[kind, "fitted"] = (young, density, pulled(kind, young, density))
for key, (young, density, found) in cases.items():
    print(key, young, density, found.rmse, found.errors.round(1).tolist())
