"""Pictures with Matplotlib. Each function draws into the given axes, or into new ones, and returns them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from sinew._engine import Run, Snapshot, State
from sinew.running import Changes, SceneLike, Workspace, simulate

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_COLORS = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#000000"]  # Okabe and Ito's


def _axes(axes: Axes | None, **of_subplot: Any) -> Axes:
    if axes is not None:
        return axes
    import matplotlib.pyplot as plt

    made: Axes = plt.figure(layout="constrained").add_subplot(**of_subplot)
    return made


def _shown(unit: str) -> tuple[str, float]:
    """What people speak of a unit in, and how much of it one is."""
    return {"m": ("mm", 1e3), "rad": ("deg", 180.0 / np.pi)}.get(unit, (unit, 1.0))


def signals(run: Run, names: Sequence[str] | None = None, axes: Axes | None = None) -> Axes:
    """Signals over time: those named, "tip" standing for all of "tip.x", "tip.y", "tip.z"; all outputs if none are."""
    units = dict(run.model.signals)
    wanted = list(run.model.outputs if names is None else names)
    chosen = [one for name in wanted for one in units if one == name or one.startswith(name + ".")]
    missing = [name for name in wanted if not any(one == name or one.startswith(name + ".") for one in units)]
    if missing or not chosen:
        raise ValueError(f"no signal {', '.join(missing) or 'was recorded'}; known: {', '.join(units)}")
    own = _axes(axes)
    kinds = {_shown(units[name])[0] for name in chosen}
    for i, name in enumerate(chosen):
        unit, factor = _shown(units[name])
        label = name if len(kinds) == 1 else f"{name} [{unit}]"
        own.plot(run.time, factor * run.signals[name], label=label, color=_COLORS[i % len(_COLORS)])
    own.set_xlabel("time [s]")
    if len(kinds) == 1:
        own.set_ylabel(f"[{kinds.pop()}]")
    own.legend(frameon=False)
    return own


def rod(state: State | Snapshot, name: str, fields: Sequence[str] = ("bending_y", "bending_z", "torsion"), axes: Axes | None = None) -> Axes:
    """What a rod bears along its length: fields of its snapshot ("torsion", "bending_y", ...) or "von_mises"."""
    snapshot = state.snapshot() if isinstance(state, State) else state
    found = [one for one in snapshot.rods if one.name == name]
    if not found:
        raise ValueError(f"no rod {name}; known: {', '.join(one.name for one in snapshot.rods)}")
    values = {**found[0].fields, "von_mises": found[0].von_mises}
    own = _axes(axes)
    color = 0
    for field in fields:
        if field not in values:
            raise ValueError(f"rod {name} has no {field}; known: {', '.join(values)}")
        rows = np.atleast_2d(values[field].T)
        for i, row in enumerate(rows):
            label = field if len(rows) == 1 else f"{field} {i + 1}"
            own.plot(1e3 * found[0].abscissa, row, label=label, color=_COLORS[color % len(_COLORS)])
            color += 1
    own.set_xlabel(f"along {name} [mm]")
    own.legend(frameon=False)
    return own


def shape(state: State | Snapshot, axes: Axes | None = None, *, colors: bool = True) -> Axes:
    """Solids, rods, bodies and outputs in space; solids in the colours of their displacement."""
    import matplotlib as mpl
    from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

    snapshot = state.snapshot() if isinstance(state, State) else state
    made = _axes(axes, projection="3d")
    own: Any = made
    everything = []
    for solid in snapshot.solids:
        corners = 1e3 * solid.nodes[solid.surface]
        everything.append(corners.reshape(-1, 3))
        move = np.linalg.norm(solid.nodes - solid.rest, axis=1)[solid.surface].mean(axis=1)
        faces = mpl.colormaps["viridis"](move / max(move.max(), 1e-12)) if colors else "#9ecae1"
        own.add_collection3d(Poly3DCollection(corners, facecolors=faces, alpha=0.25, linewidths=0.1, edgecolors="#555"))
    for body in snapshot.bodies:
        if not body.ground:
            everything.append(1e3 * body.points)
        own.add_collection3d(Poly3DCollection(1e3 * body.points[body.surface], facecolors="#bbb", alpha=0.5))
    for i, one in enumerate(snapshot.rods):
        points = 1e3 * one.points
        everything.append(points)
        own.add_collection3d(Line3DCollection([points], colors=_COLORS[(i + 1) % len(_COLORS)], linewidths=2))
    for name, point in snapshot.outputs.items():
        own.scatter(*(1e3 * point), color="black", s=12)
        own.text(*(1e3 * point), f" {name}", fontsize=8)
    whole = np.vstack(everything)
    middle, half = (whole.max(axis=0) + whole.min(axis=0)) / 2, max(np.ptp(whole, axis=0).max() / 2, 1e-3)
    for axis, center in zip("xyz", middle, strict=True):
        getattr(own, f"set_{axis}lim")(center - half, center + half)
        getattr(own, f"set_{axis}label")(f"{axis} [mm]")
    own.set_box_aspect((1, 1, 1))
    own.set_title(snapshot.when or f"t = {snapshot.time:.4g} s")
    return made


def section_convergence(
    scene: SceneLike, rod_name: str, output: str, counts: Sequence[int] = (3, 4, 6, 10, 20, 40), axes: Axes | None = None,
    *, changes: Changes = (),
) -> Axes:
    """How far an output ends from where the largest number of sections brings it, over the number of sections of a rod.

    `scene` is a file's name; it is run once for every count."""
    ends = []
    for count in counts:
        own_changes = [*_as_list(changes), f"rods.{rod_name}.sections={count}"]
        ends.append(np.array(simulate(scene, changes=own_changes, progress=False).state(-1).output(output)))
    errors = [1e3 * float(np.linalg.norm(end - ends[-1])) for end in ends[:-1]]
    own = _axes(axes)
    own.loglog(list(counts[:-1]), errors, "o-", color=_COLORS[0])
    own.set_xlabel(f"sections of {rod_name}")
    own.set_ylabel(f"{output}: distance from that of {counts[-1]} sections [mm]")
    own.grid(True, which="both", alpha=0.3)
    return own


def _as_list(changes: Changes) -> list[str]:
    from sinew.parts import assignments

    return assignments(changes)


def workspace(found: Workspace, axes: Axes | None = None) -> Axes:
    """Points that were reached within all limits, in the colours of the largest force."""
    made = _axes(axes, projection="3d")
    own: Any = made
    known = found.within & ~np.isnan(found.points).any(axis=1)
    points = 1e3 * found.points[known, :3]
    force = np.abs(found.forces[known]).max(axis=1)
    cloud = own.scatter(*points.T, c=force, cmap="viridis", s=8)
    own.figure.colorbar(cloud, ax=own, label="largest force of a motor [N]", shrink=0.7)
    for axis, name in zip("xyz", found.columns, strict=False):
        getattr(own, f"set_{axis}label")(f"{name} [mm]")
    own.set_aspect("equal")
    return made
