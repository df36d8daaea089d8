"""Whole runs: as the program makes them, interrupted, saved, pickled."""

from __future__ import annotations

import csv
import pickle
import signal
import subprocess
import sys
import textwrap
from pathlib import Path

import numpy as np
import pytest
from conftest import EXAMPLES

import sinew


@pytest.mark.parametrize("name", ["finger", "tendon_arm", "reach"])
def test_python_and_the_program_agree_bit_for_bit(name: str, program: str, tmp_path: Path) -> None:
    changes = {"time.duration": "0.2 s"} if name != "tendon_arm" else {}
    flags = [f"--set={path}={value}" for path, value in changes.items()]
    subprocess.run(
        [program, "run", EXAMPLES / f"{name}.yaml", "-o", tmp_path / "program", "--quiet", *flags], check=True
    )
    own = sinew.simulate(EXAMPLES / f"{name}.yaml", tmp_path / "python", changes=changes, progress=False)
    assert (tmp_path / "program" / "run.sinew").read_bytes() == (tmp_path / "python" / "run.sinew").read_bytes()
    theirs = sinew.read_run(tmp_path / "program")
    assert len(theirs) == len(own)
    for k in range(len(own)):
        assert (theirs.state(k).numbers() == own.state(k).numbers()).all()
    with open(tmp_path / "program" / "signals.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    for key, values in own.signals.items():
        assert [float(row[key]) for row in rows] == values.tolist()


@pytest.mark.parametrize("name", ["finger", "reach"])
def test_steps_are_those_of_a_run(name: str) -> None:
    changes = {"time.duration": "0.1 s"}
    run = sinew.simulate(EXAMPLES / f"{name}.yaml", changes=changes, progress=False)
    model = sinew.build(EXAMPLES / f"{name}.yaml", changes)
    state = model.initial_state()
    for k in range(1, model.steps + 1):
        report = sinew.step(model, None, state)
        assert report.accepted and (state.numbers() == run.state(k).numbers()).all()
        assert report.targets == run.targets[k]


def test_a_run_is_saved_read_and_pickled(small: Path, tmp_path: Path) -> None:
    run = sinew.simulate(small, progress=False)
    assert run.end == "done" and len(run) == 11 and run.time[-1] == pytest.approx(0.1)
    run.save(tmp_path / "out")
    with pytest.raises(sinew.InputError, match="already holds"):
        run.save(tmp_path / "out")
    run.save(tmp_path / "out", replace=True)
    for own in (sinew.read_run(tmp_path / "out"), pickle.loads(pickle.dumps(run))):
        assert len(own) == len(run) and own.status == run.status and own.end == "done"
        assert all((own.signals[key] == run.signals[key]).all() for key in run.signals)
        assert (own.state(-1).numbers() == run.state().numbers()).all()
    assert {file.name for file in (tmp_path / "out").iterdir()} >= {"run.sinew", "signals.csv", "picture.png"}
    with pytest.raises(IndexError):
        run.state(11)


def test_a_run_goes_on_from_a_state(small: Path) -> None:
    model = sinew.build(small)
    whole = sinew.simulate(model, progress=False)
    part = sinew.simulate(model, state=whole.state(5), progress=False)
    assert len(part) == 6 and (part.state().numbers() == whole.state().numbers()).all()


def test_a_failing_run_throws_with_what_came_before(finger: Path) -> None:
    changes = {"actuators.pull.displacement": {"times": [0, 0.05, 0.1], "values": [0, 0.001, 5]}, "newton": {"limit": 4}}
    with pytest.raises(sinew.StepFailed, match="at t = ") as caught:
        sinew.simulate(finger, changes=changes, progress=False)
    run = caught.value.run
    assert isinstance(run, sinew.Run) and run.end == "numerical_stop" and len(run) > 3
    assert run.failure and run.failure in str(caught.value)
    quiet = sinew.simulate(finger, changes=changes, progress=False, check=False)
    assert quiet.end == "numerical_stop" and np.isfinite(quiet.state().numbers()).all()


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_ctrl_c_stops_a_run_and_keeps_it(finger: Path, tmp_path: Path) -> None:
    code = textwrap.dedent(f"""
        import sinew
        print("begins", flush=True)
        try:
            sinew.simulate({str(finger)!r}, {str(tmp_path / "out")!r}, changes={{"time.duration": "500 s"}}, progress=False)
        except KeyboardInterrupt as stop:
            print(type(stop).__name__, len(stop.run), stop.run.end, flush=True)
    """)
    def heed() -> None:  # jobs in the background are born deaf to it
        signal.signal(signal.SIGINT, signal.SIG_DFL)

    with subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, preexec_fn=heed) as process:
        assert process.stdout is not None and process.stdout.readline() == "begins\n"
        try:
            process.communicate(timeout=2)
        except subprocess.TimeoutExpired:
            process.send_signal(signal.SIGINT)
        told, _ = process.communicate(timeout=60)
    name, steps, end = told.split()
    assert (name, end) == ("Interrupted", "interrupted") and int(steps) > 2
    assert len(sinew.read_run(tmp_path / "out")) == int(steps)


