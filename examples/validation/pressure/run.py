"""Pressure that follows a bending block."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import Array, Result, across, block, solid_scene

import sinew

result = Result(__file__, "A block bent by pressure that follows it")
L, H, E, P = 0.2, 0.005, 1e6, 10.0
EI, Q = E * H**4 / 12, P * H


def elastica(steps: int) -> Array:
    """Points from the root, in its axes, under a load Q per length that stays across the rod (Runge and Kutta, from the tip)."""

    def slope(own: Array) -> Array:
        N, V, kappa, angle = own[:4]
        return np.array([kappa * V, Q - kappa * N, V / EI, kappa, np.cos(angle), np.sin(angle)])

    own, h, points = np.zeros(6), L / steps, [np.zeros(2)]
    for _ in range(steps):
        a = slope(own)
        b = slope(own + h / 2 * a)
        c = slope(own + h / 2 * b)
        own = own + h / 6 * (a + 2 * b + 2 * c + slope(own + h * c))
        points.append(own[4:])
    turned = np.array([[np.cos(own[3]), np.sin(own[3])], [-np.sin(own[3]), np.cos(own[3])]])
    return np.asarray((own[4:] - np.array(points)) @ turned.T)


def bent(along: int) -> tuple[Array, Array]:
    """Where 21 points of the axis go, in the plane of bending and across it."""
    mesh = block((along, 1, 1), lambda x: x * [L, H, H], "tet10")
    scene = solid_scene(mesh, sinew.SolidMaterial(law="saint_venant_kirchhoff", young=E, poisson=0),
                        [sinew.Held(plane=across("x"))])
    scene.loads["pressure"] = sinew.SolidLoad(solid="solid", plane=across("y", H), pressure=P)
    for k, s in enumerate(np.linspace(0, L, 21)):
        scene.outputs[f"p{k}"] = sinew.Output(solid="solid", point=[float(s), H / 2, H / 2])
    state = sinew.simulate(scene, progress=False).state()
    points = np.array([state.output(f"p{k}") for k in range(21)]) - [0, H / 2, H / 2]
    return points[:, :2], points[:, 2]


exact = elastica(2000)
figure, axes = plt.subplots(figsize=(5.5, 4), layout="constrained")
axes.plot(1e3 * exact[:, 0], 1e3 * exact[:, 1], "k:", label="elastica")
rows = []
for along in (12, 24, 36):
    points, aside = bent(along)
    rows.append([along, *[f"{1e3 * x:.3f}" for x in points[-1]], f"{1e3 * np.abs(aside).max():.3f}"])
    axes.plot(1e3 * points[:, 0], 1e3 * points[:, 1], "o", ms=4, label=f"{along} x 1 x 1 boxes")
    if along == 12:
        continue  # a coarse mesh, shown in the table alone
    result.compare_all(f"{along} x 1 x 1 boxes of 10-node tetrahedra: the tip", points[-1], exact[0], 1e-2, "m", "elastica under a load that follows it; over the length", of=L)
    result.check(f"{along} x 1 x 1 boxes: aside, over the length", float(np.abs(aside).max() / L), most=1e-3)
rows.append(["elastica", *[f"{1e3 * x:.3f}" for x in exact[0]], "0"])
result.table(["boxes along", "tip x [mm]", "tip y [mm]", "aside, most [mm]"], rows)
axes.set(xlabel="x [mm]", ylabel="y [mm]", aspect="equal")
axes.legend()
result.picture(figure, "pressure.png", "The bent block, on the elastica")
result.check("tip off the clamp's axis, over the length: a large bending", float(-exact[0, 1] / L), least=0.3)
result.finish()
