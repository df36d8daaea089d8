"""Fig. 6: the same pull with ever more sections; do cables of few sections go where one of 80 goes?"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import Normalize
from paper import Result
from pictures import Array, View

import sinew

COUNTS = [3, 4, 6, 10, 20, 40, 80]
RADIUS = 0.5  # mm, of the cable
LENGTH = 0.081
ALONG = np.linspace(0.0, LENGTH, 325)
TARGETS = np.linspace(0.02, LENGTH, 6)[1:-1]  # what is inside the finger, in five parts
result = Result(__file__, "Fig. 6: sections of the cable")


def pulled(count: int) -> tuple[sinew.State, Array, Array]:
    """The finger at rest; the cable's curve, and how it is bent, at ALONG."""
    scene = sinew.Scene.from_file(result.scene())
    scene.rods["cable"].sections = count
    for k, s in enumerate(ALONG):
        scene.outputs[f"at{k}"] = sinew.Output(rod="cable", at=float(s))
    state = sinew.simulate(scene, progress=False).state()
    own = state.snapshot().rods[0]
    within = (np.searchsorted(own.abscissa, ALONG + 1e-9, "right") - 1).clip(0, len(own.abscissa) - 2)
    return state, np.array([state.output(f"at{k}") for k in range(len(ALONG))]), np.abs(own.fields["bending_y"][within])


def off(points: Array, curve: Array) -> Array:
    """How far points are from a polyline. (n, 3), (m, 3) -> (n,) [m]"""
    a, d = curve[:-1], np.diff(curve, axis=0)
    to = points[:, None, :] - a
    t = np.clip((to * d).sum(2) / (d * d).sum(1), 0.0, 1.0)
    return np.asarray(np.linalg.norm(to - t[..., None] * d, axis=2).min(1))


states, curves, bent = {}, {}, {}
for count in COUNTS:
    states[count], curves[count], bent[count] = pulled(count)
targets = np.array([[np.interp(s, ALONG, x) for s in TARGETS] for x in curves[80].T]).T
errors = {count: 1e3 * off(targets, curves[count]) for count in COUNTS}
largest = {count: float(own.max()) for count, own in errors.items()}
alike = {count: float(np.corrcoef(bent[count], bent[80])[0, 1]) for count in COUNTS}
tips = {count: state.output("tip") for count, state in states.items()}

result.table(
    ["sections", *[f"target at {1e3 * s:.0f} mm [mm]" for s in TARGETS], "largest [mm]", "tip off [mm]", "force [N]", "bending: correlation with 80"],
    [
        [
            count,
            *[f"{e:.3f}" for e in errors[count]],
            f"{largest[count]:.3f}",
            f"{1e3 * np.linalg.norm(tips[count] - tips[80]):.3f}",
            f"{states[count].forces[0]:.3f}",
            f"{alike[count]:.3f}",
        ]
        for count in COUNTS
    ],
)

figure, panels = plt.subplots(2, 4, figsize=(13, 6.8), layout="constrained")
norm = Normalize(0.0, float(bent[80].max()))
for axes, count in zip(panels.flat, COUNTS):
    view = View(axes, [0, 0, 1])
    view.solid(states[count].snapshot().solids[0])
    colors = view.line(curves[count], bent[count], norm)
    view.balls(targets, "gold")
    axes.set(title=f"{count} sections: {largest[count]:.2g} mm" if count < 80 else "80 sections: targets", xlim=(-25, 50), ylim=(-18, 55))
    axes.label_outer()
figure.colorbar(colors, ax=panels, label="bending about z [1/m]", shrink=0.7)
panels[-1, -1].loglog(COUNTS[:-1], [largest[count] for count in COUNTS[:-1]], "o-")
panels[-1, -1].axhline(RADIUS, color="gray", ls=":")
panels[-1, -1].text(3, 1.1 * RADIUS, "the cable's radius")
panels[-1, -1].set(xlabel="sections", title="farthest from a target [mm]")
panels[-1, -1].set_xticks(COUNTS[:-1], labels=[str(count) for count in COUNTS[:-1]])
panels[-1, -1].minorticks_off()
panels[-1, -1].grid(True, alpha=0.3)
result.picture(figure, "sections.png", "The bent finger with cables of 3 to 80 sections, in the colours of their bending, and the four targets")

result.check("6 sections: largest error at the targets", largest[6], most=1.0, unit="mm")
result.check("6 sections pass the targets within the cable's radius", largest[6], most=RADIUS, unit="mm")
result.check("3 sections do not", largest[3], least=RADIUS, unit="mm")
result.check("order of convergence from 6 to 40 sections", float(np.log(largest[6] / largest[40]) / np.log(40 / 6)), least=1.5)
result.check("6 sections: bending alike (correlation)", alike[6], least=0.9)
result.check("3 sections: not yet", alike[3], most=0.9)
result.finish()
