"""A heavy rope over a drum: how far may one end hang down?"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import EXTENSIBLE, Array, Result, path_length

import sinew

result = Result(__file__, "A heavy rope over a drum")
values = result.reference("heavy_rope_on_cylinder")
DRUM, ROPE, MU, G, RHO, LEFT = 0.05, 1e-3, 0.3, 9.81, 1000.0, 0.04
AXIS = DRUM + ROPE
B = 2 * MU * AXIS / (1 + MU**2)
CRITICAL = (LEFT + B) * np.exp(MU * np.pi) + B


def hung(part: float) -> tuple[Array, Array]:
    """Times, and how far the left end has moved [m]."""
    right = part * CRITICAL
    angles = np.linspace(0, np.pi, 31)
    path = np.vstack([[-AXIS, 0, -LEFT], np.stack([-AXIS * np.cos(angles), 0 * angles, AXIS * np.sin(angles)], axis=1), [AXIS, 0, -right]])
    length = path_length(path)
    arc = length - LEFT - right
    ends = np.concatenate([np.linspace(0, LEFT, 9), LEFT + arc * np.arange(1, 31) / 30, LEFT + arc + right * np.arange(1, 9) / 8])
    rope = sinew.Rod(path=path.tolist(), sections=ends.tolist(), section=sinew.Circle(radius=ROPE), rest="path", start="path", base="free",
                     strains=EXTENSIBLE, material=sinew.RodMaterial(young=3e5, poisson=0.5, density=RHO, viscosity=10))
    scene = sinew.Scene(
        time=sinew.Time(step=0.005, duration=0.8 if part < 1 else 0.5), gravity=[0, 0, -G], rods={"rope": rope}, contact=sinew.Contact(friction=MU),
        obstacles={"drum": sinew.Obstacle(cylinder=sinew.CylinderShape(radius=DRUM, length=0.1), pose=sinew.Pose(rotate=[np.pi / 2, 0, 0]))},
        # Its weight comes on slowly: let go at once, it would bounce on its own elongation.
        loads={"lift": sinew.RodLoad(rod="rope", from_=0, to=length, force=[0, 0, G * RHO * np.pi * ROPE**2], factor=sinew.Table(times=[0, 0.3], values=[1, 0]))},
        outputs={"left": sinew.Output(rod="rope", at=0)},
    )
    run = sinew.simulate(scene, progress=False)
    return run.time, run.signals["left.z"] - run.signals["left.z"][0]


figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
rows = []
moved = {part: hung(part) for part in [*values["hold"], *values["slide"]]}
for part, (times, z) in moved.items():
    rows.append([f"{part:g}", f"{1e3 * np.abs(z).max():.3f}", f"{1e3 * np.ptp(z[times > 0.5 - 1e-9]):.4f}" if part < 1 else "", "holds" if part < 1 else "slides"])
    axes.plot(times, 1e3 * z, label=f"{part:g}")
axes.set(xlabel="time [s]", ylabel="the short end rises by [mm]", ylim=(-2, 40))
axes.legend(title="overhang, over\nthe critical one", loc="center left", bbox_to_anchor=(1, 0.5))
result.picture(figure, "heavy_rope.png", "How the short end moves: three ropes hold, two slide, until their end has left the drum and falls")
result.table(["overhang, over the critical one", "the short end moves, most [mm]", "after 0.5 s [mm]", "the law says"], rows)
result.say(f"The critical overhang of this rope is {1e3 * CRITICAL:.2f} mm, with {1e3 * LEFT:.0f} mm on the other side.")
for part in values["hold"]:
    times, z = moved[part]
    result.check(f"{part:g} of the critical overhang: it moves by its elongation alone", 1e3 * float(np.abs(z).max()), most=1, unit="mm")
    result.check(f"{part:g}: and then stays", 1e3 * float(np.ptp(z[times > 0.5 - 1e-9])), most=0.01, unit="mm")
for part in values["slide"]:
    result.check(f"{part:g} of the critical overhang: it slides", 1e3 * float(moved[part][1].max()), least=10, unit="mm")
result.finish()