def test_progress_is_told_where_it_is_wanted(finger: Path, capsys: pytest.CaptureFixture[str]) -> None:
    sinew.simulate(finger, changes={"time.duration": "0.1 s"})
    assert capsys.readouterr() == ("", "")  # no terminal here
    sinew.simulate(finger, changes={"time.duration": "0.1 s"}, progress=True)
    told = capsys.readouterr()
    assert told.out == "" and "100%" in told.err


def test_a_workspace(tmp_path: Path) -> None:
    changes = {"analysis": "quasi_static", "newton": "converged"}
    found = sinew.map_workspace(EXAMPLES / "reach.yaml", 20, changes=changes, progress=False)
    assert found.motors == ["pull_right", "pull_back", "pull_left", "pull_front"]
    assert found.points.shape == (20, 3) and found.forces.shape == (20, 4)
    assert found.within.any() and np.isfinite(found.points[found.within]).all()


def test_jacobians_are_what_differences_say() -> None:
    changes = {"analysis": "quasi_static", "newton": "converged"}
    model = sinew.build(EXAMPLES / "reach.yaml", changes)
    state = model.initial_state()
    for _ in range(40):
        assert sinew.step(model, None, state).accepted
    told = sinew.jacobian(model, state, "equilibrium")
    assert told.rows[0] == "tip.x [m]" and told.columns[0] == "pull_right.force [N]"
    direct = {name: "external" for name in model.actuators}
    scene = sinew.Scene.from_file(EXAMPLES / "reach.yaml", changes)
    scene.targets = None
    assert scene.actuators is not None
    for name in direct:
        motor = scene.actuators[name]
        assert isinstance(motor, sinew.Actuator)
        motor.force, motor.limits, motor.preferred = "external", None, None
    free = sinew.build(scene)
    tips = []
    for more in (1e-4, -1e-4):
        force = state.forces.copy()
        force[0] += more
        own = free.initial_state()
        for part in np.linspace(0.1, 1.0, 10):
            assert sinew.step(free, part * force, own).accepted
        tips.append(own.output("tip").copy())
    difference = (tips[0] - tips[1]) / 2e-4
    assert np.linalg.norm(difference - told.effectors[:, 0]) < 1e-4 * np.linalg.norm(difference)
    ellipsoid = sinew.manipulability(told.effectors)
    assert ellipsoid.gains == pytest.approx(np.linalg.svd(told.effectors, compute_uv=False))


def test_compliance_is_symmetric_and_positive(finger: Path) -> None:
    model = sinew.build(finger)
    state = model.initial_state()
    for of in ("step", "equilibrium"):
        W = sinew.compliance(model, state, of)
        assert W.shape == (model.rows, model.rows) and np.abs(W - W.T).max() <= 1e-12 * np.abs(W).max()
        assert np.linalg.eigvalsh(W).min() > -1e-12 * np.abs(W).max() and (np.diag(W)[:21] > 0).all()
    with pytest.raises(ValueError, match="equilibrium"):
        sinew.compliance(model, state, "rest")


