"""End moments roll a straight rod up and unroll a ring."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import ALL, RAMP, Result, path_length, stiffness, straight_rod

import sinew

result = Result(__file__, "End moments: a rod rolled up, a ring unrolled")
roll, ring = result.reference("roll_up"), result.reference("unrolling_ring")
EI = 3.0


def rolled(sections: int, order: int, turns: int = 1, analysis: str = "quasi_static") -> sinew.State:
    scene = straight_rod(1.0, stiffness(0.7, EI, EI, 1, 1, 1), sections, order=order, steps=8)
    scene.analysis = analysis  # type: ignore[assignment]
    scene.loads["moment"] = sinew.RodLoad(rod="rod", moment=[0, 0, 2 * np.pi * turns * EI], factor=RAMP)
    scene.outputs["middle"] = sinew.Output(rod="rod", at=0.5)
    return sinew.simulate(scene, progress=False).state()


def unrolled(sections: int, by_path: bool, moment: float) -> tuple[sinew.State, sinew.State]:
    """At the start and at the end."""
    radius = 10.0 / (2.0 * np.pi)
    angles = np.linspace(0.0, 2.0 * np.pi, 401)
    path = np.stack([radius * np.sin(angles), radius * (1.0 - np.cos(angles)), 0 * angles], axis=1)
    shape = {"path": path.tolist()} if by_path else {"rest": sinew.StrainTable(bending_z=1.0 / radius)}
    length = path_length(path) if by_path else 10.0
    scene = straight_rod(length, stiffness(100, 100, 100, 1200, 500, 500), sections, ALL, steps=8, **{"path": [[0, 0, 0], [10, 0, 0]], **shape})
    scene.loads["moment"] = sinew.RodLoad(rod="rod", moment=[0, 0, -moment], factor=RAMP)
    scene.outputs["turn"] = sinew.Output(rod="rod", at=length, quantity="orientation")
    run = sinew.simulate(scene, progress=False)
    return run.state(0), run.state()


rows, worst = [], 0.0
figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
for sections, order in [(1, 0), (7, 0), (1, 2), (4, 1)]:
    state = rolled(sections, order)
    off, middle = float(np.linalg.norm(state.output("tip"))), float(np.linalg.norm(state.output("middle") - [0, 1 / np.pi, 0]))
    worst = max(worst, off, middle)
    rows.append([sections, order, f"{off:.1e}", f"{middle:.1e}"])
x = rolled(7, 0).snapshot().rods[0].points
left.plot(x[:, 0], x[:, 1])
left.set(title="M = 2 pi E I / L", xlabel="x / L", ylabel="y / L", aspect="equal")
result.say("A rod of unit length, rolled up by M = 2 π E I / L:")
result.table(["sections", "order of strains", "tip off the base / L", "middle off the circle / L"], rows)

moved, turned = [], []
for sections, by_path in [(1, False), (9, False), (20, True)]:
    start, half = unrolled(sections, by_path, 10 * np.pi)
    moved.append((half.output("tip") - start.output("tip"))[:2])
    turned.append(half.output("turn")[2] if half.output("turn")[2] < 0 else -half.output("turn")[2])
    _, line = unrolled(sections, by_path, 20 * np.pi)
for label, state in {"at rest": start, "10 pi": half, "20 pi": line}.items():
    x = state.snapshot().rods[0].points
    right.plot(x[:, 0], x[:, 1], label=label)
right.set(title="a cut ring, opened by end moments", xlabel="x", ylabel="y", aspect="equal")
right.legend()
result.picture(figure, "circle.png", "The rod rolled up and the ring as it is unrolled")

result.check("rolled up, 1 to 7 sections: distances from the circle, over L", worst, most=roll["tolerance"])
result.check("rolled up ten times by load steps of one section, over L", float(np.linalg.norm(rolled(1, 0, 10, "static").output("tip"))), most=1e-9)
source, tolerance = ring["source"], ring["tolerance"]
result.compare_all("ring opened by 10 pi: the tip moves across", [own[1] for own in moved], [ring["displacement_u_v"]] * 3, tolerance, source=source)
result.compare_all("ring opened by 10 pi: the tip moves along", [own[0] for own in moved], [ring["displacement_u_h"]] * 3, tolerance, source=source, of=6.366)
result.compare_all("ring opened by 10 pi: the tip turns", turned, [ring["rotation"]] * 3, tolerance, "rad", source)
result.compare("ring opened by 20 pi: its end along x", float(line.output("tip")[0]), 10.0, tolerance, source="closed form: a straight line of its length")
result.finish()
