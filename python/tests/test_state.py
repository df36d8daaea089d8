"""States, their arrays and steps."""

from __future__ import annotations

import copy
import gc
import itertools
import pickle
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest

import sinew


def test_arrays_never_change(finger: Path) -> None:
    model = sinew.build(finger)
    state = model.initial_state()
    x, q, forces = state.solids["finger"].x, state.rods["cable"].q, state.forces
    before = x.copy(), q.copy(), forces.copy()
    for _ in range(3):
        assert sinew.step(model, {"pull": "1 mm"}, state).accepted
    assert (x == before[0]).all() and (q == before[1]).all() and (forces == before[2]).all()
    assert np.abs(state.solids["finger"].x - x).max() > 1e-4
    for array in (x, q, forces, state.multipliers, state.solids["finger"].v):
        with pytest.raises(ValueError):
            array[...] = 0.0


def test_arrays_outlive_state_and_model(finger: Path) -> None:
    state = sinew.build(finger).initial_state()
    x = state.solids["finger"].x
    nodes = state.snapshot().solids[0].nodes
    copies = x.copy(), nodes.copy()
    del state
    gc.collect()
    rubbish = [np.random.default_rng(0).random(900) for _ in range(200)]
    assert (x == copies[0]).all() and (nodes == copies[1]).all() and rubbish


def test_arrays_look_at_the_engine_without_copies(finger: Path) -> None:
    state = sinew.build(finger).initial_state()
    one, other = state.solids["finger"].x, state.solids["finger"].x
    assert one.__array_interface__["data"] == other.__array_interface__["data"]
    assert not one.flags.owndata


@pytest.mark.parametrize("how", [lambda s: s.copy(), copy.copy, copy.deepcopy, lambda s: pickle.loads(pickle.dumps(s))])
def test_a_copy_is_a_checkpoint(finger: Path, how: object) -> None:
    model = sinew.build(finger)
    state = model.initial_state()
    for k in range(3):
        sinew.step(model, {"pull": 1e-3 * k}, state)
    kept = how(state)  # type: ignore[operator]
    assert kept.model is model
    for _ in range(2):
        ends = []
        for own in (state.copy(), kept.copy()):
            for _ in range(2):
                assert sinew.step(model, {"pull": 4e-3}, own).accepted
            ends.append(own.numbers())
        assert (ends[0] == ends[1]).all()
    assert kept.time == pytest.approx(0.03)


def test_numbers_make_a_state_again(small: Path) -> None:
    model = sinew.build(small)
    state = model.initial_state()
    sinew.step(model, [0.1], state)
    again = sinew.State.from_numbers(model, state.numbers().tolist())
    assert again.time == state.time and (again.rods["arm"].q == state.rods["arm"].q).all()
    assert (again.forces == state.forces).all()
    ends = []
    for own in (state, again, pickle.loads(pickle.dumps(state))):
        sinew.step(model, None, own)  # all go on with what was told
        ends.append(own.numbers())
    assert (ends[0] == ends[1]).all() and (ends[0] == ends[2]).all()
    run = sinew.simulate(model, state=state, progress=False)
    assert run.signals["draw.force"].min() == 0.1
    with pytest.raises(ValueError):
        sinew.State.from_numbers(model, [1.0])
    for place, value in ((0, np.nan), (0, 1e300), (-1, np.inf)):
        numbers = state.numbers().copy()
        numbers[place] = value
        with pytest.raises(ValueError, match="finite|time"):
            sinew.State.from_numbers(model, numbers.tolist())


def test_commands_by_name_by_order_and_as_text(small: Path) -> None:
    model = sinew.build(small)
    assert model.commands == [("draw.force", "N")]
    ends = []
    for command in ({"draw": 0.2}, {"draw": "200 mN"}, [0.2], np.array([0.2]), ("0.2 N",)):
        state = model.initial_state()
        assert sinew.step(model, command, state, loads={"weight": 2.0}).accepted
        ends.append(state.numbers())
    assert all((end == ends[0]).all() for end in ends)
    state = model.initial_state()
    sinew.step(model, {"draw": 0.2}, state, loads=[2.0])
    assert (state.numbers() == ends[0]).all()
    assert state.forces[0] == 0.2
    sinew.step(model, None, state)  # what is driven from outside keeps what it was told
    assert state.forces[0] == 0.2
    sinew.step(model, {}, pickle.loads(pickle.dumps(state)))


