"""An arc of 45 degrees bent out of its plane."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import ALL, RAMP, Array, Result, path_length, straight_rod

import sinew

result = Result(__file__, "The 45 degree bend")
values = result.reference("bend_45")
angles = np.linspace(0.0, np.pi / 4, 201)
ARC = np.stack([100 * np.sin(angles), 100 * (1 - np.cos(angles)), 0 * angles], axis=1)
LENGTH = path_length(ARC)


def bent(force: float, sections: int, order: int = 0) -> tuple[Array, Array]:
    """The tip, and points along the rod."""
    scene = straight_rod(LENGTH, sinew.Rectangle(y=1, z=1), sections, ALL, order, steps=6, path=ARC.tolist(),
                         material=sinew.RodMaterial(young=1e7, poisson=0, density=0))
    scene.loads["force"] = sinew.RodLoad(rod="rod", force=[0, 0, force], factor=RAMP)
    state = sinew.simulate(scene, progress=False).state()
    return state.output("tip"), state.snapshot().rods[0].points


ours = {row["force"]: bent(row["force"], 32) for row in values["rows"]}
result.table(
    ["force", "Simo and Vu-Quoc, 8 elements", "another code, 8 elements", "Sinew, 32 sections"],
    [[row["force"], row["tip"], row["second"], [round(float(x), 2) for x in ours[row["force"]][0]]] for row in values["rows"]],
)
figure = plt.figure(figsize=(6, 4.5), layout="constrained")
axes = figure.add_subplot(projection="3d")
for force, (_, points) in {0: (ARC[-1], ARC), **ours}.items():
    axes.plot(*points.T, label=str(force))
axes.scatter(*np.array([row["tip"] for row in values["rows"]]).T, color="black", label="published tip")
axes.set(xlabel="x", ylabel="y", zlabel="z", aspect="equal")
axes.legend(title="force")
result.picture(figure, "bend_45.png", "The arc at rest and under two forces")

for row in values["rows"]:
    result.compare_all(f"force {row['force']}: tip x, y, z", ours[row["force"]][0], row["tip"], values["tolerance"], source="Simo and Vu-Quoc 1986, 8 elements")
fine = bent(300, 4, 2)[0]
result.check("32 sections of constant strain beside 4 of quadratic, over the radius", float(np.linalg.norm(ours[300][0] - fine)) / 100, most=2e-4)
result.check("2 sections of cubic strain beside 4 of quadratic, over the radius", float(np.linalg.norm(bent(300, 2, 3)[0] - fine)) / 100, most=1e-5)
result.finish()
