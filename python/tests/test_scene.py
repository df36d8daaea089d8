"""Scenes made in Python are what the same file would be."""

from __future__ import annotations

import copy
import pickle
import subprocess
import sys
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import EXAMPLES, ROOT
from hypothesis import given, settings
from hypothesis import strategies as st

import sinew
from sinew import _engine
from sinew.parts import Part

EXAMPLE_FILES = sorted(EXAMPLES.glob("*.yaml"))


def test_the_classes_are_those_of_the_schema() -> None:
    made = subprocess.run(
        [sys.executable, ROOT / "python" / "make_scene.py"],
        input=_engine.scene_schema(),
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    assert made == Path(sinew.scene.__file__).read_text(), "run python/make_scene.py again"


@pytest.mark.parametrize("file", EXAMPLE_FILES, ids=lambda file: file.stem)
def test_a_scene_of_a_file_builds_the_same_model(file: Path) -> None:
    scene = sinew.Scene.from_file(file)
    one, other = sinew.build(scene), sinew.build(file)
    assert one.unknowns == other.unknowns and one.rows == other.rows and one.signals == other.signals
    a, b = one.initial_state(), other.initial_state()
    assert (a.numbers() == b.numbers()).all()
    assert sinew.step(one, None, a).status == sinew.step(other, None, b).status
    assert (a.numbers() == b.numbers()).all()


@pytest.mark.parametrize("file", EXAMPLE_FILES, ids=lambda file: file.stem)
def test_trees_and_parts_are_the_same(file: Path) -> None:
    tree = _engine.read_tree(str(file), [])
    scene = sinew.Scene.from_tree(tree)
    assert scene.tree() == tree
    assert copy.deepcopy(scene) == scene
    assert pickle.loads(pickle.dumps(scene)) == scene
    again = _engine.read_tree(str(file), [])
    assert again == tree

    def parts(value: Any) -> None:
        """No dict is left where there is a class for it."""
        if isinstance(value, Part):
            for own in fields(value):  # type: ignore[arg-type]
                parts(getattr(value, own.name))
        elif isinstance(value, dict):
            for own in value.values():
                assert not (isinstance(own, dict) and "material" in own)
                parts(own)
        elif isinstance(value, list):
            for own in value:
                parts(own)

    parts(scene)


def test_yaml_of_a_scene_runs(tmp_path: Path) -> None:
    scene = sinew.Scene.from_file(EXAMPLES / "tendon_arm.yaml")
    file = tmp_path / "again.yaml"
    file.write_text(scene.to_yaml())
    assert (sinew.build(file).initial_state().numbers() == sinew.build(scene).initial_state().numbers()).all()


def test_errors_are_those_of_the_command_line(tmp_path: Path, program: str) -> None:
    text = (EXAMPLES / "tendon_arm.yaml").read_text()
    file = tmp_path / "bad.yaml"
    for old, new in [("sections", "sectons"), ("MPa", "mPa"), ("time:", "tyme:"), ("poisson: 0.", "poisson: 1.")]:
        assert old in text
        file.write_text(text.replace(old, new, 1))
        with pytest.raises(sinew.InputError) as caught:
            sinew.build(file)
        told = subprocess.run([program, "check", file], capture_output=True, text=True, check=False)
        assert told.returncode == 2
        assert str(caught.value).strip() in told.stderr
        assert caught.value.file == str(file) and caught.value.line > 0


def test_faults_of_scenes_in_python_name_the_field() -> None:
    scene = sinew.Scene.from_file(EXAMPLES / "finger.yaml")
    assert scene.solids is not None
    solid = scene.solids["finger"]
    assert isinstance(solid, sinew.Solid) and isinstance(solid.material, sinew.SolidMaterial)
    solid.material.young = "-5 kPa"
    with pytest.raises(sinew.InputError) as caught:
        sinew.build(scene)
    error = caught.value
    assert (error.file, error.line, error.path, error.value) == ("", 0, "solids.finger.material.young", "-5 kPa")
    assert str(error).startswith("solids.finger.material.young = -5 kPa: must be greater than 0 Pa")
    solid.material.young = float("nan")
    with pytest.raises(sinew.InputError, match="young"):
        scene.check()
    assert pickle.loads(pickle.dumps(error)).rule == error.rule


def test_unknown_keywords_are_refused() -> None:
    with pytest.raises(TypeError, match="sectons"):
        sinew.Rod(path=[[0, 0, 0], [1, 0, 0]], sectons=3)  # type: ignore[call-arg]
    with pytest.raises(sinew.InputError, match="did you mean `time`"):
        sinew.Scene.from_tree({"tyme": {}})


def test_numpy_values_are_taken() -> None:
    rod = sinew.Rod(
        path=np.array([[0.0, 0, 0], [0.1, 0, 0]]),
        sections=np.int64(3),  # type: ignore[arg-type]
        section=sinew.Circle(radius=np.float64(0.001)),
        material=sinew.RodMaterial(young=np.float32(1e6), poisson=0.4, density=np.int64(1000)),  # type: ignore[arg-type]
    )
    model = sinew.build(sinew.Scene(rods={"arm": rod}))
    assert model.rods == ["arm"]


def test_changes_are_made_by_places() -> None:
    one = sinew.build(EXAMPLES / "finger.yaml", {"rods.cable.sections": 30, "title": "a: 'b' \"c\""})
    assert one.title == "a: 'b' \"c\""
    other = sinew.build(EXAMPLES / "finger.yaml", ["rods.cable.sections=30"])
    assert one.unknowns == other.unknowns > sinew.build(EXAMPLES / "finger.yaml").unknowns
    with pytest.raises(ValueError, match="changes"):
        sinew.build(one, {"title": "x"})


number = st.one_of(st.floats(allow_nan=True, allow_infinity=True), st.integers(-(10**12), 10**12))
quantity = st.one_of(number, st.text(max_size=12), st.sampled_from(["1 mm", "5 kPa", "-1 m", "2 furlongs", "", "1e400 m"]))
anything = st.recursive(
    st.one_of(st.none(), st.booleans(), quantity, st.text(max_size=8)),
    lambda inner: st.one_of(st.lists(inner, max_size=4), st.dictionaries(st.text(max_size=8), inner, max_size=4)),
    max_leaves=12,
)


@settings(deadline=None, max_examples=200)
@given(radius=quantity, young=quantity, sections=number, point=st.lists(quantity, max_size=4), extra=anything)
def test_any_values_are_built_or_refused(radius: Any, young: Any, sections: Any, point: list[Any], extra: Any) -> None:
    scene = sinew.Scene(
        rods={
            "arm": sinew.Rod(
                path=[[0, 0, 0], point],
                sections=sections if not isinstance(sections, int) else sections % 50,
                section=sinew.Circle(radius=radius),
                material=sinew.RodMaterial(young=young),
                pose=extra,
            )
        }
    )
    try:
        state = sinew.build(scene).initial_state()
    except sinew.InputError as error:
        assert error.path and error.rule
        return
    assert np.isfinite(state.numbers()).all()


@settings(deadline=None, max_examples=200)
@given(tree=st.dictionaries(st.sampled_from(["rods", "solids", "time", "outputs", "couplings", "x"]), anything, max_size=4))
def test_any_tree_is_built_or_refused(tree: dict[str, Any]) -> None:
    try:
        sinew.build(tree)
    except (sinew.InputError, TypeError) as error:
        assert str(error)


def test_meshes_of_arrays(tmp_path: Path) -> None:
    mesh = sinew.Mesh.bar((0.1, 0.02, 0.03), (5, 2, 3), taper=0.5)
    assert len(mesh.points) == 6 * 3 * 4
    scene = sinew.Scene(
        time=sinew.Time(step="10 ms", duration="20 ms"),
        gravity=[0, 0, -9.81],
        solids={
            "bar": sinew.Solid(
                mesh=mesh,
                material=sinew.SolidMaterial(young="1 MPa", poisson=0.3),
                density=1000,
                fixed=sinew.Held(group="start"),
            )
        },
        outputs={"end": sinew.Output(solid="bar", quantity="reaction", region=sinew.Region(group="start"))},
    )
    run = sinew.simulate(scene, tmp_path / "out", progress=False)
    assert run.state().solids["bar"].x.shape == mesh.points.shape
    del mesh, scene
    again = sinew.read_run(tmp_path / "out")
    assert (again.state().numbers() == run.state().numbers()).all()
    # Momentum: weight and reaction together accelerate it. Frustum: A0 (1 + t + t^2) / 3 times the length.
    weight = 1000 * 0.02 * 0.03 * (1 + 0.5 + 0.25) / 3 * 0.1 * 9.81
    statics = sinew.build(scene_of_bar(), {"analysis": "static", "newton": "converged"})
    state = statics.initial_state()
    while state.grid < statics.steps:
        assert sinew.step(statics, None, state).accepted
    assert state.output("end") == pytest.approx([0, 0, weight], rel=2e-2, abs=1e-6)


def scene_of_bar() -> sinew.Scene:
    return sinew.Scene(
        gravity=[0, 0, -9.81],
        solids={
            "bar": sinew.Solid(
                mesh=sinew.Mesh.bar((0.1, 0.02, 0.03), (5, 2, 3), taper=0.5),
                material=sinew.SolidMaterial(young="1 MPa", poisson=0.3),
                density=1000,
                fixed=sinew.Held(group="start"),
            )
        },
        outputs={"end": sinew.Output(solid="bar", quantity="reaction", region=sinew.Region(group="start"))},
    )


ANOTHER_PROCESS = """
import pickle, sys, sinew
model, state, run = pickle.load(open(sys.argv[1], "rb"))
again = sinew.read_run(sys.argv[2])
assert state.model is model and run.model is model
assert (state.numbers() == run.state().numbers()).all() and (again.state().numbers() == state.numbers()).all()
assert run.signals.keys() == again.signals.keys()
assert sinew.step(model, None, state).accepted
print(float(state.numbers().sum()).hex())
"""


def test_meshes_of_arrays_go_to_other_processes_and_stay_with_results(tmp_path: Path) -> None:
    scene = scene_of_bar()
    scene.time = sinew.Time(step="10 ms", duration="20 ms")
    model = sinew.build(scene)
    run = sinew.simulate(model, progress=False)
    run.save(tmp_path / "saved")
    sinew.simulate(model, tmp_path / "whole", progress=False)
    assert (tmp_path / "saved" / "run.sinew").read_bytes() == (tmp_path / "whole" / "run.sinew").read_bytes()
    # What is done to the scene afterwards is no part of the model.
    scene.solids["bar"].material = sinew.SolidMaterial(young="9 MPa", poisson=0.3)
    scene.outputs["more"] = sinew.Output(solid="bar", point=[0.1, 0, 0])
    state = run.state()
    (tmp_path / "all.pickle").write_bytes(pickle.dumps((model, state, run)))
    sinew.step(model, None, state)
    told = subprocess.run(
        [sys.executable, "-c", ANOTHER_PROCESS, tmp_path / "all.pickle", tmp_path / "saved"],
        check=True, capture_output=True, text=True, cwd=tmp_path,
    )
    assert told.stdout.strip() == float(state.numbers().sum()).hex()


def test_a_scene_with_meshes_of_arrays_is_saved_as_a_file(tmp_path: Path, program: str) -> None:
    scene = scene_of_bar()
    scene.save(tmp_path / "bar.yaml")
    subprocess.run([program, "check", tmp_path / "bar.yaml"], check=True, capture_output=True)
    assert sinew.build(tmp_path / "bar.yaml").unknowns == sinew.build(scene).unknowns


def test_meshes_are_values() -> None:
    mesh = sinew.Mesh.bar((0.1, 0.02, 0.03), (5, 2, 3))
    with pytest.raises(ValueError, match="read-only"):
        mesh.points *= 2
    assert mesh == sinew.Mesh.bar((0.1, 0.02, 0.03), (5, 2, 3)) != sinew.Mesh.bar((0.2, 0.02, 0.03), (5, 2, 3))
    assert pickle.loads(pickle.dumps(mesh)) == mesh


def test_names_stay_what_they_are(tmp_path: Path) -> None:
    file = tmp_path / "names.yaml"
    file.write_text(
        "title: \"007\"\nrods:\n  arm: {path: [[0, 0, 0], [0.10, 0, 0]], sections: 123456789012345678901, "
        "section: {circle: {radius: 5 mm}}, material: {young: 1e6, poisson: 0.4, density: 1100.0}}\n"
    )
    scene = sinew.Scene.from_file(file, {"rods.arm.sections": 4})
    arm = scene.rods["arm"]
    assert scene.title == "007" and arm.sections == 4 and arm.path == [[0, 0, 0], ["0.10", 0, 0]]
    with pytest.raises(sinew.InputError, match="123456789012345678901"):
        sinew.Scene.from_file(file)
    assert sinew.build(scene).title == "007"


def test_misspelt_attributes_are_refused() -> None:
    scene = scene_of_bar()
    with pytest.raises(AttributeError, match="did you mean `gravity`"):
        scene.gravityy = [0, 0, 0]  # type: ignore[attr-defined]
    with pytest.raises(AttributeError):
        sinew.build(scene).tmie = 3  # type: ignore[attr-defined]


@pytest.mark.parametrize("scene", [None, 3, b"x", [1]])
def test_what_is_no_scene_is_refused(scene: Any) -> None:
    with pytest.raises(TypeError, match="a scene is"):
        sinew.build(scene)


def test_odd_text_and_endless_scenes_are_refused() -> None:
    with pytest.raises(ValueError, match="surrogates"):
        sinew.build({"title": "\ud800"})
    endless: dict[str, Any] = {}
    endless["solids"] = endless
    with pytest.raises((sinew.InputError, RecursionError)):
        sinew.build(endless)


def test_meshes_of_arrays_are_checked() -> None:
    points = np.zeros((4, 3))
    with pytest.raises(ValueError, match="shape"):
        sinew.Mesh(np.zeros(4), {})
    with pytest.raises(ValueError, match="wedge"):
        sinew.Mesh(points, {"wedge": np.zeros((1, 6), dtype=int)})
    with pytest.raises(ValueError, match="node 4 does not exist"):
        sinew.Mesh(points, {"tetra": [[0, 1, 2, 4]]})
    with pytest.raises(ValueError, match="whole numbers"):
        sinew.Mesh(points, {"tetra": [[0.0, 1, 2, 3]]})
    with pytest.raises(ValueError, match="no such cells"):
        sinew.Mesh(points, {"tetra": [[0, 1, 2, 3]]}, {"base": {"tetra": [1]}})
    with pytest.raises(ValueError, match="numbers of cells"):
        sinew.Mesh(points, {"tetra": [[0, 1, 2, 3]]}, {"base": {"tetra": [0.9]}})
    with pytest.raises(ValueError, match="shape"):
        sinew.Mesh(points, {"tetra": [[0, 1, 2, 3, 0]]})
    with pytest.raises(ValueError, match="finite"):
        sinew.Mesh(np.full((4, 3), np.nan), {})
    with pytest.raises(ValueError, match="name"):
        sinew.Mesh(points, {"tetra": [[0, 1, 2, 3]]}, {"a\nb": {"tetra": [0]}})
    masked = sinew.Mesh(points, {"tetra": [[0, 1, 2, 3], [3, 2, 1, 0]]}, {"base": {"tetra": [False, True]}})
    assert masked.groups["base"]["tetra"].tolist() == [1]
