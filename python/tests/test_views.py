"""Pictures and other libraries' objects."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import meshio
import numpy as np
import pytest

import sinew
from sinew import convert, plot

mpl.use("Agg")


@pytest.fixture(scope="module")
def run() -> sinew.Run:
    from conftest import EXAMPLES

    return sinew.simulate(EXAMPLES / "finger.yaml", changes={"time.duration": "0.3 s"}, progress=False)


def test_pandas(run: sinew.Run) -> None:
    table = convert.to_pandas(run)
    assert len(table) == len(run) and table["tip.z"].iloc[-1] == run.signals["tip.z"][-1]
    assert table.index.name == "time" and set(table["status"]) == {"rest", "converged"}


def test_meshio_there_and_back(run: sinew.Run, tmp_path: Path) -> None:
    mesh = convert.to_meshio(run.state())
    assert set(mesh.cell_sets) == {"finger", "cable"}
    mesh.write(tmp_path / "finger.vtu")
    again = meshio.read(tmp_path / "finger.vtu")
    assert np.allclose(again.points, mesh.points) and len(again.cells_dict["tetra"]) == len(mesh.cells_dict["tetra"])
    tetra = meshio.Mesh(mesh.points[:284], [mesh.cells[0]])
    tetra.write(tmp_path / "copy.inp")
    for given in (tetra, sinew.Mesh.from_meshio(tetra), sinew.Mesh.read(tmp_path / "copy.inp"), tmp_path / "copy.vtu"):
        if given == tmp_path / "copy.vtu":
            tetra.write(given)
        scene = sinew.Scene(
            solids={"copy": sinew.Solid(mesh=given, material=sinew.SolidMaterial(young=1e6, poisson=0.3), density=1000)}
        )
        state = sinew.build(scene).initial_state()
        assert np.allclose(np.sort(state.solids["copy"].x, axis=0), np.sort(mesh.points[:284], axis=0), atol=1e-12)


@pytest.mark.parametrize("kind", ["tetra10", "hexahedron"])
def test_groups_of_meshio_are_groups(kind: str) -> None:
    bar = sinew.Mesh.bar((1.0, 1.0, 1.0), (2, 1, 1))
    mesh = meshio.Mesh(
        bar.points,
        [("hexahedron", bar.cells["hexahedron"])],
        cell_sets={"half": [np.array([0])]},
    )
    own = sinew.Mesh.from_meshio(mesh)
    assert own.groups["half"]["hexahedron"].tolist() == [0] and kind


def test_pictures(run: sinew.Run, tmp_path: Path) -> None:
    lengths, forces = plot.signals(run)
    assert len(lengths.lines) == 4 and "mm" in lengths.get_ylabel() and "N" in forces.get_ylabel()
    assert [len(own.lines) for own in plot.signals(run, ["pull"])] == [1, 1]
    assert len(plot.signals(run, "tip.z")[0].lines) == 1
    assert [len(own.lines) for own in plot.rod(run.state(), "cable")] == [3]
    bending, stress = plot.rod(run.state(), "cable", ["bending_y", "von_mises"])
    assert "1/m" in bending.get_ylabel() and "Pa" in stress.get_ylabel()
    with pytest.raises(ValueError, match="cannot share"):
        plot.signals(run, ["pull"], lengths)
    shape = plot.shape(run.state())
    shape.figure.savefig(tmp_path / "shape.png")
    assert (tmp_path / "shape.png").stat().st_size > 10_000
    with pytest.raises(ValueError, match="known"):
        plot.signals(run, ["tipp"])
    with pytest.raises(ValueError, match="known"):
        plot.rod(run.state(), "cabel")
    with pytest.raises(ValueError, match="known"):
        plot.rod(run.state(), "cable", ["bend"])


def test_section_convergence_falls(tmp_path: Path) -> None:
    from conftest import EXAMPLES

    changes = {"analysis": "static", "actuators.pull.displacement": "5 mm"}
    axes = plot.section_convergence(EXAMPLES / "finger.yaml", "cable", "tip", [3, 6, 12, 24], changes=changes)
    errors = axes.lines[0].get_ydata()
    assert errors[0] > errors[1] > errors[2]


def test_a_workspace_is_drawn() -> None:
    from conftest import EXAMPLES

    changes = {"analysis": "quasi_static", "newton": "converged"}
    found = sinew.map_workspace(EXAMPLES / "reach.yaml", 12, changes=changes, progress=False)
    assert "tip.x" in plot.workspace(found).get_xlabel()
