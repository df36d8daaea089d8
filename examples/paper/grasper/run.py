"""Fig. 5: three fingers grasp a cube and lift it; what their cables bear."""

import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import Normalize
from paper import Result
from pictures import Array, View

import sinew

FINGERS = ["one", "two", "three"]
RADIUS, YOUNG, FRICTION, WEIGHT = 0.5e-3, 5e9, 0.5, 0.030 * 9.81
SHOWN = {0.5: "down beside the cube", 1.5: "closed", 3.0: "lifted", 8.0: "held for 5 s"}
result = Result(__file__, "Fig. 5: the grasper and the stress in its cables")


def bent(points: Array) -> Array:
    """Curvature of a line by its points alone: of the circle through each and its neighbours, (n - 2,). [1/m]"""
    a, b = points[1:-1] - points[:-2], points[2:] - points[1:-1]
    c = points[2:] - points[:-2]
    lengths = np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1) * np.linalg.norm(c, axis=1)
    return np.asarray(2.0 * np.linalg.norm(np.cross(a, b), axis=1) / lengths)


run = sinew.simulate(result.scene(), progress=False)
after = {name: run.signals[f"cube.{name}"] for name in "xyz"}
times = run.time
cube = np.stack([after[name] for name in "xyz"], axis=1)
at = {when: int(np.argmin(np.abs(times - when))) for when in (*SHOWN, 2.0)}
held = times >= 3.0 - 1e-9
lifted = 1e3 * (cube[at[3.0], 1] - cube[at[2.0], 1])
slip = 1e3 * np.linalg.norm(cube[held] - cube[at[3.0]], axis=1).max()
end = run.state()
seen = end.snapshot()

rows, norm = [], Normalize(0.0, max(float(rod.von_mises.max()) for rod in seen.rods) / 1e6)
area, ratios, bendings, tensions = np.pi * RADIUS**2, [], [], []
for k, (name, rod) in enumerate(zip(FINGERS, seen.rods, strict=True)):
    force = end.forces[k]
    by_force = force / area  # at the base
    # Constant bending in each of 15 sections, four points a section: at the middle of a section all three are its own.
    middle = np.arange(2, len(rod.abscissa) - 2, 4)
    by_shape = YOUNG * RADIUS * bent(rod.points)[middle - 1]
    hooke = YOUNG * RADIUS * np.hypot(rod.fields["bending_y"], rod.fields["bending_z"])[middle]
    most = int(by_shape.argmax())
    ratios.append(float(rod.fields["axial_stress"][0] / by_force))
    tensions.append(rod.fields["axial_force"] / force)
    bendings.append(
        (float(by_shape[most]), float(rod.fields["bending_stress"][middle[most]]), float(np.abs(by_shape - hooke).max() / by_shape.max()))
    )
    normal = run.signals[f"{name}.normal"][-1]
    rows.append(
        [
            name,
            f"{force:.2f}",
            f"{by_force / 1e6:.2f}",
            f"{rod.fields['axial_stress'][0] / 1e6:.2f}",
            f"{by_shape[most] / 1e6:.1f}",
            f"{rod.fields['bending_stress'].max() / 1e6:.1f}",
            f"{rod.von_mises.max() / 1e6:.1f}",
            f"{normal:.3f}",
        ]
    )
result.say(
    f"The cube (40 mm, 30 g) is lifted by {lifted:.2f} mm and slips by {slip:.3f} mm in the five seconds that follow. What the cables bear then:"
)
result.table(
    [
        "finger",
        "pull [N]",
        "pull / area [MPa]",
        "axial stress at the base [MPa]",
        "E r curvature of its shape, most [MPa]",
        "bending stress, most [MPa]",
        "von Mises, most [MPa]",
        "presses the cube with [N]",
    ],
    rows,
)
touching = np.array([[run.signals[f"{name}.{axis}"][-1] for axis in "xyz"] for name in FINGERS])
shares = [by_shape / (pull / area) for (by_shape, _, _), pull in zip(bendings, end.forces, strict=True)]
result.say(
    f"Where it is bent most, bending adds {min(shares):.1f} to {max(shares):.1f} times the stress of the pull: a geometric cable knows nothing of "
    f"it. As the fingers stand askew they lift the cube by {1e3 * (cube[at[2.0], 1] - cube[0, 1]):.1f} mm while they close, before the hand rises."
)

