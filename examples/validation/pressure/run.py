"""Pressure that follows a bending block."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import Array, Result, block, solid_scene

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


def bent(kind: str, cells: tuple[int, int, int]) -> tuple[Array, Array]:
    mesh = block(cells, lambda x: x * [L, H, H], kind)
    scene = solid_scene(mesh, sinew.SolidMaterial(law="saint_venant_kirchhoff", young=E, poisson=0),
                        [sinew.Held(plane=sinew.Plane(point=[0, 0, 0], normal=[1, 0, 0]))])
    scene.loads["pressure"] = sinew.SolidLoad(solid="solid", plane=sinew.Plane(point=[0, H, 0], normal=[0, 1, 0]), pressure=P)
    for k, s in enumerate(np.linspace(0, L, 21)):
        scene.outputs[f"p{k}"] = sinew.Output(solid="solid", point=[float(s), H / 2, H / 2])
    state = sinew.simulate(scene, progress=False).state()
    points = np.array([state.output(f"p{k}") for k in range(21)]) - [0, H / 2, H / 2]
    return points[:, :2], points[:, 2]


exact = elastica(2000)
figure, axes = plt.subplots(figsize=(5.5, 4), layout="constrained")
axes.plot(1e3 * exact[:, 0], 1e3 * exact[:, 1], "k:", label="elastica")
for kind, cells in {"tet10": (24, 1, 1), "hex8": (320, 2, 2)}.items():
    points, aside = bent(kind, cells)  # type: ignore[arg-type]
    axes.plot(1e3 * points[:, 0], 1e3 * points[:, 1], "o-", ms=3, label=kind)
    result.compare_all(f"{kind}, {' x '.join(map(str, cells))} boxes: the tip, over the length", points[-1], exact[0], 1e-2, "m", "elastica under a load that follows it", of=L)
    result.check(f"{kind}: aside, over the length", float(np.abs(aside).max() / L), most=1e-3)
axes.set(xlabel="x [mm]", ylabel="y [mm]", aspect="equal")
axes.legend()
result.picture(figure, "pressure.png", "The bent block, on the elastica")
result.check("tip off the clamp's axis, over the length: a large bending", float(-exact[0, 1] / L), least=0.3)
result.finish()
