"""A rod pulled by one parallel tendon."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import EXTENSIBLE, Result, Strains, stiffness, straight_rod

import sinew

result = Result(__file__, "A rod pulled by a parallel tendon")
values = result.reference("single_tendon_rod")
L, EI, r, T = 0.4, 0.02, 6e-3, 4.0
kappa = T * r / EI


def pulled(sections: int, angle: float, strains: Strains | None = None, **drive: float) -> sinew.State:
    scene = straight_rod(L, stiffness(0.015, EI, EI, 800, 1, 1), sections, strains, steps=4)
    (what, value), = drive.items()
    scene.actuators["tendon"] = sinew.Actuator(rod="rod", tendon=sinew.Tendon(distance=r, angle=angle),
                                               **{what: sinew.Table(times=[0, 1], values=[0, value])})  # type: ignore[arg-type]
    for k, s in enumerate([0.05, 0.2, 0.39]):
        scene.outputs[f"strain{k}"] = sinew.Output(rod="rod", at=s, quantity="strain")
    return sinew.simulate(scene, progress=False).state()


bent, tips, drawn = [], [], []
figure, axes = plt.subplots(figsize=(6, 3), layout="constrained")
for sections in (1, 7):
    for angle in (0.0, 0.6, np.pi / 2, 2.5):
        state = pulled(sections, angle, tension=T)
        towards = np.array([0, np.cos(angle), np.sin(angle)])
        for k in range(3):
            strain = state.output(f"strain{k}")
            bent.append(strain[2] * np.cos(angle) - strain[1] * np.sin(angle))
        tips.append([state.output("tip")[0], state.output("tip") @ towards])
        drawn.append(pulled(sections, angle, displacement=r * kappa * L).forces[0])
        if sections == 7:
            points = state.snapshot().rods[0].points
            axes.plot(points[:, 0], points @ towards, label=f"{angle:.2g} rad")
axes.set(xlabel="x [m]", ylabel="towards the tendon [m]")
axes.legend(title="tendon at")
result.picture(figure, "tendon.png", "The bent rod, seen in the plane of its tendon: the same for every angle")

source = "Camarillo et al., IEEE Trans. Robotics 24, 2008: T r / (E I)"
exact = [np.sin(kappa * L) / kappa, (1 - np.cos(kappa * L)) / kappa]
tolerance = values["tolerance"]
result.compare_all("1 and 7 sections, four directions: curvature at three places", bent, [kappa] * len(bent), tolerance, "1/m", source)
result.compare_all("position of the tip", tips, [exact] * len(tips), tolerance, "m", source)
result.compare_all("drawn in by r kappa L: its tension", drawn, [T] * len(drawn), tolerance, "N", source)
state = pulled(7, 0.0, EXTENSIBLE, tension=T)
result.compare("a rod that can be shortened: elongation", float(state.output("strain1")[3]), -T / 800, 1e-6, source="closed form: - T / (E A)")
result.finish()
