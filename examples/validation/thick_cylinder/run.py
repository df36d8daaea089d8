"""A thick-walled cylinder under pressure from inside: displacements, stresses, and how fast errors fall."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import Array, Result, block, solid_scene, wall

import sinew

result = Result(__file__, "A thick-walled cylinder under pressure")
A, B, YOUNG, P = 1.0, 2.0, 1e6, 0.1


def exact(nu: float, r: Array) -> Array:
    """Lamé's radial displacement in plane strain."""
    return (1 + nu) / YOUNG * P * A**2 / (B**2 - A**2) * ((1 - 2 * nu) * r + B**2 / r)


def solved(kind: str, n: int, nu: float) -> tuple[float, float]:
    """Root mean square error of the displacement at all nodes over the mean displacement, and the hoop stress half way."""

    def place(x: Array) -> Array:
        r, angle = A + (B - A) * x[:, 0], 0.5 * np.pi * x[:, 1]
        return np.stack([r * np.cos(angle), r * np.sin(angle), x[:, 2] / n], axis=1)

    mesh = block((n, n, 1), place, kind, {"inside": lambda x: np.hypot(x[:, 0], x[:, 1]) < A + 1e-9})
    scene = solid_scene(mesh, sinew.SolidMaterial(law="neo_hookean", young=YOUNG, poisson=nu),
                        [wall("x"), wall("y"), wall("z"), wall("z", 1 / n)])
    scene.loads["pressure"] = sinew.SolidLoad(solid="solid", group="inside", pressure=P)
    middle = np.array([1.5 * np.cos(0.7), 1.5 * np.sin(0.7), 0.5 / n])
    scene.outputs["stress"] = sinew.Output(solid="solid", point=middle.tolist(), quantity="stress")
    state = sinew.simulate(scene, progress=False).state()
    rest = state.snapshot().solids[0].rest
    radius = np.hypot(rest[:, 0], rest[:, 1])
    off = state.solids["solid"].x - rest - rest * [1, 1, 0] * (exact(nu, radius) / radius)[:, None]
    xx, yy, _, _, _, xy = state.output("stress")[:6]
    across = np.array([-np.sin(0.7), np.cos(0.7)])
    return float(np.sqrt((off**2).sum() / (exact(nu, radius) ** 2).sum())), float(across @ [[xx, xy], [xy, yy]] @ across)


cells = {"tet4": [4, 8, 16], "hex8": [4, 8, 16, 32], "tet10": [2, 4, 8]}
expected = {("tet4", 0.3): 2, ("hex8", 0.3): 2, ("tet10", 0.3): 3, ("hex8", 0.4999): 2, ("tet10", 0.4999): 2}
rows, orders, last = [], {}, {}
figure, axes = plt.subplots(figsize=(5.5, 4), layout="constrained")
for (kind, nu), order in expected.items():
    found = {n: solved(kind, n, nu) for n in cells[kind]}
    errors = [own[0] for own in found.values()]
    orders[kind, nu], last[kind, nu] = np.log2(errors[-2] / errors[-1]), found[cells[kind][-1]]
    rows.append([kind, nu, ", ".join(map(str, cells[kind])), ", ".join(f"{e:.1e}" for e in errors), f"{orders[kind, nu]:.2f}", order])
    axes.loglog(cells[kind], errors, "o-", label=f"{kind}, {nu}")
result.table(["elements", "Poisson's ratio", "cells a side", "errors of displacement", "order, last two", "promised"], rows)
axes.set(xlabel="cells a side", ylabel="error of displacement")
axes.set_xscale("log", base=2)
axes.legend()
result.picture(figure, "thick_cylinder.png", "Errors against cells a side")

hoop = P * A**2 / (B**2 - A**2) * (1 + B**2 / 1.5**2)
for kind, nu in [("tet10", 0.3), ("hex8", 0.3), ("tet10", 0.4999), ("hex8", 0.4999)]:
    result.check(f"{kind}, Poisson's ratio {nu}, finest mesh: error of displacement", last[kind, nu][0], most=1e-2)
for kind, nu in [("tet10", 0.3), ("hex8", 0.3)]:
    result.compare(f"{kind}, Poisson's ratio {nu}: hoop stress half way", last[kind, nu][1], hoop, 2e-2, "Pa", "Lamé: closed form")
for (kind, nu), order in expected.items():
    result.check(f"{kind}, Poisson's ratio {nu}: order of displacement", orders[kind, nu], least=order - 0.2)
result.finish()
