"""A cube stretched and compressed along one axis: every law of solids against its own formula."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from collections.abc import Callable

import matplotlib.pyplot as plt
import numpy as np
from validation import Array, Result, across, block

import sinew

result = Result(__file__, "A cube that is stretched: the laws of solids")
E, NU = 1e6, 0.45
MU, LAMBDA = E / (2 + 2 * NU), E * NU / ((1 + NU) * (1 - 2 * NU))
C10, C01, TERMS = 1.2e5, 0.5e5, [(6.3e5, 1.3), (1.2e3, 5.0), (-1e4, -2.0)]
BULK = 2e6


def corotational(l: Array) -> float:
    return float(MU * np.sum((l - 1) ** 2) + LAMBDA / 2 * np.sum(l - 1) ** 2)


def saint_venant_kirchhoff(l: Array) -> float:
    strain = 0.5 * (l**2 - 1)
    return float(MU * np.sum(strain**2) + LAMBDA / 2 * np.sum(strain) ** 2)


def neo_hookean(l: Array) -> float:
    """Smith, de Goes, Kim 2018, (14)."""
    square, J, mu = np.sum(l**2), np.prod(l), 4 / 3 * MU
    return float(mu / 2 * (square - 3 - np.log((square + 1) / 4)) - 0.75 * mu * (J - 1) + (LAMBDA + 5 / 6 * MU) / 2 * (J - 1) ** 2)


def mooney_rivlin(l: Array) -> float:
    J, I1, I2 = np.prod(l), np.sum(l**2), np.sum(np.prod(l) ** 2 / l**2)
    return float(C10 * (J ** (-2 / 3) * I1 - 3) + C01 * (J ** (-4 / 3) * I2 - 3) + BULK / 2 * (J - 1) ** 2)


def ogden(l: Array) -> float:
    J = np.prod(l)
    return float(sum(mu / alpha * (np.sum((J ** (-1 / 3) * l) ** alpha) - 3) for mu, alpha in TERMS) + BULK / 2 * (J - 1) ** 2)


def exact(energy: Callable[[Array], float], along: float) -> tuple[float, float]:
    """Nominal stress along the pull and the stretch across it, where the sides carry nothing."""
    h = 1e-5
    side = 1.0
    for _ in range(100):
        def slope(x: float) -> float:
            return (energy(np.array([along, x + h, x + h])) - energy(np.array([along, x - h, x - h]))) / (2 * h)

        change = slope(side) * 2 * h / (slope(side + h) - slope(side - h))
        side -= float(np.clip(change, -0.1, 0.1))
        if abs(change) < 1e-9:
            break
    return (energy(np.array([along + h, side, side])) - energy(np.array([along - h, side, side]))) / (2 * h), side


def pulled(kind: str, material: sinew.SolidMaterial, along: float) -> tuple[list[float], list[float], list[float]]:
    """Stretches along, nominal stresses and stretches across of a unit cube, in steps up to `along`."""
    # Along y and z all but the far end: no node may be held by two frames.
    held = [sinew.Held(box=[[-0.1, -0.1, -0.1], [0.9 * (a != "x"), 1 - (a == "y"), 1 - (a == "z")]], axes=[a]) for a in "xyz"]  # type: ignore[list-item]
    far = across("x", 1)
    solid = sinew.Solid(mesh=block((2, 2, 2), lambda x: x, kind), material=material, density=1000,
                        fixed=[*held, sinew.Held(plane=far, axes=["x"], frame="grip")])
    scene = sinew.Scene(
        analysis="quasi_static", time=sinew.Time(step=0.05, duration=1), solids={"cube": solid},
        frames={"grip": sinew.Frame(motion=sinew.FrameMotion(times=[0, 1], translate=[[0, 0, 0], [along - 1, 0, 0]]))},
        outputs={"pull": sinew.Output(solid="cube", quantity="reaction", region=sinew.Region(plane=far)), "corner": sinew.Output(solid="cube", point=[1, 1, 1])},
    )
    run = sinew.simulate(scene, progress=False)
    return run.signals["corner.x"][1:].tolist(), run.signals["pull.x"][1:].tolist(), run.signals["corner.y"][1:].tolist()


laws: dict[str, tuple[Callable[[Array], float], sinew.SolidMaterial]] = {
    "corotational": (corotational, sinew.SolidMaterial(law="corotational", young=E, poisson=NU)),
    "saint_venant_kirchhoff": (saint_venant_kirchhoff, sinew.SolidMaterial(law="saint_venant_kirchhoff", young=E, poisson=NU)),
    "neo_hookean": (neo_hookean, sinew.SolidMaterial(law="neo_hookean", young=E, poisson=NU)),
    "mooney_rivlin": (mooney_rivlin, sinew.SolidMaterial(law="mooney_rivlin", c10=C10, c01=C01, bulk=BULK)),
    "ogden": (ogden, sinew.SolidMaterial(law="ogden", mu=[mu for mu, _ in TERMS], alpha=[alpha for _, alpha in TERMS], bulk=BULK)),
}
figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
for number, (name, (energy, material)) in enumerate(laws.items()):
    ends = [0.8, 1.5] if name in ("corotational", "saint_venant_kirchhoff") else [0.5, 2.5]
    stresses: list[float] = []
    sides: list[float] = []
    right: list[tuple[float, float]] = []
    for kind in ("hex8", "tet10"):
        for end in ends:
            along, stress, side = pulled(kind, material, end)
            right += [exact(energy, x) for x in along]
            stresses += stress
            sides += side
            axes.plot(along[::3], 1e-3 * np.array(stress[::3]), f"oC{number}", ms=4)
    fine = np.linspace(ends[0], ends[1], 60)
    axes.plot(fine, [1e-3 * exact(energy, x)[0] for x in fine], f"C{number}", label=name)
    result.compare_all(f"{name}, stretched by {ends[0]} to {ends[1]}, hex8 and tet10: nominal stress", stresses, [own[0] for own in right], 1e-5, "Pa", "the law's energy, differentiated")
    result.compare_all(f"{name}: stretch across", sides, [own[1] for own in right], 1e-6, source="the law's energy, sides free of stress")
axes.set(xlabel="stretch", ylabel="nominal stress [kPa]", ylim=(-1600, 1100))
axes.legend()
result.picture(figure, "stretch.png", "Nominal stress against stretch, five laws: lines are formulas, points are Sinew")
result.finish()
