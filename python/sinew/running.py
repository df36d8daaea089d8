"""From scenes to models and runs."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from copy import copy
from dataclasses import dataclass
from pathlib import Path
from typing import Any
from weakref import WeakValueDictionary

import numpy as np
import numpy.typing as npt

from sinew import _engine
from sinew._engine import Model, Run, State
from sinew.errors import InputError, Interrupted, StepFailed
from sinew.parts import assignments
from sinew.scene import Scene

SceneLike = Scene | str | os.PathLike[str] | Mapping[str, Any] | Model
"""A scene, the name of a scene file, a dict with the keys of one, or a model that was built before."""
Changes = Mapping[str, Any] | Sequence[str]
"""Changes of a scene by the places of values: {"rods.cable.sections": 30, "actuators.pull.displacement": "5 mm"}."""


def build(scene: SceneLike, changes: Changes = ()) -> Model:
    """Judges a scene and makes a model of it.

    changes: made to the scene before, by the places of values; the scene itself stays as it is. Throws InputError at the
    first fault."""
    if isinstance(scene, Model):
        if changes:
            raise ValueError("changes: a model cannot be changed any more, only a scene")
        return scene
    if isinstance(scene, str | os.PathLike):
        return _known(_engine.build_file(os.fspath(scene), assignments(changes)))
    if not isinstance(scene, Scene | Mapping):
        raise TypeError(f"a scene is a sinew.Scene, a file's name, a dict or a model, not {type(scene).__name__}")
    own = scene if isinstance(scene, Scene) else Scene.from_tree(scene)
    meshes: dict[str, bytes] = {}
    try:
        tree = own._tree(meshes)
    except RecursionError as error:
        raise InputError("the scene is nested without end: a part of it holds itself") from error
    return _known(_engine.build(tree, os.fspath(own.folder), assignments(changes), meshes))


_models: WeakValueDictionary[str, Model] = WeakValueDictionary()
"""Models by what they were made of, so that states that are unpickled share theirs."""


def _known(model: Model) -> Model:
    """The model, or the same one if it was built before: its states are then those of both."""
    return _models.setdefault(model.inputs_hash + os.path.abspath(model.folder), model)


def _reduced_model(model: Model) -> tuple[Any, ...]:
    return _built_again, (model.inputs_hash, model.text, os.path.abspath(model.folder), model.meshes)


def _built_again(inputs_hash: str, text: str, folder: str, meshes: dict[str, bytes]) -> Model:
    """The model of a pickle: the one that is there, or a new one."""
    model = _known(_engine.build_text(text, folder, meshes))
    if model.inputs_hash != inputs_hash:
        rule = "is not the folder that this was made in: the files that the scene names are others by now"
        remedy = "restore them, or build the scene again"
        raise InputError(f"{folder}: {rule}\n    {remedy}", file=folder, rule=rule, remedy=remedy)
    return model


def _state_again(*parts: Any) -> State:
    return _engine.unpacked(*parts)


def _run_again(*parts: Any) -> Run:
    return _engine.restored(*parts)


def simulate(
    scene: SceneLike,
    output: str | os.PathLike[str] | None = None,
    *,
    changes: Changes = (),
    state: State | None = None,
    commands: str | os.PathLike[str] | None = None,
    replace: bool = False,
    progress: bool | None = None,
    threads: int = 0,
    check: bool = True,
) -> Run:
    """Runs a scene to its end and returns every step of it.

    output: a results folder, written as the run goes on, as `sinew run -o` does; none if left out. `replace` one that
    is there.
    state: where to start, the state at t = 0 if left out.
    commands: a table, such as commands.csv of a run with targets, that drives the motors of a scene file, as `sinew run
    --commands`; targets are left out then.
    progress: a bar; if left out, one where the error output is a terminal.
    threads: that share the work of a step, 0: two if the machine has them. Results are the same for any number.
    check: throws StepFailed where a step cannot be made; if False, look at `run.end`.

    Ctrl-C throws Interrupted, a KeyboardInterrupt; like StepFailed it has the `run` up to there."""
    if commands is not None:
        if not isinstance(scene, str | os.PathLike):
            raise ValueError("commands: only the motors of a scene in a file are driven by a table")
        changes = assignments(changes)
        changes += _engine.driven_by(os.fspath(commands), os.fspath(scene), changes)
    model = build(scene, changes)
    name = model.title or (Path(scene).stem if isinstance(scene, str | os.PathLike) else "sinew")
    with _bar(name, model.duration, progress) as tell:
        run = _engine.simulate(
            model,
            model.initial_state() if state is None else state,
            None if output is None else os.fspath(output),
            replace,
            tell,
            threads,
        )
        if tell and run.end == "done":
            tell(model.duration, "done")
    if run.end == "interrupted":
        raise Interrupted(f"interrupted at t = {run.time[-1]:.6g} s; what was done is in the exception's `run`", run)
    if check and run.end == "numerical_stop":
        raise StepFailed(f"{run.failure} at t = {run.time[-1]:.6g} s: {run.failure_detail}", run)
    return run


def read_run(folder: str | os.PathLike[str]) -> Run:
    """A run from its results folder, or from its recording `run.sinew`. Throws InputError where its scene's files are
    others by now."""
    run = _engine.read_run(os.fspath(folder))
    return _engine.run_of(_known(run.model), run)


@dataclass
class Workspace:
    """Equilibria under commands from all over the limits of the motors that are sought."""

    motors: list[str]
    """Names of these motors."""
    columns: list[str]
    """Names of what `points` has in its columns: "tip.x"."""
    status: list[str]
    """How the search for each equilibrium ended."""
    within: npt.NDArray[np.bool_]
    """Whether its forces and places keep all limits."""
    forces: npt.NDArray[np.float64]
    """[N] or [N m] of each motor, (samples, motors); NaN where not known."""
    positions: npt.NDArray[np.float64]
    """[m] or [rad] of each motor, (samples, motors); NaN where not known."""
    points: npt.NDArray[np.float64]
    """Where the outputs with a target were brought, (samples, columns); NaN where not known."""


def map_workspace(
    scene: SceneLike, samples: int = 300, *, changes: Changes = (), progress: bool | None = None, threads: int = 1
) -> Workspace:
    """Where the motors can bring what has a target, as `sinew workspace`, which makes the scene quasi-static and has
    its steps converge; here the scene says so itself: `analysis="quasi_static"`, or
    `changes={"analysis": "quasi_static", "newton": "converged"}` for a file.

    Throws InputError where a motor's limit is missing."""
    model = build(scene, changes)
    with _bar("workspace", float(samples), progress) as tell:
        motors, columns, status, within, forces, positions, points, interrupted = _engine.workspace(
            model, samples, tell, threads
        )
        if tell and not interrupted:
            tell(float(samples), "done")
    found = Workspace(motors, columns, status, np.array(within, dtype=np.bool_), forces, positions, points)
    if interrupted:
        raise Interrupted("interrupted; what was found is in the exception's `run`", found)
    return found


@contextmanager
def _bar(name: str, total: float, wanted: bool | None) -> Iterator[Callable[[float, str], None] | None]:
    """What tells how far a run is."""
    if not (sys.stderr.isatty() if wanted is None else wanted):
        yield None
        return
    from tqdm.auto import tqdm

    form = "{l_bar}{bar}| {postfix} [{elapsed}<{remaining}]"
    with tqdm(total=total, desc=name, bar_format=form) as bar:

        def tell(done: float, note: str) -> None:
            bar.set_postfix_str(note, refresh=False)
            bar.update(done - bar.n)

        yield tell
