"""Pictures with Matplotlib. Each function draws into given axes, or into new ones, and returns them."""

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


def _panels(units: Sequence[str], axes: Axes | None) -> dict[str, Axes]:
    """Axes for each unit, one above the other; a single one may be given."""
    kinds = list(dict.fromkeys(units))
    if axes is not None:
        if len(kinds) > 1:
            raise ValueError(f"axes: values in {', '.join(kinds)} cannot share one; give names of one unit, or no axes")
        return {kinds[0]: axes}
    import matplotlib.pyplot as plt

    figure = plt.figure(figsize=(6.4, 1.2 + 2.4 * len(kinds)), layout="constrained")
    made = figure.subplots(len(kinds), 1, sharex=True, squeeze=False)[:, 0]
    return dict(zip(kinds, made, strict=True))


def _finish(panels: dict[str, Axes], below: str) -> list[Axes]:
    for unit, own in panels.items():
        own.set_ylabel(f"[{_shown(unit)[0]}]")
        own.legend(frameon=False, fontsize="small", ncols=1 + len(own.lines) // 7)
        own.grid(True, alpha=0.3)
    list(panels.values())[-1].set_xlabel(below)
    return list(panels.values())


def signals(run: Run, names: Sequence[str] | None = None, axes: Axes | None = None) -> list[Axes]:
    """Signals over time, those of one unit in axes of their own: those named, "tip" standing for "tip.x", "tip.y",
    "tip.z"; if none are, the outputs and what motors do. Targets are dashed, in the colours of their outputs."""
    units = dict(run.model.signals)
    known = [*units, *run.model.outputs, *run.model.actuators]
    default = [*run.model.outputs, *run.model.actuators]
    wanted = list(default if names is None else [names] if isinstance(names, str) else names)

    def stands_for(name: str) -> list[str]:
        if name in units:
            return [name]
        return [one for one in units if one.startswith(name + ".") and not one.endswith(".error")]

    missing = [name for name in wanted if not stands_for(name)]
    chosen = list(dict.fromkeys(one for name in wanted for one in stands_for(name)))
    if missing or not chosen:
        raise ValueError(f"no signal {', '.join(missing) or 'was recorded'}; known: {', '.join(known)}")
    panels = _panels([units[name] for name in chosen], axes)
    values = run.signals
    plain = [name for name in chosen if ".target" not in name]
    for unit, own in panels.items():
        here = [name for name in plain if units[name] == unit]
        aims = [name for name in chosen if name not in plain and units[name] == unit]
        for i, name in enumerate([*here, *aims]):
            of = name.replace(".target", "")
            place = here.index(of) if of in here else i
            style = "--" if name in aims else ["-", ":", "-."][place // len(_COLORS) % 3]
            own.plot(
                run.time, _shown(unit)[1] * values[name], style, label=name, color=_COLORS[place % len(_COLORS)]
            )
    return _finish(panels, "mode" if "mode.frequency" in units else "time [s]")


def _unit_of(field: str) -> str:
    """Of a field of a rod."""
    for end, unit in (("moment", "N m"), ("force", "N"), ("stress", "Pa"), ("von_mises", "Pa")):
        if end in field:
            return unit
    return "1/m" if field.startswith(("torsion", "bending")) else "1"


def rod(
    state: State | Snapshot, name: str, fields: Sequence[str] = ("bending_y", "bending_z", "torsion"), axes: Axes | None = None
) -> list[Axes]:
    """What a rod bears along its length, fields of one unit in axes of their own: fields of its snapshot ("torsion",
    "bending_y", "axial_force", ...) or "von_mises"."""
    snapshot = state.snapshot() if isinstance(state, State) else state
    found = [one for one in snapshot.rods if one.name == name]
    if not found:
        raise ValueError(f"no rod {name}; known: {', '.join(one.name for one in snapshot.rods)}")
    values = {**found[0].fields, "von_mises": found[0].von_mises}
    for field in fields:
        if field not in values:
            raise ValueError(f"rod {name} has no {field}; known: {', '.join(values)}")
    panels = _panels([_unit_of(field) for field in fields], axes)
    for unit, own in panels.items():
        for i, field in enumerate(one for one in fields if _unit_of(one) == unit):
            row = np.asarray(values[field]).ravel()
            constant = np.mean(np.diff(row) == 0.0) > 0.5  # along each section: where one ends, it jumps
            own.plot(
                1e3 * found[0].abscissa, row, label=field, color=_COLORS[i % len(_COLORS)],
                drawstyle="steps-post" if constant else "default",
            )
    return _finish(panels, f"along {name} [mm]")


def shape(state: State | Snapshot, axes: Axes | None = None, *, colors: bool = True) -> Axes:
    """Solids, rods, bodies and outputs in space; solids in the colours of their displacement."""
    import matplotlib as mpl
    from matplotlib.cm import ScalarMappable
    from matplotlib.colors import Normalize
    from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection

    snapshot = state.snapshot() if isinstance(state, State) else state
    made = _axes(axes, projection="3d")
    own: Any = made
    everything = [1e3 * body.points for body in snapshot.bodies if not body.ground]
    everything += [1e3 * one.points for one in snapshot.rods] + [1e3 * solid.nodes for solid in snapshot.solids]
    whole = np.vstack(everything or [1e3 * body.points for body in snapshot.bodies])
    least, most = whole.min(axis=0), whole.max(axis=0)
    pad = 0.05 * max(float((most - least).max()), 1e-3)
    narrow = np.maximum(0.15 * (most - least).max() - (most - least), 0.0) / 2  # what is flat keeps some room
    least, most = least - pad - narrow, most + pad + narrow
    moves = [1e3 * np.linalg.norm(solid.nodes - solid.rest, axis=1)[solid.surface].mean(axis=1) for solid in snapshot.solids]
    scale = Normalize(0.0, max([1e-9, *(float(move.max()) for move in moves)]))
    for solid, move in zip(snapshot.solids, moves, strict=True):
        faces = mpl.colormaps["viridis"](scale(move)) if colors else "#9ecae1"
        corners = 1e3 * solid.nodes[solid.surface]
        own.add_collection3d(Poly3DCollection(corners, facecolors=faces, alpha=0.3, linewidths=0.1, edgecolors="#555"))
    for body in snapshot.bodies:
        points = 1e3 * body.points
        if body.ground:
            points = np.clip(points, least, most)
        face = "#ddd" if body.ground else "#8c6d46"
        own.add_collection3d(
            Poly3DCollection(points[body.surface], facecolors=face, alpha=0.35 if body.ground else 0.9, zorder=-1 if body.ground else 1)
        )
    for i, one in enumerate(snapshot.rods):
        color = _COLORS[(i + 1) % len(_COLORS)]
        own.add_collection3d(Line3DCollection([1e3 * one.points], colors=color, linewidths=2, label=one.name))
    for name, point in snapshot.outputs.items():
        own.scatter(*(1e3 * point), color="black", s=12, zorder=10)
        own.text(*(1e3 * point), f" {name}", fontsize=8, zorder=10)
    for axis, low, high in zip("xyz", least, most, strict=True):
        getattr(own, f"set_{axis}lim")(low, high)
        getattr(own, f"set_{axis}label")(f"{axis} [mm]")
        bins = max(round(4 * (high - low) / float((most - least).max())), 1)  # numbers of short axes have room, too
        getattr(own, f"{axis}axis").set_major_locator(mpl.ticker.MaxNLocator(bins))
    own.set_box_aspect(most - least, zoom=0.82)
    own.set_title(snapshot.when or f"t = {snapshot.time:.4g} s")
    if snapshot.rods:
        own.legend(loc="upper left", frameon=False, fontsize="small")
    if colors and snapshot.solids and axes is None:
        own.figure.colorbar(ScalarMappable(scale, "viridis"), ax=own, shrink=0.6, label="displacement [mm]")
    return made


def section_convergence(
    scene: SceneLike, rod_name: str, output: str, counts: Sequence[int] = (3, 4, 6, 10, 20, 40), axes: Axes | None = None,
    *, changes: Changes = (),
) -> Axes:
    """How far an output ends from where the largest number of sections brings it, over the number of sections of a rod.

    The scene, which is no model yet, is run once for every count."""
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
    known = found.within & ~np.isnan(found.points).any(axis=1)
    points = 1e3 * found.points[known, :3]
    force = np.abs(found.forces[known]).max(axis=1)
    flat = np.ptp(points, axis=0) < 1e-6 * np.ptp(points, axis=0).max()
    if flat.any() and axes is None:  # in a plane
        made = _axes(None)
        shown = np.flatnonzero(~flat)[:2]
        while len(shown) < 2:
            shown = np.append(shown, np.setdiff1d(np.arange(points.shape[1]), shown)[0])
        flat_cloud = made.scatter(points[:, shown[0]], points[:, shown[1]], c=force, cmap="viridis", s=8)
        made.figure.colorbar(flat_cloud, ax=made, label="largest force of a motor [N]")
        made.set_xlabel(f"{found.columns[shown[0]]} [mm]")
        made.set_ylabel(f"{found.columns[shown[1]]} [mm]")
        made.set_aspect("equal")
        return made
    made = _axes(axes, projection="3d")
    own: Any = made
    cloud = own.scatter(*points.T, c=force, cmap="viridis", s=8)
    own.figure.colorbar(cloud, ax=own, label="largest force of a motor [N]", shrink=0.7)
    for axis, name in zip("xyz", found.columns, strict=False):
        getattr(own, f"set_{axis}label")(f"{name} [mm]")
    own.set_aspect("equal")
    return made
