"""The Princeton beam: a turned rectangular cantilever under a dead weight."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import ALL, RAMP, Array, Result, shoot, stiffness, straight_rod

import sinew

result = Result(__file__, "The Princeton beam")
values = result.reference("princeton_beam")
of = values["parameters"]
L, E, G = of["L"], of["E"], of["E"] / (2 + 2 * of["nu"])
A, I_y, I_z = of["h"] * of["w"], of["h"] * of["w"] ** 3 / 12, of["w"] * of["h"] ** 3 / 12


def moved(beta: float, section: object, sections: int, order: int) -> Array:
    scene = straight_rod(L, section, sections, ALL, order, steps=4)
    if isinstance(section, sinew.Rectangle):
        scene.rods["rod"].material = sinew.RodMaterial(young=E, poisson=of["nu"], density=0)
    scene.loads["weight"] = sinew.RodLoad(rod="rod", force=weight(beta).tolist(), factor=RAMP)
    return sinew.simulate(scene, progress=False).state().output("tip")


def weight(beta: float) -> Array:
    return np.asarray(of["F"] * np.array([0.0, np.cos(np.radians(beta)), np.sin(np.radians(beta))]))


angles = values["beta_deg"]
published = np.array([values["y"], values["z"]]).T
rectangle = sinew.Rectangle(y=of["h"], z=of["w"])
ours = np.array([moved(beta, rectangle, 40, 0) for beta in angles])[:, 1:]
linear = np.array([moved(beta, rectangle, 4, 1) for beta in angles])[:, 1:]
six = np.array([G * of["torsion_factor_on_Iy_plus_Iz"] * (I_y + I_z), E * I_y, E * I_z, E * A, 5 / 6 * G * A, 5 / 6 * G * A])
quoted = np.array([moved(beta, stiffness(*six), 4, 2) for beta in angles])
shot = np.array([shoot(L, weight(beta), six, True) for beta in angles])
result.table(
    ["turned [deg]", "y, published [mm]", "y, Sinew", "z, published [mm]", "z, Sinew", "y with the quoted torsion", "y by shooting"],
    [[b, f"{1e3 * p[0]:.3f}", f"{1e3 * o[0]:.3f}", f"{1e3 * p[1]:.3f}", f"{1e3 * o[1]:.3f}", f"{1e3 * q[1]:.5f}", f"{1e3 * s[1]:.5f}"]
     for b, p, o, q, s in zip(angles, published, ours, quoted, shot, strict=True)],
)
figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
for i, name in enumerate("yz"):
    axes.plot(angles, 1e3 * ours[:, i], label=f"{name}, Sinew")
    axes.plot(angles, 1e3 * published[:, i], "o", color="black", label="published" if i else None)
axes.set(xlabel="turned [deg]", ylabel="the tip moves [mm]")
axes.legend()
result.picture(figure, "princeton_beam.png", "How far the tip moves against the angle, on the published points")

there = published > 0  # a vanishing one has no relative deviation
tolerance, source = values["tolerance"], values["source"]
result.compare_all("40 sections of constant strain: y and z at all angles", ours[there], published[there], tolerance, "m", source)
result.compare_all("4 sections of linear strain: y and z at all angles", linear[there], published[there], tolerance, "m", source)
result.compare_all("what vanishes, over the length", ours[~there], published[~there], 1e-9, "m", "symmetry", of=L)
result.compare_all("with the quoted torsion factor: beside shooting, over the length", quoted, shot, 1e-8, "m", "Runge and Kutta's method with shooting, in validation.py", of=L)
result.finish()
