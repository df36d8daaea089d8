"""Fig. 7: thicker cables, pulled by the same force and by the same length."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from paper import Result

import sinew

RADII = [0.5, 1.0, 1.5, 2.0, 3.0]  # mm
FORCE = "3 N"
PULL = "10 mm"
SCENE = "../sections/scene.yaml"
result = Result(__file__, "Fig. 7: radius of the cable")

figure, pictures = plt.subplots(1, 2, figsize=(11, 4.2), sharey=True, layout="constrained")
drives = {
    f"force of {FORCE}": sinew.Actuator(rod="cable", force=sinew.Table(times=[0, 1], values=[0, FORCE])),
    f"pull of {PULL}": sinew.Actuator(rod="cable", displacement=sinew.Table(times=[0, 1], values=[0, PULL])),
}
moved: dict[str, list[dict[str, float]]] = {}
for axes, (name, drive) in zip(pictures, drives.items(), strict=True):
    moved[name] = []
    for radius in RADII:
        run = sinew.simulate(
            result.scene(SCENE),
            changes={
                "rods.cable.section.circle.radius": f"{radius} mm",
                "rods.cable.sections": 15,
                "actuators.pull": drive,
            },
            progress=False,
        )
        state = run.state()
        cable = state.snapshot().rods[0]
        way = np.diff(cable.points, axis=0)
        turned = np.degrees(np.arctan2(way[-1, 1], way[-1, 0]))
        start, end = run.output("tip")[0], state.output("tip")
        moved[name].append(
            {
                "tip": 1e3 * float(np.linalg.norm(end - start)),
                "turned": float(turned),
                "force": float(run.signals["pull.force"][-1]),
                "pulled": 1e3 * float(run.signals["pull.displacement"][-1]),
            }
        )
        x = 1e3 * cable.points
        axes.plot(x[:, 0], x[:, 1], lw=1.0 + radius, label=f"{radius} mm")
    axes.set(xlabel="x [mm]", ylabel="y [mm]", title=f"the same {name}", aspect="equal")
    axes.legend(title="radius", fontsize=8)
    result.say(f"The same {name}:")
    result.table(
        ["radius [mm]", "E I of the cable [N mm2]", "tip moves [mm]", "cable's end turned [deg]", "force [N]", "pulled [mm]"],
        [
            [r, f"{5e9 * np.pi / 4 * (1e-3 * r) ** 4 * 1e6:.0f}", f"{m['tip']:.2f}", f"{m['turned']:.1f}", f"{m['force']:.2f}", f"{m['pulled']:.2f}"]
            for r, m in zip(RADII, moved[name], strict=True)
        ],
    )
result.picture(figure, "radius.png", "Cables of 0.5 to 3 mm pulled by the same force and by the same length")

by_force, by_pull = moved.values()
result.check(f"{FORCE}: a cable of 3 mm turns, beside one of 0.5 mm", by_force[-1]["turned"] / by_force[0]["turned"], most=0.2)
result.check("the same force: every thicker cable turns less", max(b["turned"] / a["turned"] for a, b in zip(by_force, by_force[1:])), most=1.0)
result.check(f"{PULL}: a cable of 3 mm turns, beside one of 0.5 mm", by_pull[-1]["turned"] / by_pull[0]["turned"], most=0.9)
result.check("the same pull: every thicker cable needs more force", min(b["force"] / a["force"] for a, b in zip(by_pull, by_pull[1:])), least=1.0)
result.finish()
