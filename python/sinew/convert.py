"""Runs and states as objects of other libraries: pandas, meshio, PyVista. Each is imported when it is asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from sinew._engine import Run, Snapshot, State

if TYPE_CHECKING:
    import meshio
    import pandas
    import pyvista


def to_pandas(run: Run) -> pandas.DataFrame:
    """A run as a table: the signals, by time [s], with `status` and `newton` in front."""
    import pandas as pd

    index = pd.Index(run.time, name="time")
    return pd.DataFrame({"status": run.status, "newton": run.newton.astype(int), **run.signals}, index=index)


def to_meshio(state: State | Snapshot) -> meshio.Mesh:
    """All of a state as one mesh: solids by their cells, rods as lines, bodies as triangles, positions as they are now.

    Data of points: displacement [m] (of solids). Of cells: object (the number among `cell_sets`), von_mises [Pa] of
    solids; NaN where a thing has none. Every object is a cell set of its name."""
    import meshio

    snapshot = state.snapshot() if isinstance(state, State) else state
    points: list[Any] = []
    moved: list[Any] = []
    cells: list[tuple[str, Any]] = []
    stress: list[Any] = []
    number: list[Any] = []
    sets: dict[str, list[int]] = {}
    first = 0

    def add(name: str, kind: str, nodes: Any, values: Any = None) -> None:
        sets.setdefault(name, []).append(len(cells))
        cells.append((kind, nodes + first))
        number.append(np.full(len(nodes), list(sets).index(name)))
        stress.append(np.full(len(nodes), np.nan) if values is None else values)

    for solid in snapshot.solids:
        values = solid.von_mises
        kinds = solid.cells
        for kind, nodes in kinds.items():
            # Stresses follow the order of the mesh, which only a mesh of one kind has in `cells`.
            add(solid.name, kind, nodes, values if len(kinds) == 1 else None)
        points.append(solid.nodes)
        moved.append(solid.nodes - solid.rest)
        first += len(solid.nodes)
    for rod in snapshot.rods:
        along = np.arange(len(rod.points) - 1)
        add(rod.name, "line", np.column_stack([along, along + 1]))
        points.append(rod.points)
        moved.append(np.full_like(rod.points, np.nan))
        first += len(rod.points)
    for body in snapshot.bodies:
        add(body.name, "triangle", body.surface)
        points.append(body.points)
        moved.append(np.full_like(body.points, np.nan))
        first += len(body.points)
    of_all = {
        name: [np.arange(len(nodes)) if i in own else np.empty(0, dtype=int) for i, (_, nodes) in enumerate(cells)]
        for name, own in sets.items()
    }
    return meshio.Mesh(
        np.vstack(points),
        cells,
        point_data={"displacement": np.vstack(moved)},
        cell_data={"von_mises": stress, "object": number},
        cell_sets=of_all,
    )


def to_pyvista(state: State | Snapshot) -> pyvista.MultiBlock:
    """A state as PyVista blocks by the names of objects: solids as unstructured grids with von_mises [Pa] and
    displacement [m], rods as tubes of their radius, bodies as surfaces."""
    import pyvista as pv

    snapshot = state.snapshot() if isinstance(state, State) else state
    blocks = pv.MultiBlock()
    types = {"tetra": pv.CellType.TETRA, "tetra10": pv.CellType.QUADRATIC_TETRA, "hexahedron": pv.CellType.HEXAHEDRON}
    for solid in snapshot.solids:
        grid = pv.UnstructuredGrid({types[kind]: nodes for kind, nodes in solid.cells.items()}, np.array(solid.nodes))
        grid.point_data["displacement"] = solid.nodes - solid.rest
        if len(solid.cells) == 1:
            grid.cell_data["von_mises"] = np.array(solid.von_mises)
        blocks[solid.name] = grid
    for rod in snapshot.rods:
        line = pv.lines_from_points(np.array(rod.points))
        if len(rod.von_mises) > 0:
            line.point_data["von_mises"] = np.array(rod.von_mises)
        line.point_data["radius"] = np.array(rod.radius)
        blocks[rod.name] = line.tube(scalars="radius", absolute=True) if rod.radius.max() > 0 else line
    for body in snapshot.bodies:
        blocks[body.name] = pv.PolyData.from_regular_faces(np.array(body.points), np.array(body.surface))
    return blocks
