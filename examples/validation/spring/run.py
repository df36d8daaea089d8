"""A coil spring."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import ALL, Result, straight_rod

import sinew

result = Result(__file__, "A coil spring")
R, PITCH, TURNS, WIRE, E, NU = 0.01, 0.002, 10, 5e-4, 80e9, 0.3
ROUND = float(np.hypot(2 * np.pi * R, PITCH))
L = TURNS * ROUND
STIFFNESS = E / (2 + 2 * NU) * np.pi * WIRE**4 / 2 / (2 * np.pi * R**3 * TURNS)
FORCE = 0.05 * R * STIFFNESS
rest = sinew.StrainTable(torsion=2 * np.pi * PITCH / ROUND**2, bending_z=4 * np.pi**2 * R / ROUND**2)
slope = np.arctan(PITCH / (2 * np.pi * R))
scene = straight_rod(L, sinew.Circle(radius=WIRE), 120, ALL, 1, steps=2, rest=rest, up=[-1, 0, 0], path=[[0, 0, 0], [0, L * np.cos(slope), L * np.sin(slope)]],
                     material=sinew.RodMaterial(young=E, poisson=NU, density=0))
for k in range(3):
    scene.outputs[f"turn{k}"] = sinew.Output(rod="rod", at=0.5 * k * ROUND)
start = sinew.build(scene).initial_state()
first, half, once = (start.output(f"turn{k}") for k in range(3))
axis = once / np.linalg.norm(once)  # one turn is a shift along the axis
arm = 0.5 * (first + half) - (0.5 * (first + half) @ axis) * axis
scene.loads["force"] = sinew.RodLoad(rod="rod", force=(FORCE * axis).tolist(), moment=np.cross(arm, FORCE * axis).tolist(), factor=sinew.Table(times=[0, 1], values=[0, 1]))
end = sinew.simulate(scene, progress=False).state()
found = FORCE / float((end.output("tip") - start.output("tip")) @ axis)

figure = plt.figure(figsize=(5, 5), layout="constrained")
axes = figure.add_subplot(projection="3d")
for label, state in {"at rest": start, "pulled": end}.items():
    axes.plot(*(1e3 * state.snapshot().rods[0].points.T), lw=1, label=label)
axes.set(xlabel="x [mm]", ylabel="y [mm]", zlabel="z [mm]", aspect="equal")
axes.legend()
result.picture(figure, "spring.png", "The spring at rest and pulled")
result.check("its rest shape has the radius it was given: off by, over R", abs(float(np.linalg.norm(arm)) / R - 1), most=2e-4)
result.check("one turn rises by the pitch: off by, over the pitch", abs(float(np.linalg.norm(once)) / PITCH - 1), most=1e-6)
result.compare("stiffness along its axis", found, STIFFNESS, 1e-2, "N/m", "Love, Mathematical Theory of Elasticity, 271: G J / (2 pi R^3 n)")
result.finish()
