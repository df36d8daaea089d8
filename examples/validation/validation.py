"""What the scripts of this folder share: rods and blocks to begin with, and a rod solved without the engine."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

import sinew

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from dossier import ROOT, Result  # noqa: E402

__all__ = [
    "ALL", "Array", "Axis", "BENDING", "EXTENSIBLE", "Groups", "RAMP", "ROOT", "Result", "Strains",
    "across", "block", "path_length", "shoot", "solid_scene", "stiffness", "straight_rod", "wall",
]

Array = npt.NDArray[np.float64]
Axis = Literal["x", "y", "z"]
Strains = list[Literal["torsion", "bending_y", "bending_z", "elongation", "shear_y", "shear_z"]]
BENDING: Strains = ["torsion", "bending_y", "bending_z"]
EXTENSIBLE: Strains = [*BENDING, "elongation"]
ALL: Strains = [*EXTENSIBLE, "shear_y", "shear_z"]
RAMP = sinew.Table(times=[0, 1], values=[0, 1])
"""Loads grow from nothing to their value at t = 1."""


def stiffness(*six: float) -> sinew.StiffnessSection:
    """A section of given stiffness: G J, E I_y, E I_z [N m2], E A, k G A_y, k G A_z [N]."""
    return sinew.StiffnessSection(matrix=list(six), line_density=0, radius="10 mm")


def straight_rod(length: float, section: Any, sections: int = 1, strains: Strains | None = None, order: int = 0, steps: int = 1, **more: Any) -> sinew.Scene:
    """A rod clamped at the origin, straight along x, its cross-section's axes y and z those of the world; in equilibrium
    at `steps` times up to 1. The output `tip` is its end."""
    rod = sinew.Rod(
        **{
            "path": [[0, 0, 0], [length, 0, 0]],
            "up": [0, 1, 0],
            "sections": sections,
            "strains": strains or BENDING,
            "order": order,
            "section": section,
            **more,
        }
    )
    return sinew.Scene(
        analysis="quasi_static",
        time=sinew.Time(step=1.0 / steps, duration=1),
        rods={"rod": rod},
        outputs={"tip": sinew.Output(rod="rod", at=length)},
    )


def across(axis: Axis, at: float = 0.0) -> sinew.Plane:
    """The plane where this coordinate is `at`."""
    return sinew.Plane(point=[at * (axis == own) for own in "xyz"], normal=[float(axis == own) for own in "xyz"])


def wall(axis: Axis, at: float = 0.0) -> sinew.Held:
    """A smooth wall there: its nodes are held along that axis alone."""
    return sinew.Held(plane=across(axis, at), axes=[axis])


def path_length(path: Array) -> float:
    """[m] of the curve that the engine lays through these points."""
    rod = sinew.Rod(path=path.tolist(), start="rest", section=stiffness(1, 1, 1, 1, 1, 1))  # one section, which need not follow it
    model = sinew.build(sinew.Scene(analysis="quasi_static", rods={"rod": rod}))
    return float(model.initial_state().snapshot().rods[0].abscissa[-1])


Groups = Mapping[str, Callable[[Array], npt.NDArray[np.bool_]]]


def block(cells: tuple[int, int, int], place: Callable[[Array], Array], kind: str = "hex8", groups: Groups = {}) -> sinew.Mesh:
    """A unit cube cut into so many boxes, of hexahedra or of six tetrahedra each (`hex8`, `tet4`, `tet10`), its points (nodes, 3) moved to where `place`
    puts them, those in the middle of edges, too.

    groups: the faces of cells, or else the edges, all of whose nodes pass a test."""
    cube = sinew.Mesh.bar((1.0, 1.0, 1.0), cells)
    unit, boxes = cube.points + [0.0, 0.5, 0.5], cube.cells["hexahedron"]
    if kind == "hex8":
        parts, corners = boxes, [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]]
    else:
        six = [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]]
        parts, corners = np.concatenate([boxes[:, part] for part in six]), [[0, 1, 2], [0, 1, 3], [1, 2, 3], [0, 2, 3]]
    name, names = {"hex8": ("hexahedron", ["quad", "line"]), "tet4": ("tetra", ["triangle", "line"]), "tet10": ("tetra10", ["triangle6", "line3"])}[kind]
    faces = np.concatenate([parts[:, corner] for corner in corners])
    lines = np.concatenate([faces[:, [i - 1, i]] for i in range(faces.shape[1])])
    if kind == "tet10":
        ends, _ = np.unique(np.sort(lines, axis=1), axis=0, return_index=True)
        keys = ends @ [len(unit), 1]

        def middle(pairs: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
            return np.asarray(len(unit) + np.searchsorted(keys, np.sort(pairs, axis=-1) @ [len(unit), 1]))

        parts = np.hstack([parts, middle(parts[:, [[0, 1], [1, 2], [0, 2], [0, 3], [1, 3], [2, 3]]])])
        faces = np.hstack([faces, middle(faces[:, [[0, 1], [1, 2], [2, 0]]])])
        lines = np.hstack([lines, middle(lines)[:, None]])
        unit = np.vstack([unit, unit[ends].mean(axis=1)])
    points = place(unit)
    own: dict[str, list[Any]] = {}
    members: dict[str, dict[str, Any]] = {}
    for group, test in groups.items():
        passed = test(points)
        for form, sets in zip(names, [faces, lines], strict=True):
            chosen = sets[passed[sets].all(axis=1)]
            _, first = np.unique(np.sort(chosen, axis=1), axis=0, return_index=True)
            if len(first):
                begin = sum(map(len, own.get(form, [])))
                own.setdefault(form, []).append(chosen[first])
                members[group] = {form: np.arange(begin, begin + len(first))}
                break
    return sinew.Mesh(points, {name: parts, **{form: np.concatenate(sets) for form, sets in own.items()}}, members)


def solid_scene(mesh: sinew.Mesh, material: sinew.SolidMaterial, fixed: list[sinew.Held], **more: Any) -> sinew.Scene:
    """One solid in equilibrium under its loads."""
    solid = sinew.Solid(mesh=mesh, material=material, density=1000, fixed=fixed)
    return sinew.Scene(**{"analysis": "static", "solids": {"solid": solid}, **more})


def shoot(length: float, force: Array, six: Array, extensible: bool, steps: int = 400) -> Array:
    """Where the tip of such a clamped rod is under a dead force there, without the engine: the balance of moments is
    integrated from the base by Runge and Kutta's method; the moment there is what shooting finds."""
    limp = np.array([1.0, 1.0, 1.0]) / six[3:] if extensible else np.zeros(3)

    def slope(R: Array, m: Array, now: Array) -> tuple[Array, Array, Array]:
        kappa = np.einsum("nji,nj->ni", R, m) / six[:3]
        u = np.array([1.0, 0.0, 0.0]) + np.einsum("nji,j->ni", R, now) * limp
        p = np.einsum("nij,nj->ni", R, u)
        k = np.zeros((len(m), 3, 3))
        k[:, 2, 1], k[:, 0, 2], k[:, 1, 0] = kappa.T
        k -= k.transpose(0, 2, 1)
        return p, R @ k, np.cross(now, p)  # m' = -p' x n

    def ends(moments: Array, now: Array) -> tuple[Array, Array]:
        h = length / steps
        p, R, m = np.zeros_like(moments), np.tile(np.eye(3), (len(moments), 1, 1)), moments.copy()
        for _ in range(steps):
            a = slope(R, m, now)
            b = slope(R + h / 2 * a[1], m + h / 2 * a[2], now)
            c = slope(R + h / 2 * b[1], m + h / 2 * b[2], now)
            d = slope(R + h * c[1], m + h * c[2], now)
            p, R, m = (x + h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]) for i, x in enumerate((p, R, m)))
        return p, m

    size, moment = float(np.linalg.norm(force)) * length, np.zeros(3)
    for part in range(1, 7):
        now = force * part / 6
        for _ in range(12):
            d = 1e-6 * size
            _, left = ends(moment + np.vstack([np.zeros(3), d * np.eye(3), -d * np.eye(3)]), now)
            change = np.linalg.solve((left[1:4] - left[4:]).T / (2 * d), left[0])
            moment = moment - change
            if np.linalg.norm(change) < 1e-12 * size:
                break
    tip: Array = ends(moment[None], force)[0][0]
    return tip