@pytest.mark.parametrize(
    ("command", "message"),
    [
        ({"drow": 1}, "did you mean `draw`"),
        ({"draw": float("nan")}, "finite"),
        ({"draw": "2 mm"}, "force"),
        ([1.0, 2.0], "there are 1, not 2"),
        ([], "there are 1, not 0"),
        ({"draw": None}, "float|real|number"),
        (3, "must be a dict by names, or a list"),
        ({0.1}, "must be a dict by names, or a list"),
        ("0.1", "must be a dict by names, or a list"),
        (1j * np.ones(1), "real"),
        (itertools.repeat(0.1), "there are 1, not more"),
    ],
)
def test_bad_commands_are_refused_and_nothing_happens(small: Path, command: object, message: str) -> None:
    model = sinew.build(small)
    state = model.initial_state()
    before = state.numbers()
    with pytest.raises((ValueError, TypeError), match=message):
        sinew.step(model, command, state)  # type: ignore[arg-type]
    assert (state.numbers() == before).all()


def test_states_of_other_models_are_refused(small: Path, finger: Path) -> None:
    one, other = sinew.build(small), sinew.build(finger)
    with pytest.raises(ValueError, match="another model"):
        sinew.step(one, None, other.initial_state())


def test_a_step_that_fails_tells_and_keeps_the_state(finger: Path) -> None:
    model = sinew.build(finger, {"newton": {"limit": 3}})
    state = model.initial_state()
    before = state.numbers()
    report = sinew.step(model, {"pull": 10.0}, state)
    assert not report.accepted and report.status in {"max_iterations", "singular", "diverged", "inverted"}
    assert report.meaning
    # It was halved first; what stays is the last that was accepted, which goes on.
    assert state.time < model.time_step and np.isfinite(state.numbers()).all()
    if state.time == 0.0:
        assert (state.numbers() == before).all()
    model = sinew.build(finger)
    assert sinew.step(model, {"pull": 1e-4}, sinew.State.from_numbers(model, state.numbers().tolist())).accepted


def test_threads_give_what_one_after_the_other_gives(finger: Path) -> None:
    model = sinew.build(finger)

    def work(number: int) -> np.ndarray:
        state = model.initial_state()
        for k in range(20):
            assert sinew.step(model, {"pull": 1e-4 * k * (1 + number)}, state).accepted
        return state.numbers()

    alone = [work(number) for number in range(6)]
    with ThreadPoolExecutor(6) as pool:
        together = list(pool.map(work, range(6)))
    assert all((a == b).all() for a, b in zip(alone, together, strict=True))


def test_two_threads_cannot_step_one_state(finger: Path) -> None:
    model = sinew.build(finger)
    state = model.initial_state()
    refused: list[str] = []
    start = threading.Barrier(2)

    def work() -> None:
        start.wait()
        for _ in range(200):
            try:
                sinew.step(model, {"pull": 1e-3}, state)
            except RuntimeError as error:
                refused.append(str(error))

    threads = [threading.Thread(target=work) for _ in range(2)]
    for own in threads:
        own.start()
    for own in threads:
        own.join()
    assert refused and all("another thread" in text for text in refused)
    assert np.isfinite(state.numbers()).all()


def test_two_threads_of_a_step_give_the_same_bits(finger: Path) -> None:
    ends = []
    for threads in (1, 2):
        model = sinew.build(finger)
        state = model.initial_state()
        for _ in range(5):
            sinew.step(model, {"pull": 1e-3}, state, threads=threads)
        ends.append(state.numbers())
    assert (ends[0] == ends[1]).all()


def test_everything_a_state_shows(finger: Path) -> None:
    model = sinew.build(finger)
    state = model.initial_state()
    sinew.step(model, {"pull": "2 mm"}, state)
    assert state.signals.keys() == dict(model.signals).keys()
    assert state.output("tip")[2] == state.signals["tip.z"]
    assert state.displacements[0] == pytest.approx(2e-3)
    assert state.energies.total == state.energies.kinetic + state.energies.elastic + state.energies.weight
    assert state.abscissae.shape == (7,)
    seen = state.snapshot()
    solid, rod = seen.solids[0], seen.rods[0]
    assert solid.cells["tetra"].shape[1] == 4 and solid.surface.shape[1] == 3
    assert len(solid.von_mises) == len(solid.cells["tetra"]) and solid.fields["stress"].shape[1] == 6
    assert rod.points.shape == rod.tangents.shape == (len(rod.abscissa), 3)
    assert rod.fields["bending_y"].shape == rod.abscissa.shape
    assert set(seen.outputs) == {"tip"} and len(seen.sliding_points) == 7
    with pytest.raises(sinew.InputError, match="did you mean `tip`"):
        state.output("tipp")


