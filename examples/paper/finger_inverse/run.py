"""Fig. 9: a target leads the finger's tip; the pull of its one cable is sought."""

import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import Normalize
from paper import Result, smooth
from pictures import Array, View

import sinew

MOST = 4.0  # N, at the end of the path
STEPS = 400
result = Result(__file__, "Fig. 9: the finger's pull for a target of its tip")

# Where direct equilibria bring the tip.
direct = sinew.build(result.scene(), changes={"analysis": "quasi_static", "newton": "converged"})
state = direct.initial_state()
path, pulls, shapes = [], [], []
for k in range(STEPS + 1):
    pulls.append(MOST * smooth(k / STEPS))
    if k:
        report = sinew.step(direct, {"pull": pulls[-1]}, state)
        assert report.accepted, report.meaning
    path.append(state.output("tip"))
    if k in (0, STEPS // 2, STEPS):
        shapes.append(state.snapshot())


# The same path as a target: found by one small problem in every step, at rest and in motion.
def follow(model: sinew.Model, targets: list[Array]) -> tuple[Array, Array, list[float]]:
    state = model.initial_state()
    off, found, times = [], [], []
    for target in targets:
        start = time.perf_counter()
        report = sinew.step(model, None, state, targets={"tip": target})
        times.append(1e3 * (time.perf_counter() - start))
        assert report.accepted, report.meaning
        off.append(1e3 * np.linalg.norm(state.output("tip") - target))
        found.append(state.forces[0])
    return np.array(off), np.array(found), times


rest_off, rest_pull, rest_times = follow(direct, path[1:])
motion = sinew.build(result.scene())
move_off, move_pull, times = follow(motion, path[1:])

along = path[STEPS // 2 + 1] - path[STEPS // 2 - 1]
across = np.cross(along, [0.0, 0.0, 1.0]) / np.linalg.norm(along)
# Targets beside the path cannot be reached by one cable: the nearest point is kept, and said so.
state, aside = direct.initial_state(), path[STEPS // 2] + 5e-3 * across
for _ in range(20):
    report = sinew.step(direct, None, state, targets={"tip": aside})
left = 1e3 * np.linalg.norm(state.output("tip") - aside)
nearest = 1e3 * min(np.linalg.norm(np.array(path) - aside, axis=1))

result.table(
    [
        "the tip follows its own curve (%.0f mm) in 4 s" % (1e3 * sum(np.linalg.norm(np.diff(path, axis=0), axis=1))),
        "at rest",
        "in motion, one QP per 10 ms",
    ],
    [
        ["off the target, largest [mm]", f"{rest_off.max():.2g}", f"{move_off.max():.2g}"],
        ["pull, largest [N]", f"{rest_pull.max():.3f}", f"{move_pull.max():.3f}"],
        ["a step, median [ms] (the paper: 4.31)", "", f"{np.median(times):.3f}"],
    ],
)
result.say(f"A target 5 mm beside the curve: {left:.3f} mm are left ({report.targets}); the nearest point of the curve is {nearest:.3f} mm away.")

t = np.linspace(0, 4, STEPS + 1)
figure, (way, force) = plt.subplots(1, 2, figsize=(13, 4.6), layout="constrained")
view = View(way, [0, 0, 1])
for seen, alpha in zip(shapes, (0.15, 0.3, 0.6), strict=True):
    view.solid(seen.solids[0], alpha=alpha)
    colors = view.line(seen.rods[0].points, np.abs(seen.rods[0].fields["bending_y"]), Normalize(0.0, 40.0), width=3.0)
way.plot(*view.flat(path).T, "k", lw=1, label="path of the tip")
view.balls([path[0], path[STEPS // 2], path[-1]], "orange", 9.0, "targets")
view.balls(aside, "white", 7.0, "a target beside the path")
way.set(xlabel="x [mm]", ylabel="y [mm]")
way.legend(loc="upper left", fontsize=8)
figure.colorbar(colors, ax=way, label="bending of the cable [1/m]", shrink=0.8)
force.plot(t, pulls, "k:", label="pulled to find the path")
force.plot(t[1:], rest_pull, label="found, at rest")
force.plot(t[1:], move_pull, label="found, in motion")
force.set(xlabel="time [s]", ylabel="pull [N]", title="the pull that is found")
force.legend()
result.picture(figure, "finger_inverse.png", "The finger under three of its targets, the path of its tip, and the pull that was found")

result.check("at rest: off the target", rest_off.max(), most=1e-3, unit="mm")
result.check("at rest: the pull found is the pull that made the path", np.abs(rest_pull - pulls[1:]).max(), most=1e-3, unit="N")
result.check("in motion: off the target", move_off.max(), most=0.5, unit="mm")
result.check("beside the curve: what is left, beside the nearest point", left - nearest, least=-0.01, most=0.01, unit="mm")
result.finish()