figure: Any = plt.figure(figsize=(13, 7.2), layout="constrained")
top, bottom = figure.subfigures(2, 1, height_ratios=[1.5, 1.0])
panels = top.subplots(1, len(SHOWN), sharex=True, sharey=True)
for axes, (when, what) in zip(panels, SHOWN.items(), strict=True):
    now = run.state(at[when]).snapshot()
    view = View(axes, [1.0, 0.35, 1.3])
    for body in now.bodies:
        if not body.ground:
            view.surface(body.points, body.surface, "#c8a26a", 1.0)
    for solid in now.solids:
        view.solid(solid, alpha=0.4)
    for rod in now.rods:
        colors = view.line(rod.points, rod.von_mises / 1e6, norm, width=3.0)
    axes.set(title=f"{when:g} s: {what}", xticks=[], yticks=[])
top.colorbar(colors, ax=panels, label="stress in the cables\n(von Mises) [MPa]", shrink=0.8)
along, height = bottom.subplots(1, 2)
for name, rod, color in zip(FINGERS, seen.rods, ("tab:blue", "tab:orange", "tab:green"), strict=True):
    along.step(1e3 * rod.abscissa, rod.von_mises / 1e6, where="post", color=color, label=f"{name}: von Mises")
    along.plot(1e3 * rod.abscissa, rod.fields["axial_stress"] / 1e6, ":", color=color, label=f"{name}: axial")
along.set(xlabel="along the cable [mm]", ylabel="stress at 8 s [MPa]", ylim=(0, 430))
along.legend(fontsize=8, ncols=3)
height.plot(times, 1e3 * (cube[:, 1] - cube[0, 1]), "k", label="cube lifted [mm]")
force_axis = height.twinx()
for name, color in zip(FINGERS, ("tab:blue", "tab:orange", "tab:green"), strict=True):
    force_axis.plot(times, run.signals[f"{name}_pull.force"], color=color, label=f"{name}: pull")
height.set(xlabel="time [s]", ylabel="cube lifted [mm]")
force_axis.set(ylabel="pull of the cables [N]")
force_axis.legend(fontsize=8)
result.picture(figure, "grasper.png", "The grasper comes down, closes, lifts and holds the cube, with the stress in its cables")

result.compare("the hand rises by 50 mm, the cube by", lifted, 50.0, 2e-3, "mm")
result.check("then it slips in 5 s", slip, most=1.0, unit="mm")
result.compare("the fingers carry it: their vertical forces at 8 s", float(touching[:, 1].sum()), WEIGHT, 0.01, "N", "its weight")
result.check("sideways they cancel", float(np.hypot(*touching.sum(axis=0)[[0, 2]])), most=0.01 * WEIGHT, unit="N")
cone = [
    np.sqrt(max(0.0, own @ own - n * n)) / (FRICTION * n)
    for own, n in zip(touching, [run.signals[f"{name}.normal"][-1] for name in FINGERS])
    if n > 1e-6
]
result.check("no finger holds on by more than friction allows (share of it)", float(max(cone, default=np.inf)), most=1.0)
result.check("cables: axial stress at the base over pull / area, farthest from 1", max(abs(own - 1.0) for own in ratios), most=1e-6)
result.check("cables: bending stress over E r curvature of their shape, farthest from 1", max(abs(b / a - 1.0) for a, b, _ in bendings), most=1e-4)
result.check("cables: curvature of the shape beside the strain, off by (of the largest)", max(own for *_, own in bendings), most=1e-4)
result.check(
    "no friction in the channels: tension anywhere over the pull, farthest from 1", max(float(np.abs(own - 1.0).max()) for own in tensions), most=0.05
)
stiff = sinew.simulate(
    result.scene(),
    changes={**{f"rods.{name}_cable.material.young": "50 GPa" for name in FINGERS}, "time.duration": "2 s", "newton": {"limit": 30}},
    progress=False,
)
soft = sinew.simulate(result.scene(), changes={"time.duration": "2 s", "newton": {"limit": 30}}, progress=False)
pulls = [float(own.signals["one_pull.force"][-1]) for own in (soft, stiff)]
result.check("cables ten times as stiff must be pulled harder for the same way (ratio)", pulls[1] / pulls[0], least=1.03)
result.finish()
