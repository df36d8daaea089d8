"""A clamped rod and a slender block under a dead force across their tip: the elastica."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import RAMP, Array, Result, across, block, solid_scene, stiffness, straight_rod

import sinew

result = Result(__file__, "The elastica: a large bending by a force at the tip")
values = result.reference("elastica_tip_force")
L, EI = 2.0, 3.0


def exact(alpha: float) -> Array:
    """w / L, u / L and the tip's angle by elliptic integrals (Bisshopp and Drucker 1945), with Gauss's rule."""
    nodes, weights = np.polynomial.legendre.leggauss(60)
    low, high = 1e-9, 0.5 * np.pi - 1e-9
    while high - low > 1e-15:
        angle = 0.5 * (low + high)
        k2 = 0.5 * (1.0 + np.sin(angle))
        first = np.arcsin(np.sqrt(0.5 / k2))
        phi = first + (0.5 * np.pi - first) * 0.5 * (nodes + 1.0)
        scale = 0.5 * (0.5 * np.pi - first)
        root = np.sqrt(1.0 - k2 * np.sin(phi) ** 2)
        if scale * weights @ (1.0 / root) < np.sqrt(alpha):
            low = angle
        else:
            high = angle
        if high - low < 1e-14:
            break
    return np.array([1.0 - 2.0 * scale * (weights @ root) / np.sqrt(alpha), 1.0 - np.sqrt(2.0 * np.sin(angle) / alpha), angle])


def rod(alpha: float, sections: int, order: int) -> tuple[Array, Array]:
    """The same by Sinew, and the points of the rod."""
    scene = straight_rod(L, stiffness(0.7, EI, EI, 1, 1, 1), sections, order=order, steps=2)
    scene.loads["force"] = sinew.RodLoad(rod="rod", force=[0, alpha * EI / L**2, 0], factor=RAMP)
    scene.outputs["turn"] = sinew.Output(rod="rod", at=L, quantity="orientation")
    state = sinew.simulate(scene, progress=False).state()
    tip = state.output("tip")
    return np.array([tip[1] / L, 1.0 - tip[0] / L, state.output("turn")[2]]), state.snapshot().rods[0].points / L


def slender_block(alpha: float) -> Array:
    """w / L and u / L of a bar of 1 m x 10 mm x 10 mm, 60 x 1 x 1 boxes of six 10-node tetrahedra."""
    h, E = 0.01, 1e9
    mesh = block((60, 1, 1), lambda x: x * [1.0, h, h], "tet10")
    scene = solid_scene(mesh, sinew.SolidMaterial(law="saint_venant_kirchhoff", young=E, poisson=0),
                        [sinew.Held(plane=across("x"))])
    scene.loads["force"] = sinew.SolidLoad(solid="solid", plane=across("x", 1), force=[0, alpha * E * h**4 / 12, 0])
    scene.outputs["tip"] = sinew.Output(solid="solid", point=[1, 0.5 * h, 0.5 * h], quantity="displacement")
    x, y, _ = sinew.simulate(scene, progress=False).state().output("tip")
    return np.array([y, -x])


published = np.array(values["rows"])
closed = np.array([exact(alpha) for alpha in published[:, 0]])
fine = [rod(alpha, 160, 0) for alpha in published[:, 0]]
cubic = [rod(alpha, 1, 3) for alpha in published[:, 0]]
solid = np.array([slender_block(alpha) for alpha in published[:, 0]])
names = ["w / L", "u / L", "angle of the tip"]
result.table(
    ["F L^2 / (E I)", "of the tip", "published", "elliptic integrals", "160 sections, constant strain", "1 section, cubic strain", "block of tet10"],
    [
        [f"{row[0]:g}", names[i], f"{row[1 + i]:.5f}", f"{closed[k, i]:.7f}", f"{fine[k][0][i]:.7f}", f"{cubic[k][0][i]:.7f}",
         f"{solid[k, i]:.5f}" if i < 2 else ""]
        for k, row in enumerate(published)
        for i in range(3)
    ],
)
figure, axes = plt.subplots(figsize=(6, 4.5), layout="constrained")
for row, (_, points) in zip(published, fine, strict=True):
    axes.plot(points[:, 0], points[:, 1], label=f"{row[0]:g}")
axes.plot(1.0 - published[:, 2], published[:, 1], "o", color="black", label="published tip")
axes.set(xlabel="x / L", ylabel="y / L", aspect="equal")
axes.legend(title="F L^2 / (E I)")
result.picture(figure, "elastica.png", "The rod under three forces, its tip on the published points")

tolerance, source = values["tolerance"], values["source"]
result.compare_all("160 sections of constant strain: w, u, angle", [own for own, _ in fine], published[:, 1:], tolerance, source=source)
result.compare_all("1 section of cubic strain: w, u, angle", [own for own, _ in cubic], published[:, 1:], tolerance, source=source)
result.compare_all("2 sections of cubic strain", rod(5.0, 2, 3)[0], closed[2], 1e-5, source="elliptic integrals")
result.compare_all("the integrals themselves", closed, published[:, 1:], tolerance, source=source)
result.compare_all("a slender block of 10-node tetrahedra: w, u", solid, published[:, 1:3], 1e-2, source=source)
result.finish()
