"""What nothing holds: it falls, spins and keeps its momenta."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import Array, Result, straight_rod

import sinew

result = Result(__file__, "Free flight")
G = 9.81

# A rigid box spins about no axis of its own, thrown upwards.
SIZE, MASS = np.array([0.1, 0.05, 0.02]), 0.3
INERTIA = MASS / 12 * (np.sum(SIZE**2) - SIZE**2)


def thrown(step: float) -> tuple[Array, Array, Array, Array]:
    """Times, places, angular momenta in the world and kinetic energies of the spin."""
    body = sinew.RigidBody(box=sinew.BoxShape(size=SIZE.tolist()), mass=MASS, velocity=[0.5, 0, 3], spin=[3, 8, 1])
    scene = sinew.Scene(time=sinew.Time(step=step, duration=0.6), gravity=[0, 0, -G], bodies={"box": body})
    run = sinew.simulate(scene, progress=False)
    states = [run.state(k).bodies["box"] for k in range(len(run.time))]
    spin = np.array([own.rotation @ (INERTIA * own.spin) for own in states])
    return run.time, np.array([own.position for own in states]), spin, np.array([0.5 * own.spin @ (INERTIA * own.spin) for own in states])


steps = [4e-3, 2e-3, 1e-3]
drifts, energies = [], []
figure, axes = plt.subplots(figsize=(6, 3.5), layout="constrained")
for step in steps:
    times, places, spin, energy = thrown(step)
    exact = np.outer(times, [0.5, 0, 3]) + np.outer(0.5 * times * (times + step), [0, 0, -G])  # backward Euler's sum
    result.check(f"box, step of {1e3 * step:g} ms: off the parabola of that step", float(np.abs(places - exact).max()), most=1e-9, unit="m")
    drifts.append(float(np.linalg.norm(spin[-1] - spin[0]) / np.linalg.norm(spin[0])))
    energies.append(float(energy[-1] / energy[0] - 1))
    axes.plot(times, energy / energy[0], label=f"{1e3 * step:g} ms")
axes.set(xlabel="time [s]", ylabel="energy of the spin, over its first")
axes.legend(title="step")
result.picture(figure, "free_flight.png", "The energy of the spin over time")
result.table(["step [ms]", "angular momentum drifts by", "energy of the spin changes by"], [[f"{1e3 * s:g}", f"{d:.2e}", f"{e:.2e}"] for s, d, e in zip(steps, drifts, energies, strict=True)])
result.check("box, step of 1 ms: drift of the angular momentum", drifts[2], most=0.02)
result.check("drift falls with the step to the power", float(np.log2(drifts[1] / drifts[2])), least=0.8)

# A rod that nothing holds is pushed and turned at its end for 0.1 s.
L, R, PUSH, STEP = 0.3, 3e-3, np.array([0.1, -0.05, 0.15]), 2e-3
scene = straight_rod(L, sinew.Circle(radius=R), 6, base="free", material=sinew.RodMaterial(young=5e7, poisson=0.4, density=1200))
scene.analysis, scene.time, scene.gravity = "dynamic", sinew.Time(step=STEP, duration=0.4), [0, 0, -G]
scene.loads["push"] = sinew.RodLoad(rod="rod", force=PUSH.tolist(), factor=sinew.Table(times=[0, 0.05, 0.1], values=[0, 1, 0]))
run = sinew.simulate(scene, progress=False)
mass = 1200 * np.pi * R**2 * L
height = run.signals["energy.weight"] / (mass * G)  # of its centre
speed = np.diff(height) / STEP
given = np.cumsum(STEP * (PUSH[2] * np.interp(run.time[1:], [0, 0.05, 0.1], [0, 1, 0]) - mass * G))
total = (run.signals["energy.kinetic"] + run.signals["energy.elastic"] + run.signals["energy.weight"])[run.time > 0.1 + 1e-9]
bent = float(run.signals["energy.elastic"].max() / run.signals["energy.kinetic"].max())
result.check("soft rod pushed at its end: momentum along z off the impulse, over the largest", float(np.abs(mass * speed - given).max() / np.abs(given).max()), most=1e-6)
result.check("while it bends: elastic energy over kinetic, largest", bent, least=1e-3)
result.check("after the push: most energy that any step gains, over what it has", float(np.diff(total).max() / np.abs(total[0])), most=1e-9)
result.finish()
