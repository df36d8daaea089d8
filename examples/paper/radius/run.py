"""Fig. 7: thicker cables, pulled by the same force and by the same length."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.colors import Normalize
from paper import Result
from pictures import View

import sinew

RADII = [0.5, 1.0, 1.5, 2.0, 3.0]  # mm
FORCE, PULL = 3.0, 0.010  # N, m
SCENE = "../sections/scene.yaml"
result = Result(__file__, "Fig. 7: radius of the cable")

figure, panels = plt.subplots(2, len(RADII), figsize=(13, 4.2), sharex=True, sharey=True, layout="constrained")
drives = {
    f"force of {FORCE:g} N": sinew.Actuator(rod="cable", force=sinew.Table(times=[0, 1], values=[0, FORCE])),
    f"pull of {1e3 * PULL:g} mm": sinew.Actuator(rod="cable", displacement=sinew.Table(times=[0, 1], values=[0, PULL])),
}
moved: list[list[dict[str, float]]] = []
for row, (name, drive) in zip(panels, drives.items(), strict=True):
    moved.append([])
    for axes, radius in zip(row, RADII, strict=True):
        changes = {"rods.cable.section.circle.radius": f"{radius} mm", "rods.cable.sections": 15, "actuators.pull": drive}
        run = sinew.simulate(result.scene(SCENE), changes=changes, progress=False)
        seen = run.state().snapshot()
        cable = seen.rods[0]
        tip = run.output("tip")[-1] - run.output("tip")[0]
        force, pulled = float(run.signals["pull.force"][-1]), float(run.signals["pull.displacement"][-1])
        moved[-1].append(
            {
                "tip": 1e3 * float(np.linalg.norm(tip)),
                "back": -1e3 * float(tip[0]),
                "turned": float(np.degrees(np.arctan2(cable.tangents[-1, 1], cable.tangents[-1, 0]))),
                "force": force,
                "pulled": 1e3 * pulled,
            }
        )
        view = View(axes, [0, 0, 1])
        view.solid(seen.solids[0])
        colors = view.line(cable.points, np.abs(cable.fields["bending_y"]), Normalize(0.0, 40.0), width=2.0 + 2.0 * radius)
        axes.set(title=f"{radius} mm: {force:.1f} N, {1e3 * pulled:.1f} mm", xlim=(-22, 95), ylim=(-18, 58))
    row[0].set_ylabel(f"the same {name}")
    result.say(f"The same {name}:")
    result.table(
        ["radius [mm]", "E I of the cable [N mm2]", "tip moves [mm]", "of it back [mm]", "cable's end turned [deg]", "force [N]", "pulled [mm]"],
        [
            [r, f"{5e9 * np.pi / 4 * (1e-3 * r) ** 4 * 1e6:.0f}", *[f"{m[k]:.2f}" for k in ("tip", "back", "turned", "force", "pulled")]]
            for r, m in zip(RADII, moved[-1], strict=True)
        ],
    )
figure.colorbar(colors, ax=panels, label="bending about z [1/m]", shrink=0.7)
result.picture(figure, "radius.png", "The finger with cables of 0.5 to 3 mm pulled by the same force and by the same length")

by_force, by_pull = moved
thin, thick = by_force[0], by_force[-1]
result.check(
    "the same force: every thicker cable turns less (largest ratio)", max(b["turned"] / a["turned"] for a, b in zip(by_force, by_force[1:])), most=0.5
)
result.check(
    "the same pull: every thicker cable turns less (largest ratio)", max(b["turned"] / a["turned"] for a, b in zip(by_pull, by_pull[1:])), most=0.75
)
result.check(
    "the same pull: every thicker cable needs more force (least ratio)", min(b["force"] / a["force"] for a, b in zip(by_pull, by_pull[1:])), least=1.0
)
result.check("3 mm bends no more: it turns", thick["turned"], least=0.0, most=1.0, unit="deg")
result.check("3 mm: the silicone is compressed: of the tip's way, straight back", thick["back"] / thick["tip"], least=0.95)
result.check("0.5 mm: it bends: of the tip's way, straight back", thin["back"] / thin["tip"], most=0.75)
springs = [own[-1]["force"] / own[-1]["pulled"] for own in moved]
result.compare("3 mm: compressed like a spring: stiffness at the same pull [N/mm] beside that at the same force", springs[1], springs[0], 0.1, "N/mm")
result.finish()