def test_targets_are_told_at_every_step() -> None:
    model = sinew.build(EXAMPLES / "reach.yaml")
    assert model.targets == ["tip"]
    state = model.initial_state()
    for k in range(60):
        goal = 0.01 * min(1.0, k / 40)
        report = sinew.step(model, None, state, targets={"tip": [f"{1e3 * goal} mm", 0.0, 0.195]})
        assert report.accepted
    assert report.reached and state.output("tip")[0] == pytest.approx(0.01, abs=1e-4)
    assert (state.forces >= 0).all()


def test_failures_and_interruptions_are_pickled(finger: Path, tmp_path: Path) -> None:
    changes = {"actuators.pull.displacement": {"times": [0, 0.05, 0.1], "values": [0, 0.001, 5]}, "newton": {"limit": 4}}
    with pytest.raises(sinew.StepFailed) as caught:
        sinew.simulate(finger, changes=changes, progress=False)
    again = pickle.loads(pickle.dumps(caught.value))
    assert str(again) == str(caught.value)
    assert again.run.failure == caught.value.run.failure != "rest"
    assert again.run.failure_detail == caught.value.run.failure_detail
    stop = pickle.loads(pickle.dumps(sinew.Interrupted("stopped", again.run)))
    assert isinstance(stop, sinew.Interrupted) and stop.run.end == "numerical_stop"


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
def test_what_a_signal_throws_is_what_arrives(finger: Path) -> None:
    def late(*_: object) -> None:
        raise TimeoutError("late")

    before = signal.signal(signal.SIGALRM, late)
    signal.setitimer(signal.ITIMER_REAL, 0.3)
    try:
        with pytest.raises(TimeoutError, match="late"):
            sinew.simulate(finger, changes={"time.duration": "500 s"}, progress=False)
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, before)


def test_a_loop_of_ones_own_is_recorded(small: Path, tmp_path: Path) -> None:
    model = sinew.build(small)
    state = model.initial_state()
    recorder = sinew.Recorder(state, tmp_path / "out")
    for k in range(5):
        recorder.add(state, sinew.step(model, [0.02 * k], state))
    run = recorder.run()
    assert len(run) == 6 and run.end == "done" and run.status[1:] == ["converged"] * 5
    assert run.signals["draw.force"].tolist() == pytest.approx([0, 0, 0.02, 0.04, 0.06, 0.08])
    assert (run.output("tip")[-1] == state.output("tip")).all() and run.output("tip").shape == (6, 3)
    assert (sinew.read_run(tmp_path / "out").state().numbers() == state.numbers()).all()
    assert (tmp_path / "out" / "signals.csv").exists()
    with pytest.raises(ValueError, match="another model"):
        recorder.add(sinew.build(small, {"gravity": [0, 0, 0]}).initial_state(), sinew.step(model, None, state))


def test_a_state_goes_on_in_a_run_of_the_same_file(small: Path) -> None:
    state = sinew.simulate(small, progress=False).state(5)
    assert len(sinew.simulate(small, state=state, progress=False)) == 6
    assert sinew.build(small) is state.model


def test_commands_are_replayed(tmp_path: Path) -> None:
    file = EXAMPLES / "reach.yaml"
    changes = {"time.duration": "0.2 s"}
    found = sinew.simulate(file, tmp_path / "out", changes=changes, progress=False)
    again = sinew.simulate(file, changes=changes, commands=tmp_path / "out" / "commands.csv", progress=False)
    assert np.abs(again.output("tip") - found.output("tip")).max() < 1e-6
    assert len(again.model.targets) == 0


def test_numbers_of_threads_and_samples_are_judged(small: Path) -> None:
    model = sinew.build(small)
    for call in (
        lambda: sinew.step(model, None, model.initial_state(), threads=0),
        lambda: sinew.simulate(model, threads=-3, progress=False),
        lambda: sinew.map_workspace(model, -3, progress=False),
        lambda: sinew.map_workspace(model, threads=-5, progress=False),
    ):
        with pytest.raises(sinew.InputError, match="must be"):
            call()


