"""NAFEMS LE10: a thick elliptic plate under pressure."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import numpy as np
import numpy.typing as npt
from validation import Array, Result, across, block, solid_scene, wall

import sinew

result = Result(__file__, "NAFEMS LE10: a thick plate under pressure")
values = result.reference("nafems_le10")


def graded(x: Array, n: int, power: float) -> Array:
    """Ends of n parts of [0, 1], finer towards 0, with straight parts between them."""
    ends = np.linspace(0, 1, n + 1)
    return np.interp(x, ends, ends**power)


def stress(kind: str, nr: int, na: int, nz: int) -> float:
    """sigma_yy [Pa] at D, the inner end of the long axis, on top."""

    def place(x: Array) -> Array:
        r, a = graded(x[:, 0], nr, 2.0), 0.5 * np.pi * graded(x[:, 1], na, 1.5)
        return np.stack([(2 + 1.25 * r) * np.cos(a), (1 + 1.75 * r) * np.sin(a), 0.6 * x[:, 2]], axis=1)

    def rim(x: Array) -> npt.NDArray[np.bool_]:
        return np.asarray(np.abs(np.hypot(x[:, 0] / 3.25, x[:, 1] / 2.75) - 1) < 1e-3)

    mesh = block((nr, na, nz), place, kind, {"rim": rim, "middle": lambda x: rim(x) & (np.abs(x[:, 2] - 0.3) < 1e-6)})
    held = [wall("x"), wall("y"),
            sinew.Held(group="rim", axes=["x", "y"]), sinew.Held(group="middle", axes=["z"])]
    scene = solid_scene(mesh, sinew.SolidMaterial(law="saint_venant_kirchhoff", young="210 GPa", poisson=0.3), held)
    scene.loads["pressure"] = sinew.SolidLoad(solid="solid", plane=across("z", 0.6), pressure="1 MPa")
    scene.outputs["stress"] = sinew.Output(solid="solid", point=[2, 0, 0.6], quantity="stress")
    return float(sinew.simulate(scene, progress=False).state().output("stress")[1])


meshes = [("tet10", 3, 6, 4), ("tet10", 5, 8, 6), ("tet10", 8, 12, 8)]
found = {own: stress(*own) for own in meshes}
result.table(["elements", "boxes: across, around, through", "sigma_yy at D [MPa]"], [[own[0], " x ".join(map(str, own[1:])), f"{1e-6 * s:.3f}"] for own, s in found.items()])
result.compare("10-node tetrahedra, 5 x 8 x 6 boxes: sigma_yy at D", 1e-6 * found[meshes[1]], 1e-6 * values["sigma_yy"], values["tolerance"], "MPa",
               "NAFEMS, The Standard NAFEMS Benchmarks, LE10, 1990")
result.finish()
