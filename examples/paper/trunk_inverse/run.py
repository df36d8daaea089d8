"""Fig. 10: the trunk's tip follows a trajectory; the pulls of its four cables are sought."""

import sys
import time
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import Normalize
from paper import Result, smooth
from pictures import Array, View

import sinew

STEPS = 500
SHOWN = (1, 200, 260, 310)  # steps
TENSION = 0.08  # N: what opposite cables hold each other with
result = Result(__file__, "Fig. 10: the trunk's four pulls for a trajectory of its tip")


def pulls_at(u: float) -> list[float]:
    """Pulls [N] that draw an eight, once the cables are tight."""
    tight, a = smooth(min(1.0, 2.0 * u)), 2.0 * np.pi * u
    one, two = 0.5 * 0.045 * np.sin(a), 0.5 * 0.030 * np.sin(2.0 * a)
    return [tight * (TENSION + own) for own in (one, two, -one, -two)]


direct = sinew.build(result.scene(), changes={"analysis": "quasi_static", "newton": "converged"})
state = direct.initial_state()
path, pulls = [state.output("tip")], [[0.0] * 4]
for k in range(1, STEPS + 1):
    pulls.append(pulls_at(smooth(k / STEPS)))
    report = sinew.step(direct, pulls[-1], state)
    assert report.accepted, report.meaning
    path.append(state.output("tip"))


def bending(rod: sinew.RodSnapshot) -> Array:
    """[1/m] along a cable."""
    return np.asarray(np.hypot(rod.fields["bending_y"], rod.fields["bending_z"]))


def follow(model: sinew.Model) -> tuple[Array, Array, list[float], list[tuple[float, sinew.Snapshot]]]:
    """Tips, pulls, times of steps [ms], and how it looks now and then."""
    state = model.initial_state()
    tips, found, times = [], [], []
    seen: list[tuple[float, sinew.Snapshot]] = []
    for k, target in enumerate(path[1:], 1):
        start = time.perf_counter()
        report = sinew.step(model, None, state, targets={"tip": target})
        times.append(1e3 * (time.perf_counter() - start))
        assert report.accepted, report.meaning
        tips.append(state.output("tip"))
        found.append(state.forces)
        if k in SHOWN:
            seen.append((0.01 * k, state.snapshot()))
    return np.array(tips), np.array(found), times, seen


goals = np.array(path[1:])
rest_tips, rest_pulls = follow(direct)[:2]
motion = sinew.build(result.scene())
tips, found, times, shapes = follow(motion)
off = {name: 1e3 * np.linalg.norm(own - goals, axis=1) for name, own in (("rest", rest_tips), ("motion", tips))}
jerk = {name: np.abs(np.diff(own, 2, axis=0)).max() for name, own in (("rest", rest_pulls), ("motion", found))}

result.table(
    ["an eight of %.0f mm in 5 s" % (1e3 * np.linalg.norm(np.diff(path, axis=0), axis=1).sum()), "at rest", "in motion, one QP per 10 ms"],
    [
        ["off the target, largest [mm]", f"{off['rest'].max():.2g}", f"{off['motion'].max():.2g}"],
        ["pull, least and largest [N]", f"{rest_pulls.min():.3f} to {rest_pulls.max():.3f}", f"{found.min():.3f} to {found.max():.3f}"],
        ["second difference of the pulls, largest [mN]", f"{1e3 * jerk['rest']:.3f}", f"{1e3 * jerk['motion']:.3f}"],
        ["a step, median [ms] (the paper: 82.33)", "", f"{np.median(times):.2f}"],
    ],
)
figure: Any = plt.figure(figsize=(13, 5.8), layout="constrained")
top, bottom = figure.subfigures(2, 1, height_ratios=[0.6, 1.0])
panels = top.subplots(1, len(shapes), sharex=True, sharey=True)
most = max(float(bending(rod).max()) for _, seen in shapes for rod in seen.rods)
for axes, (when, seen) in zip(panels, shapes, strict=True):
    view = View(axes, [1.0, 0.45, 0.8])
    view.solid(seen.solids[0], alpha=0.35)
    for rod in seen.rods:
        colors = view.line(rod.points, bending(rod), Normalize(0.0, most), width=2.0)
    axes.plot(*view.flat(goals).T, color="orange", lw=1)
    view.balls(seen.outputs["tip"], "orange", 8.0)
    axes.set(title=f"{when:g} s", xticks=[], yticks=[])
top.colorbar(colors, ax=panels, label="bending [1/m]", shrink=0.8)
way, force = bottom.subplots(1, 2, width_ratios=[1.0, 2.0])
way.plot(*(1e3 * goals[:, :2].T), "k", lw=3, alpha=0.25, label="wanted")
way.plot(*(1e3 * tips[:, :2].T), lw=1, label="reached in motion")
way.set(xlabel="x [mm]", ylabel="y [mm]", title="path of the tip", aspect="equal")
way.legend(fontsize=8, loc="center left", bbox_to_anchor=(1.0, 0.5))
t = np.linspace(0, 5, STEPS + 1)[1:]
for i, color in enumerate(["tab:blue", "tab:orange", "tab:green", "tab:red"]):
    force.plot(t, found[:, i], color=color, label=f"cable {i}")
    force.plot(t, rest_pulls[:, i], ":", color="black", lw=0.8, label="the same at rest" if i == 3 else None)
force.set(xlabel="time [s]", ylabel="pull [N]", title="the pulls that are found")
force.legend(fontsize=8)
result.picture(figure, "trunk_inverse.png", "The trunk on its way, the path of its tip and the pulls that were found")

result.check("at rest: off the target", off["rest"].max(), most=1e-3, unit="mm")
result.check("in motion, one QP per 10 ms: off the target", off["motion"].max(), most=1e-6, unit="mm")
result.check("no cable pushes: the least pull", min(found.min(), rest_pulls.min()), least=0.0, unit="N")
result.check("second differences of motion beside those of rest", jerk["motion"] / jerk["rest"], most=2.0)
result.finish()
