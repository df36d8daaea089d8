"""Meshes given as arrays."""

from __future__ import annotations

import hashlib
import os
import warnings
from collections.abc import Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeGuard

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    import meshio

_GMSH = {
    "vertex": 15,
    "line": 1,
    "line3": 8,
    "triangle": 2,
    "triangle6": 9,
    "quad": 3,
    "tetra": 4,
    "tetra10": 11,
    "hexahedron": 5,
}
_NODES = {
    "vertex": 1,
    "line": 2,
    "line3": 3,
    "triangle": 3,
    "triangle6": 6,
    "quad": 4,
    "tetra": 4,
    "tetra10": 10,
    "hexahedron": 8,
}
_DIMENSION = {"vertex": 0, "line": 1, "line3": 1, "triangle": 2, "triangle6": 2, "quad": 2}


def is_meshio(value: object) -> TypeGuard[meshio.Mesh]:
    """Whether this is a mesh of meshio, without importing it."""
    return type(value).__module__.split(".")[0] == "meshio" and hasattr(value, "cells_dict")


class Mesh:
    """A mesh given as arrays, to be used where a scene names a file. It is a value: its arrays are read only.

    points: positions of the nodes, (nodes, 3), in metres unless the scene gives a scale.
    cells: nodes of the cells of each kind under meshio's names, {"tetra": (cells, 4)}; also tetra10, hexahedron, and
    triangle, triangle6, quad, line, line3, vertex for groups of faces, edges and nodes.
    groups: names of parts, each with the numbers of its cells of each kind, {"base": {"triangle": [0, 1]}}.
    """

    def __init__(
        self,
        points: npt.ArrayLike,
        cells: Mapping[str, npt.ArrayLike],
        groups: Mapping[str, Mapping[str, npt.ArrayLike]] | None = None,
    ) -> None:
        self.points: npt.NDArray[np.float64] = np.array(points, dtype=np.float64)
        if self.points.ndim != 2 or self.points.shape[1] != 3:
            raise ValueError(f"points: must have the shape (nodes, 3), not {self.points.shape}")
        if not np.isfinite(self.points).all():
            raise ValueError("points: must be finite")
        self.cells: dict[str, npt.NDArray[np.int64]] = {}
        for kind, nodes in cells.items():
            if kind not in _GMSH:
                raise ValueError(f"cells: {kind!r} is not known here; known: {', '.join(_GMSH)}")
            own = np.array(nodes)
            if own.ndim != 2 or own.shape[1] != _NODES[kind] or not np.issubdtype(own.dtype, np.integer):
                raise ValueError(f"cells[{kind!r}]: must be whole numbers with the shape (cells, {_NODES[kind]})")
            if own.size > 0 and (own.min() < 0 or own.max() >= len(self.points)):
                raise ValueError(f"cells[{kind!r}]: node {own.min() if own.min() < 0 else own.max()} does not exist")
            self.cells[kind] = own.astype(np.int64)
        self.groups: dict[str, dict[str, npt.NDArray[np.int64]]] = {}
        for name, members in (groups or {}).items():
            if not name or not name.isprintable() or '"' in name:
                raise ValueError(f"groups: {name!r} is no name that a mesh file can hold")
            self.groups[name] = {}
            for kind, numbers in members.items():
                given = np.array(numbers).ravel()
                if given.dtype == np.bool_ and kind in self.cells and len(given) == len(self.cells[kind]):
                    given = np.flatnonzero(given)
                if given.size > 0 and not np.issubdtype(given.dtype, np.integer):
                    raise ValueError(f"groups[{name!r}]: must be numbers of cells, or a mask of all of the kind {kind!r}")
                chosen = given.astype(np.int64)
                if kind not in self.cells or (chosen.size > 0 and not 0 <= chosen.min() <= chosen.max() < len(self.cells[kind])):
                    raise ValueError(f"groups[{name!r}]: there are no such cells of the kind {kind!r}")
                self.groups[name][kind] = chosen
        for array in (self.points, *self.cells.values(), *(own for group in self.groups.values() for own in group.values())):
            array.setflags(write=False)

    @classmethod
    def bar(
        cls, size: tuple[float, float, float], cells: tuple[int, int, int], taper: float = 1.0
    ) -> Mesh:
        """A straight bar of hexahedra along x, from x = 0, its axis on y = z = 0; its far end is `taper` times as wide
        and high as its near one.

        size: length, width and height [m]. cells: their number along each. Groups: "start" and "end", its end faces."""
        nx, ny, nz = cells
        if min(cells) < 1 or not all(0 < own < np.inf for own in (*size, taper)):
            raise ValueError("bar: needs a size above 0 and at least one cell each way")
        t, y, z = np.meshgrid(*(np.linspace(0.0, 1.0, n + 1) for n in cells), indexing="ij")
        across = 1.0 + (taper - 1.0) * t
        points = np.stack([size[0] * t, size[1] * across * (y - 0.5), size[2] * across * (z - 0.5)], axis=-1)
        number = np.arange(t.size).reshape(t.shape)

        def corner(i: int, j: int, k: int) -> npt.NDArray[np.int64]:
            return number[i : nx + i, j : ny + j, k : nz + k].ravel()

        around = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
        hexahedra = np.stack([corner(*own) for own in around], axis=1)

        def face(i: int, order: list[tuple[int, int]]) -> npt.NDArray[np.int64]:
            plane = number[i]
            return np.stack([plane[j : ny + j, k : nz + k].ravel() for j, k in order], axis=1)

        start = face(0, [(0, 0), (0, 1), (1, 1), (1, 0)])
        end = face(nx, [(0, 0), (1, 0), (1, 1), (0, 1)])
        groups = {
            "start": {"quad": np.arange(len(start))},
            "end": {"quad": np.arange(len(start), len(start) + len(end))},
        }
        return cls(points.reshape(-1, 3), {"hexahedron": hexahedra, "quad": np.vstack([start, end])}, groups)

    @classmethod
    def from_meshio(cls, mesh: meshio.Mesh) -> Mesh:
        """A mesh of meshio: `sinew.Mesh.from_meshio(meshio.read("arm.bdf"))`. Its cell sets become groups; cells of
        other kinds are left out, with a warning."""
        left_out = sorted(set(mesh.cells_dict) - set(_GMSH))
        if left_out:
            warnings.warn(f"cells that Sinew does not know are left out: {', '.join(left_out)}", stacklevel=2)
        points = np.zeros((len(mesh.points), 3))
        points[:, : mesh.points.shape[1]] = mesh.points
        cells = {kind: nodes for kind, nodes in mesh.cells_dict.items() if kind in _GMSH}
        groups = {}
        for name, members in mesh.cell_sets_dict.items():
            own = {kind: numbers for kind, numbers in members.items() if kind in cells}
            if own and not name.startswith("gmsh:"):
                groups[name] = own
        return cls(points, cells, groups)

    @classmethod
    def read(cls, path: str | os.PathLike[str]) -> Mesh:
        """A mesh of any file that meshio reads: MED, XDMF, Nastran, ... A scene reads legacy VTK, VTU, Gmsh and
        Abaqus files by itself, with their groups."""
        import meshio

        return cls.from_meshio(meshio.read(path))

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes a file of Gmsh (2.2, ASCII), with every bit of the positions."""
        Path(path).write_bytes(self._content)

    @cached_property
    def _content(self) -> bytes:
        """The file of Gmsh."""
        tags = {name: number for number, name in enumerate(self.groups, 1)}
        lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat"]
        named = [
            f'{_DIMENSION.get(kind, 3)} {tags[name]} "{name}"' for name, members in self.groups.items() for kind in members
        ]
        named = list(dict.fromkeys(named))
        if named:
            lines += ["$PhysicalNames", str(len(named)), *named, "$EndPhysicalNames"]
        lines += ["$Nodes", str(len(self.points))]
        lines += [f"{i} {x!r} {y!r} {z!r}" for i, (x, y, z) in enumerate(self.points.tolist(), 1)]
        lines += ["$EndNodes", "$Elements"]
        elements: list[str] = []
        for kind, cells in self.cells.items():
            order = [*range(8), 9, 8] if kind == "tetra10" else list(range(cells.shape[1]))
            nodes = [" ".join(map(str, own)) for own in (cells[:, order] + 1).tolist()]
            left = np.ones(len(cells), dtype=bool)
            for name, members in self.groups.items():
                for number in members.get(kind, np.empty(0, dtype=np.int64)).tolist():
                    left[number] = False
                    elements.append(f"{_GMSH[kind]} 2 {tags[name]} {tags[name]} {nodes[number]}")
            elements += [f"{_GMSH[kind]} 0 {nodes[number]}" for number in np.flatnonzero(left)]
        lines.append(str(len(elements)))
        lines += [f"{i} {element}" for i, element in enumerate(elements, 1)]
        lines.append("$EndElements")
        return ("\n".join(lines) + "\n").encode()

    @cached_property
    def _name(self) -> str:
        """What scenes call it: other content, another name."""
        return f"mesh-{hashlib.sha256(self._content).hexdigest()[:16]}.msh"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Mesh) and self._content == other._content

    def __hash__(self) -> int:
        return hash(self._name)

    def __getstate__(self) -> dict[str, Any]:
        return {"points": self.points, "cells": self.cells, "groups": self.groups}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__init__(**state)  # type: ignore[misc]

    def __repr__(self) -> str:
        counts = ", ".join(f"{len(nodes)} {kind}" for kind, nodes in self.cells.items())
        return f"<sinew.Mesh of {len(self.points)} nodes, {counts}>"
