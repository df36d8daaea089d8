"""Blocks on slopes: they stick, slide or tip."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import Result

import sinew

result = Result(__file__, "A block on a slope")
values = result.reference("block_on_slope")
G, STEP, ALPHA = 9.81, 0.005, np.radians(25)
MASS = 0.1


def on_slope(angle: float, friction: float, size: list[float], duration: float) -> sinew.Run:
    """The slope is the plane z = 0; gravity leans."""
    body = sinew.RigidBody(box=sinew.BoxShape(size=size), mass=MASS, pose=sinew.Pose(translate=[0, 0, size[2] / 2]))
    scene = sinew.Scene(time=sinew.Time(step=STEP, duration=duration), gravity=[G * np.sin(angle), 0, -G * np.cos(angle)], bodies={"block": body},
                        obstacles={"floor": sinew.Obstacle(plane=sinew.PlaneShape(normal=[0, 0, 1]))}, contact=sinew.Contact(friction=friction))
    return sinew.simulate(scene, progress=False)


frictions = [0.0, 0.1, 0.2, 0.3, 0.4, 0.98 * np.tan(ALPHA), 1.02 * np.tan(ALPHA), 0.6]
found, right, lift = [], [], []
for mu in frictions:
    run = on_slope(ALPHA, mu, [0.05, 0.05, 0.05], 0.5)
    end = run.state()
    found.append(end.bodies["block"].velocity[0] / end.time)
    right.append(max(0.0, G * (np.sin(ALPHA) - mu * np.cos(ALPHA))))
    lift.append(sum(own.force[2] for own in end.contacts))
    assert all(own.second == "block" for own in end.contacts)
result.table(["friction", "acceleration [m/s2]", "closed form"], [[f"{m:.4f}", f"{a:.9f}", f"{b:.9f}"] for m, a, b in zip(frictions, found, right, strict=True)])
figure, axes = plt.subplots(figsize=(5.5, 3.5), layout="constrained")
fine = np.linspace(0, 0.6, 200)
axes.plot(fine, np.maximum(0, G * (np.sin(ALPHA) - fine * np.cos(ALPHA))), label="closed form")
axes.plot(frictions, found, "o", label="Sinew")
axes.set(xlabel="friction", ylabel="acceleration [m/s2]", title="a slope of 25 deg")
axes.legend()
result.picture(figure, "slope.png", "Acceleration against friction")
moving = [k for k, a in enumerate(right) if a > 0]
result.compare_all("sliding: acceleration", [found[k] for k in moving], [right[k] for k in moving], values["tolerance"], "m/s2", "closed form: " + values["what"])
result.check("friction 2 % above the slope: it sticks, acceleration", max(abs(found[k]) for k in range(len(found)) if right[k] == 0), most=1e-6, unit="m/s2")
result.compare_all("force of the ground across it", lift, [MASS * G * np.cos(ALPHA)] * len(lift), values["tolerance"], "N", "closed form: m g cos(alpha)")
tilts = [float(np.arccos(np.clip(on_slope(np.arctan(s), 2.0, [0.05, 0.05, 0.15], 1.0).state().bodies["block"].rotation[2, 2], -1, 1))) for s in (0.32, 0.35)]
result.check("three times as high as wide, slope 0.32 < 1/3: it stands, turned by", tilts[0], most=1e-6, unit="rad")
result.check("slope 0.35 > 1/3: it tips, turned by", tilts[1], least=0.5, unit="rad")
result.finish()
