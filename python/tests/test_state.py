"""States, their arrays and steps."""

from __future__ import annotations

import copy
import gc
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
    with pytest.raises(ValueError):
        sinew.State.from_numbers(model, [1.0])


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
        (3, "iterable"),
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
    assert np.isfinite(state.numbers()).all() and len(before) == len(state.numbers())


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
