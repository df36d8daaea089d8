"""What becomes of energy."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import ALL, BENDING, Result, Strains, path_length, stiffness, straight_rod

import sinew

result = Result(__file__, "What becomes of energy")
L, R, AMPLITUDE = 0.5, 0.005, 0.01


def released(step: float, viscosity: float = 0.0, strains: Strains | None = None, gravity: list[float] | None = None) -> sinew.Run:
    """A rod that is straight at rest is let go from the shape of its first mode."""
    x = 1.87510407 * np.linspace(0, 1, 41)
    y = np.cosh(x) - np.cos(x) - 0.73409551 * (np.sinh(x) - np.sin(x))
    bent = np.stack([L * np.linspace(0, 1, 41), AMPLITUDE * y, 0 * x], axis=1)
    scene = straight_rod(path_length(bent), sinew.Circle(radius=R), 8, strains or BENDING, path=bent.tolist(), rest="straight", start="path",
                         material=sinew.RodMaterial(young=10e6, poisson=0.45, density=1000, viscosity=viscosity))
    scene.analysis, scene.time, scene.gravity = "dynamic", sinew.Time(step=step, duration=0.4), gravity or [0, 0, 0]
    return sinew.simulate(scene, progress=False)


figure, axes = plt.subplots(figsize=(6, 3.5), layout="constrained")
steps, lost, swung = [2e-3, 1e-3, 5e-4], [], 0.0
for step in steps:
    run = released(step)
    total = run.signals["energy.kinetic"] + run.signals["energy.elastic"]
    lost.append(float(1 - total[-1] / total[0]))
    swung = float(run.signals["energy.kinetic"].max() / total[0])
    axes.plot(run.time, total / total[0], label=f"{1e3 * step:g} ms")
axes.set(xlabel="time [s]", ylabel="energy, over its first")
axes.legend(title="step, no damping")
result.picture(figure, "energy.png", "Energy of a swinging rod over time for three steps")
result.table(["step [ms]", "energy lost in 0.4 s [%]"], [[f"{1e3 * s:g}", f"{100 * own:.2f}"] for s, own in zip(steps, lost, strict=True)])
result.check("undamped: energy becomes motion, kinetic over total, largest", swung, least=0.5)
result.check("undamped: what a longer step takes more falls with the step to the power", float(np.log2((lost[0] - lost[1]) / (lost[1] - lost[2]))), 0.85, 1.15)
for viscosity in (0.0, 3e3, 1e5):
    run = released(2e-3, viscosity, ALL, [1.0, -9.81, 2.0])
    total = run.signals["energy.kinetic"] + run.signals["energy.elastic"] + run.signals["energy.weight"]
    result.check(f"viscosity {viscosity:g} Pa s, all strains, gravity: most energy that any step gains, over the first", float(np.diff(total).max() / abs(total[0])), most=1e-9)

# At rest, under a growing force: its work is what is stored.
EI, F = 2.0, 0.01
scene = straight_rod(1.0, stiffness(1, EI, EI, 1e6, 1e6, 1e6), 40, steps=200)
scene.loads["force"] = sinew.RodLoad(rod="rod", force=[0, F, 0], factor=sinew.Table(times=[0, 1], values=[0, 1]))
run = sinew.simulate(scene, progress=False)
result.compare("cantilever under a force: stored energy", float(run.signals["energy.elastic"][-1]), F**2 / (6 * EI), 1e-3, "J", "closed form: F^2 L^3 / (6 E I)")
result.compare("the force's work, in 200 steps", float(run.signals["energy.work"][-1]), F**2 / (6 * EI), 1e-2, "J", "closed form: F^2 L^3 / (6 E I)")
result.finish()
