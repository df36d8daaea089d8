"""Fig. 8: a pre-bent rod is pushed into a soft block and turned by a full circle."""

import sys
from pathlib import Path
from typing import Any

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import Normalize
from paper import Result
from pictures import View

import sinew

result = Result(__file__, "Fig. 8: a pre-bent rod in a soft block")
model = sinew.build(result.scene("../../prebent_rod.yaml"), changes={"time.step": "10 ms", "rods.rod.sections": 48})
state = model.initial_state()
rest = state.solids["block"].x.copy()
kept, torques = {}, []
while state.time < 2.0 - 1e-9:
    report = sinew.step(model, None, state)
    assert report.accepted, report.meaning
    if state.time > 1.0 + 1e-9:
        torques.append(state.forces[1])
    angle = round(360.0 * max(0.0, state.time - 1.0))
    if angle in (90, 180, 270, 360) or abs(state.time - 1.0) < 1e-9:
        seen = state.snapshot()
        kept[angle] = (seen.rods[0], state.solids["block"].x.copy(), seen.solids[0])

rows = []
for angle, (own, x, _) in sorted(kept.items()):
    tip = 1e3 * own.points[-1]
    rows.append(
        [
            angle,
            *[f"{v:.2f}" for v in tip],
            f"{1e3 * np.linalg.norm(x - rest, axis=1).max():.2f}",
            f"{own.fields['torsion'].min():.2f} to {own.fields['torsion'].max():.2f}",
        ]
    )
result.table(["turned [deg]", "rod's end x [mm]", "y [mm]", "z [mm]", "block moves, most [mm]", "torsion along the rod [1/m]"], rows)
result.say(
    f"The torque of the turning motor goes to and fro, up to {1e6 * np.abs(torques).max():.0f} uN m: the block is held at its bottom alone and is "
    "stiffer one way than the other, which twists the rod now one way, now the other."
)

figure: Any = plt.figure(figsize=(13, 5.2), layout="constrained")
left, right = figure.subfigures(1, 2, width_ratios=[1.5, 1.0])
panels = left.subplots(2, 2)
most = max(float(np.abs(own.fields["torsion"]).max()) for own, _, _ in kept.values())
for axes, angle in zip(panels.flat, (0, 90, 180, 270), strict=True):
    own, _, block = kept[angle]
    view = View(axes, [0.5, -1.0, 0.6], up=[0, 0, 1])
    view.solid(block, alpha=0.35)
    colors = view.line(own.points, np.abs(own.fields["torsion"]), Normalize(0.0, most))
    view.balls(own.points[-1], "black", 4.0)
    axes.set(title=f"turned by {angle} deg", xticks=[], yticks=[])
left.colorbar(colors, ax=panels, label="torsion, either way [1/m]", shrink=0.8)
twists = right.subplots()
for angle, (own, _, _) in sorted(kept.items()):
    twists.step(1e3 * own.abscissa, own.fields["torsion"], "--" if angle == 360 else "-", where="post", label=f"{angle} deg")
twists.set(xlabel="along the rod [mm]", ylabel="torsion [1/m]", title="torsion along the rod")
twists.legend(title="turned")
result.picture(figure, "prebent.png", "The rod in the block, and its torsion, as it is turned")

sides = {angle: own.points[-1, 1:] - 0.01 for angle, (own, _, _) in kept.items()}
result.check("pushed in: the block moves", 1e3 * np.linalg.norm(kept[0][1] - rest, axis=1).max(), least=1.0, unit="mm")
result.check(
    "turned by half: the rod's end is on the other side (cosine)",
    float(sides[0] @ sides[180] / np.linalg.norm(sides[0]) / np.linalg.norm(sides[180])),
    most=-0.99,
)
result.check("turned by a full circle: the rod's end is back", 1e3 * float(np.linalg.norm(sides[360] - sides[0])), most=1e-3, unit="mm")
rod, _, _ = kept[90]
first, second = np.interp(rod.abscissa[-1] / 48 * np.array([0.5, 1.5]), rod.abscissa, rod.fields["torsion"])  # of sections: means
base = 1.5 * first - 0.5 * second
stiffness = 2e9 / 2.8 * np.pi / 2 * 0.8e-3**4  # G J of the rod [N m2]
most = float(np.abs(torques).max())
result.check("the motor's torque is what twists the base, - G J times torsion, at 90 deg: ratio", -torques[24] / (stiffness * base), 0.998, 1.002)
result.check("nothing is lost: the torque's mean over the circle, beside its largest", abs(float(np.mean(torques))) / most, most=1e-3)
result.finish()
