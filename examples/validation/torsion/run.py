"""Saint-Venant's torsion of rods and bars."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import Result, across, block, straight_rod

import sinew

result = Result(__file__, "Torsion of rods and bars")
YOUNG, NU, L = 1e6, 0.3, 1.0
G = YOUNG / (2 + 2 * NU)


def rectangle(a: float, b: float) -> float:
    """Saint-Venant's torsion constant by his series; a >= b."""
    odd = np.arange(1, 101, 2)
    return float(a * b**3 / 3 * (1 - 192 / np.pi**5 * b / a * np.sum(np.tanh(odd * np.pi * a / (2 * b)) / odd**5)))


def rod(section: object) -> float:
    """The torsion constant that a rod shows: torque over G times its twist per length."""
    torque = 1e-9
    scene = straight_rod(L, section, 2, ["torsion"], material=sinew.RodMaterial(young=YOUNG, poisson=NU, density=0))
    scene.loads["torque"] = sinew.RodLoad(rod="rod", moment=[torque, 0, 0])
    scene.outputs["turn"] = sinew.Output(rod="rod", at=L, quantity="orientation")
    return torque * L / (G * float(sinew.simulate(scene, progress=False).state().output("turn")[0]))


def bar(kind: str, n: int, a: float, b: float) -> float:
    """The same of a bar of solid elements between ends that turn as a whole across and are free along it."""
    length, angle = 4 * a, 1e-3
    mesh = block((4, round(n * a / b), n), lambda x: (x - [0, 0.5, 0.5]) * [length, a, b], kind)
    ends = [sinew.Held(plane=across("x", x), axes=["y", "z"], frame=frame) for x, frame in [(0.0, "still"), (length, "hand")]]
    edge = sinew.Held(nodes=[int(np.argmin(np.linalg.norm(mesh.points - [length / 2, 0, 0], axis=1)))], axes=["x"])
    solid = sinew.Solid(mesh=mesh, density=1000, fixed=[*ends, edge],
                        material=sinew.SolidMaterial(law="saint_venant_kirchhoff", young=YOUNG, poisson=NU))
    turn = sinew.FrameMotion(times=[0, 1], rotate=[[0, 0, 0], [angle, 0, 0]])
    scene = sinew.Scene(analysis="quasi_static", time=sinew.Time(step=1, duration=1), solids={"bar": solid},
                        frames={"still": sinew.Frame(), "hand": sinew.Frame(motion=turn)})
    state = sinew.simulate(scene, progress=False).state()
    return 2 * state.energies.elastic * length / (G * angle**2)


r, o, i, y, z = 2e-3, 5e-3, 4e-3, 4e-3, 2e-3
sections: list[tuple[str, object, float]] = [
    ("circle", sinew.Circle(radius=r), np.pi / 2 * r**4),
    ("tube", sinew.Tube(outer=o, inner=i), np.pi / 2 * (o**4 - i**4)),
    ("ellipse", sinew.Ellipse(y=y, z=z), np.pi * y**3 * z**3 / (y**2 + z**2)),
    *[(f"rectangle {ratio:g} : 1", sinew.Rectangle(y=ratio * r, z=r), rectangle(ratio * r, r)) for ratio in (1, 2, 5, 20)],
]
rows = []
for name, section, exact in sections:
    own = rod(section)
    rows.append([f"rod, {name}", f"{own:.6e}", f"{exact:.6e}", f"{100 * (own / exact - 1):+.4f} %"])
    result.compare(f"rod, {name}: torsion constant", own, exact, 1e-4, "m4", "Saint-Venant: closed form or his series")
found: dict[str, list[float]] = {"hex8": [], "tet10": []}
cells = {"hex8": [4, 8, 16], "tet10": [2, 4, 8]}
a, b = 0.02, 0.01
exact_bar = rectangle(a, b)
for kind, finer in found.items():
    for n in cells[kind]:
        finer.append(bar(kind, n, a, b))
        rows.append([f"bar of {kind}, {2 * n} x {n} cells across", f"{finer[-1]:.6e}", f"{exact_bar:.6e}", f"{100 * (finer[-1] / exact_bar - 1):+.3f} %"])
    result.compare(f"bar 2 : 1 of {kind}, finest: torsion constant", finer[-1], exact_bar, 1e-2, "m4", "Saint-Venant's series")
result.table(["", "torsion constant [m4]", "Saint-Venant", "off"], rows)
figure, axes = plt.subplots(figsize=(5, 3.5), layout="constrained")
for kind, finer in found.items():
    axes.loglog(cells[kind], np.abs(np.array(finer) / exact_bar - 1), "o-", label=kind)
axes.set(xlabel="cells through the height", ylabel="error of the torsion constant")
axes.set_xscale("log", base=2)
axes.legend()
result.picture(figure, "torsion.png", "Error of the bar's torsion constant against cells")
result.finish()
