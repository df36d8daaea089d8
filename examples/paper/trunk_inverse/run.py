"""Fig. 10: the trunk's tip follows a trajectory; the pulls of its four cables are sought."""

import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from paper import Result, smooth

import sinew

STEPS = 500
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


def follow(model: sinew.Model) -> tuple[np.ndarray, np.ndarray, list[float]]:
    state = model.initial_state()
    tips, found, times = [], [], []
    for target in path[1:]:
        start = time.perf_counter()
        report = sinew.step(model, None, state, targets={"tip": target})
        times.append(1e3 * (time.perf_counter() - start))
        assert report.accepted, report.meaning
        tips.append(state.output("tip"))
        found.append(state.forces)
    return np.array(tips), np.array(found), times


goals = np.array(path[1:])
rest_tips, rest_pulls, _ = follow(direct)
motion = sinew.build(result.scene())
tips, found, times = follow(motion)
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
figure, (way, force) = plt.subplots(1, 2, figsize=(11, 4.2), layout="constrained")
way.plot(*(1e3 * goals[:, :2].T), "k", lw=3, alpha=0.25, label="wanted")
way.plot(*(1e3 * tips[:, :2].T), lw=1, label="reached in motion")
way.set(xlabel="x [mm]", ylabel="y [mm]", title="path of the tip", aspect="equal")
way.legend()
t = np.linspace(0, 5, STEPS + 1)[1:]
for i, color in enumerate(["tab:blue", "tab:orange", "tab:green", "tab:red"]):
    force.plot(t, found[:, i], color=color, label=f"cable {i}")
    force.plot(t, rest_pulls[:, i], ":", color="black", lw=0.8, label="the same at rest" if i == 3 else None)
force.set(xlabel="time [s]", ylabel="pull [N]", title="the pulls that are found")
force.legend(fontsize=8)
result.picture(figure, "trunk_inverse.png", "Path of the tip and the pulls that were found")

result.check("at rest: off the target", off["rest"].max(), most=0.1, unit="mm")
result.check("in motion, one QP per 10 ms: off the target", off["motion"].max(), most=1.0, unit="mm")
result.check("no cable pushes: the least pull", min(found.min(), rest_pulls.min()), least=0.0, unit="N")
result.check("second differences of motion beside those of rest", jerk["motion"] / jerk["rest"], most=3.0)
result.finish()
