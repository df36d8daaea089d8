"""A ball pressed into a block: Hertz."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import Array, Result, block, wall

import sinew

result = Result(__file__, "A ball on a block: Hertz's contact")
BALL, DEPTH, YOUNG, NU = 0.02, 5e-5, 1e6, 0.3
CONTACT = np.sqrt(BALL * DEPTH)  # 1 mm
FINE, COARSE, CELL, FAR = 8, 9, CONTACT / 6, 40 * CONTACT

low, high = 1.01, 2.0  # growth of cells beyond the fine ones, such that they fill the block
for _ in range(60):
    growth = 0.5 * (low + high)
    low, high = (low, growth) if growth * (growth**COARSE - 1) / (growth - 1) > FAR / CELL - FINE else (growth, high)
ends = CELL * np.concatenate([np.arange(FINE + 1), FINE + growth * (growth ** np.arange(1, COARSE + 1) - 1) / (growth - 1)])


def place(x: Array) -> Array:
    return np.asarray(ends[np.rint(x * (FINE + COARSE)).astype(int)])


# A quarter of a block, upside down: its surface at z = 0, and the ball comes from below, so slowly that inertia is nothing.
box = [[-1, -1, FAR - 1e-6], [1, 1, 1]]
solid = sinew.Solid(
    mesh=block((FINE + COARSE,) * 3, place), material=sinew.SolidMaterial(law="corotational", young=YOUNG, poisson=NU), density=1000,
    fixed=[sinew.Held(box=box), wall("x"), wall("y")],
)
scene = sinew.Scene(
    time=sinew.Time(step=1000, duration=4000), solids={"block": solid}, contact=sinew.Contact(friction=0),
    frames={"press": sinew.Frame(motion=sinew.FrameMotion(times=[0, 4000], translate=[[0, 0, 0], [0, 0, DEPTH]]))},
    obstacles={"ball": sinew.Obstacle(sphere=sinew.SphereShape(radius=BALL), pose=sinew.Pose(translate=[0, 0, -BALL]), frame="press")},
)
run = sinew.simulate(scene, progress=False)
rows = []
for k in range(len(run.time)):
    state = run.state(k)
    depth = DEPTH * state.time / 4000
    if depth < 0.4 * DEPTH:
        continue  # with few nodes in contact
    force = sum(abs(own.force[2]) for own in state.contacts)
    widest = max(np.hypot(*own.point[:2]) for own in state.contacts if own.force[2] != 0)
    rows.append([depth, force, YOUNG / (1 - NU**2) * np.sqrt(BALL) * depth**1.5 / 3, widest, np.sqrt(BALL * depth)])
found = np.array(rows)
result.table(["depth [um]", "force of a quarter [mN]", "Hertz", "radius of contact [mm]", "Hertz"],
             [[f"{1e6 * d:.1f}", f"{1e3 * f:.4f}", f"{1e3 * g:.4f}", f"{1e3 * a:.3f}", f"{1e3 * b:.3f}"] for d, f, g, a, b in rows])
figure, axes = plt.subplots(figsize=(5.5, 3.5), layout="constrained")
depths = np.linspace(0, DEPTH, 50)
axes.plot(1e6 * depths, 1e3 * YOUNG / (1 - NU**2) * np.sqrt(BALL) * depths**1.5 / 3, label="Hertz")
axes.plot(1e6 * found[:, 0], 1e3 * found[:, 1], "o", label="Sinew")
axes.set(xlabel="depth [um]", ylabel="force of a quarter [mN]")
axes.legend()
result.picture(figure, "hertz.png", "Force against depth, beside Hertz")
source = "Johnson, Contact Mechanics, 1985, 4.2"
result.compare_all("force", found[:, 1], found[:, 2], 5e-2, "N", source)
result.check("radius of contact off Hertz's, over that of the end", float(np.abs(found[:, 3] - found[:, 4]).max() / CONTACT), most=0.2)
result.finish()