def test_what_is_told_is_taken_before_the_state_is_touched(small: Path) -> None:
    """Values may come from code that looks at the state, copies it or steps it."""
    model = sinew.build(small)
    state = model.initial_state()
    kept = []

    class Value:
        def __float__(self) -> float:
            kept.append((state.copy(), state.rods["arm"].q, state.rods["arm"].q.copy()))
            sinew.step(model, [0.3], state)
            return 0.1

    assert sinew.step(model, {"draw": Value()}, state).accepted  # type: ignore[dict-item]
    copy_, view, numbers = kept[0]
    assert state.grid == 2 and copy_.time == 0.0 and (view == numbers).all()


def test_motors_that_are_looked_for_can_be_told() -> None:
    from conftest import EXAMPLES

    changes = {"analysis": "quasi_static", "newton": "converged"}
    model = sinew.build(EXAMPLES / "reach.yaml", changes)
    state = model.initial_state()
    told = [0.5, 0.4, 0.3, 0.2]
    report = sinew.step(model, told, state)
    assert report.accepted and report.targets == "" and state.forces.tolist() == pytest.approx(told, abs=1e-12)
    jacobian = sinew.jacobian(model, state, "equilibrium")
    ends = []
    for sign in (1, -1):
        own = state.copy()
        sinew.step(model, [told[0] + sign * 1e-3, *told[1:]], own)
        ends.append(own.output("tip"))
    assert jacobian.effectors[:, 0] == pytest.approx((ends[0] - ends[1]) / 2e-3, rel=1e-4, abs=1e-7)
    with pytest.raises(sinew.InputError, match="is looked for"):
        sinew.step(model, {"pull_right": 1.0}, state)
    with pytest.raises(sinew.InputError, match="together"):
        sinew.step(model, told, state, targets={"tip": [0, 0, 0]})


def test_part_of_a_target_leaves_the_rest() -> None:
    from conftest import EXAMPLES

    model = sinew.build(EXAMPLES / "reach.yaml", {"targets.tip.at": "external"})
    state = model.initial_state()
    start = state.output("tip")
    report = sinew.step(model, None, state, targets={"tip": {"y": start[1] + 1e-4}})
    assert report.reached, report.targets
    assert state.output("tip") == pytest.approx(start + [0, 1e-4, 0], abs=1e-3)


def test_bits_do_not_depend_on_who_else_builds(tmp_path: Path) -> None:
    tree = {
        "time": {"step": "10 ms", "duration": "20 ms"},
        "solids": {
            "bar": {
                "mesh": sinew.Mesh.bar((0.2, 0.08, 0.08), (20, 8, 8)),
                "material": {"young": "1 MPa", "poisson": 0.3},
                "density": 1000,
                "fixed": {"group": "start"},
            }
        },
        "gravity": [0, 0, -9.81],
    }

    def work(number: int) -> np.ndarray:
        model = sinew.build({**tree, "title": str(number)})  # each its own
        state = model.initial_state()
        sinew.step(model, None, state)
        return state.numbers()

    alone = work(0)
    with ThreadPoolExecutor(4) as pool:
        assert all((own == alone).all() for own in pool.map(work, range(1, 5)))


def test_forked_processes_step_and_end(small: Path) -> None:
    code = f"""
import os, sys, sinew
model = sinew.build({str(small)!r})
state = model.initial_state()
mesh = sinew.Mesh.bar((0.1, 0.02, 0.02), (2, 1, 1))
sinew.step(model, [0.1], state, threads=2)
child = os.fork()
sinew.step(model, [0.1], state, threads=2)
numbers = state.numbers().sum()
del model, state, mesh
if child == 0:
    os._exit(0 if numbers == numbers else 1)
_, status = os.waitpid(child, 0)
sys.exit(status)
"""
    import subprocess
    import sys

    assert subprocess.run([sys.executable, "-W", "ignore", "-c", code], timeout=60).returncode == 0


@pytest.mark.parametrize("bad", [np.zeros((0, 2)), np.zeros((2, 0)), np.full((2, 2), np.nan)])
def test_manipulability_of_nothing_is_refused(bad: np.ndarray) -> None:
    with pytest.raises(ValueError, match="finite"):
        sinew.manipulability(bad)
