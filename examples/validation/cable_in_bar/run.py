"""A bar of solid elements bent by a cable that slides in it."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import Array, Result, across, block

import sinew

result = Result(__file__, "A bar bent by a cable that slides in it")
L, H, E, OFF, T, RADIUS = 0.1, 0.01, 1e6, 3e-3, 0.2, 1e-4
AREA, INERTIA = H**2, H**4 / 12
KAPPA, SHORTER = T * OFF / (E * INERTIA), T / (E * AREA)


def pulled(kind: str, cells: tuple[int, int, int], points: int, geometric: bool = False) -> tuple[Array, Array, float]:
    """Where 11 points of the bar's axis, and of a line beside it, are at rest under the pull; what the cable has lost between its inner points."""
    mesh = block(cells, lambda x: (x - [0, 0.5, 0.5]) * [L, H, H], kind)
    where = np.linspace(L / points, L, points)
    cable = sinew.Rod(path=[[0, 0, OFF], [L, 0, OFF]], cable="geometric" if geometric else None, sections=None if geometric else points,
                      section=None if geometric else sinew.Circle(radius=RADIUS),
                      material=None if geometric else sinew.RodMaterial(young=1e8, poisson=0.3, density=0))
    scene = sinew.Scene(
        analysis="quasi_static", time=sinew.Time(step=0.25, duration=1),
        solids={"bar": sinew.Solid(mesh=mesh, density=1000, material=sinew.SolidMaterial(law="saint_venant_kirchhoff", young=E, poisson=0),
                                   fixed=sinew.Held(plane=across("x")))},
        rods={"cable": cable}, couplings=[sinew.Slide(rod="cable", solid="bar", points=where.tolist(), anchor_tip="position")],
        actuators={"pull": sinew.Actuator(rod="cable", force=sinew.Table(times=[0, 1], values=[0, T]))},
    )
    for k, s in enumerate(np.linspace(0, L, 11)):
        scene.outputs[f"axis{k}"] = sinew.Output(solid="bar", point=[float(s), 0, 0])
        scene.outputs[f"beside{k}"] = sinew.Output(solid="bar", point=[float(s), 0, OFF])
    state = sinew.simulate(scene, progress=False).state()
    s, (a, b) = state.abscissae, np.searchsorted(where, [0.2 * L, 0.8 * L])
    return np.array([state.output(f"axis{k}") for k in range(11)]), np.array([state.output(f"beside{k}") for k in range(11)]), 1 - float((s[b] - s[a]) / (where[b] - where[a]))


def bending(axis: Array, beside: Array) -> tuple[float, float]:
    """Mean curvature and shortening between a fifth and four fifths of the length, away from what holds and pulls."""
    a, b = beside[2] - axis[2], beside[8] - axis[8]
    angle = float(np.arctan2(a[0], a[2]) - np.arctan2(b[0], b[2]))
    chord = float(np.linalg.norm(axis[8] - axis[2]))
    arc = chord * (angle / 2) / np.sin(angle / 2)
    return abs(angle) / (0.6 * L), 1 - arc / (0.6 * L)


rows = []
figure, axes = plt.subplots(figsize=(6, 3.5), layout="constrained")
s = np.linspace(0, L, 50)
axes.plot(1e3 * np.sin(KAPPA * s) / KAPPA * (1 - SHORTER), 1e3 * (1 - np.cos(KAPPA * s)) / KAPPA * (1 - SHORTER), "k:", label="closed form")
for name, kind, cells, points, geometric in [
    ("10-node tetrahedra, cable as a rod", "tet10", (20, 2, 2), 20, False),
    ("hexahedra, cable as a rod", "hex8", (60, 6, 6), 20, False),
    ("10-node tetrahedra, geometric cable", "tet10", (20, 2, 2), 20, True),
    ("10-node tetrahedra, points off the mesh's planes", "tet10", (14, 2, 2), 23, False),
]:
    axis, beside, lost = pulled(kind, cells, points, geometric)
    kappa, shorter = bending(axis, beside)
    rows.append([name, f"{kappa:.4f}", f"{1e3 * shorter:.4f}", "" if geometric else f"{1e3 * lost:.4f}"])
    axes.plot(1e3 * axis[:, 0], 1e3 * axis[:, 2], "oxs+"[len(rows) - 1], ms=5, mfc="none", label=name)
    result.compare(f"{name}: curvature", kappa, KAPPA, 1e-2, "1/m", "beam theory: T r / (E I)")
    result.compare(f"{name}: shortening", shorter, SHORTER, 3e-2, source="beam theory: T / (E A)")
    if not geometric:  # which has no abscissae of its own
        result.compare(f"{name}: cable drawn out between points", lost, SHORTER + KAPPA * OFF, 3e-2, source="beam theory: T / (E A) + T r^2 / (E I)")
rows.append(["closed form", f"{KAPPA:.4f}", f"{1e3 * SHORTER:.4f}", f"{1e3 * (SHORTER + KAPPA * OFF):.4f}"])
result.table(["", "curvature [1/m]", "shortening [1e-3]", "cable drawn out between points [1e-3]"], rows)
axes.set(xlabel="x [mm]", ylabel="z [mm], not to scale")
axes.legend()
result.picture(figure, "cable_in_bar.png", "The bar's axis, bent by its cable, on the closed form")
result.finish()
