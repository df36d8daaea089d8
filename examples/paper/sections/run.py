"""Fig. 6: the same pull with ever more sections; do cables of few sections go where one of 80 goes?"""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from paper import Result

import sinew

COUNTS = [3, 4, 6, 10, 20, 40, 80]
result = Result(__file__, "Fig. 6: sections of the cable")


def off(points: np.ndarray, curve: np.ndarray) -> np.ndarray:
    """How far points are from a polyline. (n, 3), (m, 3) -> (n,) [m]"""
    a, d = curve[:-1], np.diff(curve, axis=0)
    to = points[:, None, :] - a
    t = np.clip((to * d).sum(2) / (d * d).sum(1), 0.0, 1.0)
    return np.linalg.norm(to - t[..., None] * d, axis=2).min(1)


rods, tips, forces = {}, {}, {}
for count in COUNTS:
    run = sinew.simulate(result.scene(), changes={"rods.cable.sections": count}, progress=False)
    rods[count] = run.state().snapshot().rods[0]
    tips[count] = run.state().output("tip")
    forces[count] = run.state().forces[0]

fine = rods[80]
places = np.linspace(0.02, fine.abscissa[-1], 6)[1:-1]
targets = np.array([[np.interp(s, fine.abscissa, x) for s in places] for x in fine.points.T]).T
errors = {count: 1e3 * off(targets, rods[count].points) for count in COUNTS}
rows = [
    [count, *[f"{e:.3f}" for e in errors[count]], f"{errors[count].max():.3f}",
     f"{1e3 * np.linalg.norm(tips[count] - tips[80]):.3f}", f"{forces[count]:.3f}"]
    for count in COUNTS
]
result.table(["sections", *[f"target at {1e3 * s:.0f} mm [mm]" for s in places], "largest [mm]", "tip off [mm]", "force [N]"], rows)

figure, (shape, bending) = plt.subplots(1, 2, figsize=(11, 4.2), layout="constrained")
for count in COUNTS:
    x = 1e3 * rods[count].points.T
    shape.plot(x[0], x[1], lw=1.2, label=f"{count}")
shape.plot(*1e3 * targets.T[:2], "o", color="goldenrod", mec="black", label="targets")
shape.set(xlabel="x [mm]", ylabel="y [mm]", title="the cable after a pull of 20 mm", aspect="equal")
shape.legend(title="sections", fontsize=8)
for row, count in enumerate(COUNTS):
    own = rods[count]
    mesh = bending.pcolormesh(
        1e3 * own.abscissa, [row - 0.4, row + 0.4], np.abs(own.fields["bending_y"])[None, :-1], cmap="viridis", vmin=0.0,
        vmax=float(np.abs(fine.fields["bending_y"]).max()),
    )
bending.set(yticks=range(len(COUNTS)), yticklabels=COUNTS, xlabel="along the cable [mm]", ylabel="sections", title="bending about z (the cable's own y)")
figure.colorbar(mesh, label="curvature [1/m]")
result.picture(figure, "sections.png", "The cable's shape and bending with 3 to 80 sections")

result.check("6 sections: largest error at the targets", errors[6].max(), most=1.0, unit="mm")
result.check("3 sections: largest error at the targets", errors[3].max(), most=10.0, unit="mm")
result.check("40 sections: largest error at the targets", errors[40].max(), most=0.1, unit="mm")
result.finish()