@pytest.mark.parametrize("kind", ["file", "scene", "run", "folder"])
def test_what_is_shown_is_served(kind: str, finger: Path, tmp_path: Path, program: str) -> None:
    from urllib.error import HTTPError
    from urllib.request import urlopen

    scene = sinew.Scene.from_file(finger)
    scene.solids["finger"].mesh = sinew.Mesh.bar((0.1, 0.014, 0.014), (10, 2, 2))
    scene.solids["finger"].scale = 1.0
    scene.time = sinew.Time(duration="50 ms")
    if kind in ("run", "folder"):
        run = sinew.simulate(scene, tmp_path / "out", progress=False)
    what = {"file": lambda: finger, "scene": lambda: scene, "run": lambda: run, "folder": lambda: tmp_path / "out"}[kind]()
    with sinew.show(what, browser=False) as page:
        assert "iframe" in page._repr_html_() and page.address in repr(page)
        with urlopen(page.address) as answer:
            assert b"<title>Sinew</title>" in answer.read()
            assert "frame-ancestors http://localhost:* " in answer.headers["Content-Security-Policy"]
        with pytest.raises(HTTPError, match="403"):
            urlopen(page.address[:-1])
    with pytest.raises(OSError):
        urlopen(page.address)


def test_the_notebook_alone_may_frame_it(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    import types

    from sinew.showing import _notebook_origins

    local = ["http://localhost:*", "http://127.0.0.1:*", "vscode-webview:", "vscode-file:"]
    paths = types.SimpleNamespace(jupyter_runtime_dir=lambda: str(tmp_path))
    monkeypatch.setitem(sys.modules, "jupyter_core", types.SimpleNamespace(paths=paths))
    monkeypatch.setitem(sys.modules, "jupyter_core.paths", paths)
    monkeypatch.setenv("JPY_PARENT_PID", "123")
    assert _notebook_origins() == local  # no such server
    for text, origins in (
        ('{"url": "http://localhost:8888/lab"}', ["http://127.0.0.1:8888", "http://localhost:8888"]),
        ('{"url": "https://hub.example/user/x/"}', ["https://127.0.0.1", "https://hub.example", "https://localhost"]),
        ('{"url": "http://a b;c/"}', local),
        ('{"url": 3}', local),
        ("[]", local),
        ("not JSON", local),
    ):
        (tmp_path / "jpserver-123.json").write_text(text)
        assert _notebook_origins() == origins, text


def test_what_cannot_be_shown_is_told(tmp_path: Path, program: str) -> None:
    with pytest.raises(sinew.InputError, match="nowhere"):
        sinew.show(tmp_path / "nowhere.yaml", browser=False)
    with pytest.raises(TypeError, match="not 42"):
        sinew.show(42, browser=False)  # type: ignore[arg-type]


def test_warnings_are_data(tmp_path: Path) -> None:
    """Two opposite tendons that are told opposite lengths: one constraint, and one of them pushes."""
    scene = tmp_path / "two.yaml"
    scene.write_text(
        "time: {step: 10 ms, duration: 100 ms}\n"
        "rods: {arm: {path: [[0,0,0],[0.2,0,0]], section: {circle: {radius: 8 mm}}, material: {young: 1 MPa, poisson: 0.5, "
        "density: 1100, damping: 20 ms}}}\n"
        "actuators:\n"
        "  a: {rod: arm, tendon: {distance: 6 mm}, displacement: {times: [0, 0.1], values: [0, 1 mm]}}\n"
        "  b: {rod: arm, tendon: {distance: 6 mm, angle: 180 deg}, displacement: {times: [0, 0.1], values: [0, -1 mm]}}\n"
    )
    model = sinew.build(scene)
    assert [own.code for own in model.warnings] == ["redundant_constraints"]
    run = sinew.simulate(model)
    assert [own.code for own in run.warnings] == ["redundant_constraints", "tendon_pushes"]
    pushes = run.warnings[1]
    assert (pushes.where, pushes.unit, pushes.steps) == ("actuators.b", "N", 10)
    assert pushes.time == pytest.approx(0.01) and pushes.value > 1.0 > 1e-6 >= pushes.limit
    assert str(pushes).startswith("actuators.b: the tendon pushes with ")
    state = model.initial_state()
    report = sinew.step(model, None, state)
    assert report.judged and [own.code for own in report.warnings] == ["tendon_pushes"]
    assert [own.code for own in pickle.loads(pickle.dumps(run)).warnings] == [own.code for own in run.warnings]
