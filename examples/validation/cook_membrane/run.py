"""Cook's membrane."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import Result, across, block, solid_scene, wall

import sinew

result = Result(__file__, "Cook's membrane")
values = result.reference("cook_membrane")
LOAD = 1e-4  # so little that all is linear


def lifted(kind: str, n: int) -> float:
    mesh = block((n, n, 1), lambda x: np.stack([48 * x[:, 0], 44 * x[:, 0] + x[:, 1] * (44 - 28 * x[:, 0]), x[:, 2]], axis=1), kind)
    scene = solid_scene(mesh, sinew.SolidMaterial(law="saint_venant_kirchhoff", young=1, poisson=1 / 3),
                        [sinew.Held(plane=across("x"), axes=["x", "y"]), wall("z")])
    scene.loads["shear"] = sinew.SolidLoad(solid="solid", plane=across("x", 48), force=[0, LOAD, 0])
    scene.outputs["corner"] = sinew.Output(solid="solid", point=[48, 52, 0.5], quantity="displacement")
    return float(sinew.simulate(scene, progress=False).state().output("corner")[1]) / LOAD


cells = [4, 8, 12, 20, 40]
found = {kind: {n: lifted(kind, n) for n in cells if kind == "hex8" or n <= 20} for kind in ("tet4", "tet10", "hex8")}
result.table(["cells a side", *found], [[n, *[f"{found[kind][n]:.3f}" if n in found[kind] else "" for kind in found]] for n in cells])
figure, axes = plt.subplots(figsize=(5, 3.5), layout="constrained")
for kind, own in found.items():
    axes.plot(list(own), list(own.values()), "o-", label=kind)
axes.axhline(values["u_y"], color="black", ls=":", label="published")
axes.set(xlabel="cells a side", ylabel="displacement")
axes.legend()
result.picture(figure, "cook_membrane.png", "Displacement against cells a side, for three kinds of elements")
for kind, n in [("tet10", 12), ("hex8", 40)]:
    result.compare(f"{kind}, {n} x {n}: displacement of (48, 52)", found[kind][n], values["u_y"], values["tolerance"], source="Cook 1974; " + values["source"])
result.finish()
