"""A ball that bounces, and what falls on what."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import Result

import sinew

result = Result(__file__, "A ball that bounces")
G, HEIGHT, R, E = 9.81, 0.5, 0.02, 0.7


def dropped(step: float, restitution: float) -> sinew.Run:
    body = sinew.RigidBody(sphere=sinew.SphereShape(radius=R), mass=0.05, pose=sinew.Pose(translate=[0, 0, R + HEIGHT]))
    scene = sinew.Scene(time=sinew.Time(step=step, duration=1.7), gravity=[0, 0, -G], bodies={"ball": body},
                        obstacles={"floor": sinew.Obstacle(plane=sinew.PlaneShape(normal=[0, 0, 1]))},
                        contact=sinew.Contact(friction=0, restitution=restitution), outputs={"ball": sinew.Output(body="ball")})
    return sinew.simulate(scene, progress=False)


steps = [2e-3, 1e-3, 5e-4]
fall = np.sqrt(2 * HEIGHT / G)
figure, axes = plt.subplots(figsize=(6, 3.5), layout="constrained")
rows, tops = [], []
for step in steps:
    run = dropped(step, E)
    z = run.signals["ball.z"] - R
    first, second = (z[(run.time > a * fall) & (run.time < b * fall)].max() for a, b in [(1.2, 2.3), (2.5, 3.3)])
    tops.append([first, second])
    rows.append([f"{1e3 * step:g}", f"{first:.5f}", f"{second:.5f}"])
    energy = run.signals["energy.kinetic"] + run.signals["energy.weight"]
    result.check(f"step of {1e3 * step:g} ms: most energy that any step gains, over the first", float(np.diff(energy).max() / (0.05 * G * HEIGHT)), most=1e-12)
    axes.plot(run.time, z, label=f"{1e3 * step:g} ms")
axes.axhline(E**2 * HEIGHT, color="black", ls=":")
axes.axhline(E**4 * HEIGHT, color="black", ls=":", label="e^2 h, e^4 h")
axes.set(xlabel="time [s]", ylabel="height [m]")
axes.legend()
rows.append(["exact", f"{E**2 * HEIGHT:.5f}", f"{E**4 * HEIGHT:.5f}"])
result.table(["step [ms]", "top after the first hit [m]", "after the second [m]"], rows)
result.picture(figure, "bounce.png", "Height over time for three steps")
exact = np.array([E**2 * HEIGHT, E**4 * HEIGHT])
result.compare_all("step of 0.5 ms: tops", tops[2], exact, 0.02, "m", "Newton's law of restitution: e^2 h, e^4 h")
off = np.abs(np.array(tops) - exact).max(axis=1)
result.check("a quarter of the step: error of the tops falls to", float(off[2] / off[0]), most=0.5)
still = dropped(1e-3, 0.0)
rest = still.signals["ball.z"][still.time > 1.1 * fall] - R
result.check("without restitution it stays down: highest point after the hit", float(rest.max()), most=1e-9, unit="m")
result.finish()
