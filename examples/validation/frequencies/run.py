"""Natural frequencies of rods and bars."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import Array, Result, Strains, across, block, wall

import sinew

result = Result(__file__, "Natural frequencies")
L, R, E, RHO = 1.0, 2e-3, 2e9, 1200.0
EI, LINE = E * np.pi * R**4 / 4, RHO * np.pi * R**2


def rod(sections: int, order: int, strains: Strains, **more: object) -> sinew.Scene:
    own = sinew.Rod(path=[[0, 0, 0], [L, 0, 0]], sections=sections, strains=strains, order=order, section=sinew.Circle(radius=R),
                    material=sinew.RodMaterial(young=E, poisson=0.3, density=RHO), **more)  # type: ignore[arg-type]
    return sinew.Scene(analysis="modal", modes=3, rods={"rod": own}, outputs={"tip": sinew.Output(rod="rod", at=L)})


def modes(scene: sinew.Scene) -> Array:
    """[Hz], the lowest first."""
    return sinew.simulate(scene, progress=False).signals["mode.frequency"][1:]


# cos x cosh x = -1
roots = np.array([1.875, 4.694, 7.855])
for _ in range(20):
    f, d = np.cos(roots) * np.cosh(roots) + 1, np.cos(roots) * np.sinh(roots) - np.sin(roots) * np.cosh(roots)
    roots = roots - f / d
bending = roots**2 * np.sqrt(EI / LINE) / (2 * np.pi * L**2)
odd = np.array([1, 3, 5])
wave = np.sqrt(E / RHO), np.sqrt(E / 2.6 / RHO)
rows = []
for sections, order in [(24, 0), (2, 3)]:
    own = modes(rod(sections, order, ["bending_z"]))
    rows.append([f"bending, {sections} sections of order {order}", *[f"{f:.4f}" for f in own]])
    result.compare_all(f"cantilever, {sections} sections of order {order}: bending", own, bending, 1e-2, "Hz", "Euler and Bernoulli: cos x cosh x = -1")
rows.append(["Euler and Bernoulli", *[f"{f:.4f}" for f in bending]])
strained: list[tuple[str, Strains, float]] = [("elongation", ["elongation"], wave[0]), ("torsion", ["torsion"], wave[1])]
for strain, strains, speed in strained:
    own = modes(rod(6, 2, strains))
    result.compare_all(f"cantilever, 6 sections of order 2: {strain}", own, odd * speed / (4 * L), 1e-2, "Hz", "waves of a bar: odd multiples of c / (4 L)")
    rows += [[strain, *[f"{f:.2f}" for f in own]], ["waves", *[f"{f:.2f}" for f in odd * speed / (4 * L)]]]
result.table(["cantilever of 1 m", "mode 1 [Hz]", "mode 2", "mode 3"], rows)

# A taut string with bending stiffness, on pins.
ratios, n = [0.0, 1.0, 10.0, 100.0, 1000.0], np.array([1, 2, 3])
found, right = [], []
for ratio in ratios:
    scene = rod(40, 0, ["bending_z"], base=["turn_z"], up=[0, 0, 1])
    scene.couplings.append(sinew.Tie(rod="rod", along=["z"]))
    scene.loads["pull"] = sinew.RodLoad(rod="rod", force=[ratio * np.pi**2 * EI / L**2, 0, 0])
    found.append(modes(scene))
    right.append(n**2 * np.pi / (2 * L**2) * np.sqrt(EI / LINE) * np.sqrt(1 + ratio / n**2))
result.compare_all("taut rod on pins, T L^2 / (pi^2 E I) from 0 to 1000", found, right, 1e-2, "Hz", "Euler and Bernoulli with tension")

# A bar of the volume's elements, along which alone it may move.
mesh = block((24, 1, 1), lambda x: x * [1.0, 0.05, 0.05], "hex8")
solid = sinew.Solid(mesh=mesh, material=sinew.SolidMaterial(law="corotational", young=E, poisson=0), density=RHO,
                    fixed=[sinew.Held(plane=across("x")), wall("y"), wall("y", 0.05), wall("z"), wall("z", 0.05)])
own = modes(sinew.Scene(analysis="modal", modes=3, solids={"bar": solid}))
result.compare_all("bar of 24 hexahedra: along it", own, odd * wave[0] / (4 * L), 1e-2, "Hz", "waves of a bar: odd multiples of c / (4 L)")

figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
axes.loglog([max(r, 0.1) for r in ratios], found, "o", color="black")
fine = np.geomspace(0.1, 1000, 100)
for k in n:
    axes.loglog(fine, k**2 * np.pi / (2 * L**2) * np.sqrt(EI / LINE) * np.sqrt(1 + fine / k**2), label=f"mode {k}")
axes.set(xlabel="T L^2 / (pi^2 E I); the left points are without tension", ylabel="frequency [Hz]")
axes.legend()
result.picture(figure, "frequencies.png", "Frequencies of a taut rod against its tension")
result.finish()
