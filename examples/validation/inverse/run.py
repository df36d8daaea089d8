"""Jacobians against differences, and the inverse problem against the direct one."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import EXTENSIBLE, ROOT, Array, Result

import sinew

result = Result(__file__, "Jacobians and the inverse problem")

# A rod with three tendons.
rod = sinew.Rod(path=[[0, 0, 0], [0, 0, 0.2]], sections=4, order=1, strains=EXTENSIBLE, section=sinew.Circle(radius="8 mm"),
                material=sinew.RodMaterial(young="0.5 MPa", poisson=0.45, density=1100))
arm = sinew.Scene(
    analysis="quasi_static", time=sinew.Time(step="10 ms", duration=1), gravity=[9.81, 0, 0], rods={"arm": rod}, newton=sinew.Newton(tolerance=1e-12),
    actuators={f"tendon{k}": sinew.Actuator(rod="arm", tendon=sinew.Tendon(distance="6 mm", angle=2 * np.pi * k / 3), tension="inverse", limits=sinew.Limits(force=[0, 8])) for k in range(3)},
    outputs={"tip": sinew.Output(rod="arm", at="0.2 m")}, targets={"tip": sinew.Target(at=[0, 0, 0.2], tolerance="0.001 mm")},
)
# The example's trunk with four cables that slide in it.
trunk = sinew.build(ROOT / "examples" / "reach.yaml", changes={"analysis": "quasi_static", "newton": "converged"})


def rest(model: sinew.Model, forces: Array, start: sinew.State | None = None) -> sinew.State:
    """Equilibrium under these forces."""
    state = start.copy() if start else model.initial_state()
    for part in [1.0] if start else [0.25, 0.5, 0.75, 1.0]:
        report = sinew.step(model, (part * forces).tolist(), state)
        assert report.accepted, report.meaning
    return state


def by_differences(model: sinew.Model, forces: Array, state: sinew.State, h: float) -> Array:
    columns = []
    for k in range(len(forces)):
        d = h * np.eye(len(forces))[k]
        columns.append((rest(model, forces + d, state).output("tip") - rest(model, forces - d, state).output("tip")) / (2 * h))
    return np.asarray(np.array(columns).T)


for name, model, forces in [
    ("rod with three tendons", sinew.build(arm), np.array([2.0, 1.0, 0.5])),
    ("trunk with four cables", trunk, np.array([1.5, 0.8, 0.2, 0.5])),
]:
    state = rest(model, forces)
    ours, right = sinew.jacobian(model, state, of="equilibrium").effectors, by_differences(model, forces, state, 1e-3)
    result.say(f"The {name}, at rest under {', '.join(f'{f:g}' for f in forces)} N: d tip / d force [mm/N] by Sinew, and by differences of equilibria.")
    result.table(["", *[f"force {k + 1}" for k in range(len(forces))], *[f"differences {k + 1}" for k in range(len(forces))]],
                 [["xyz"[i], *[f"{1e3 * x:.5f}" for x in ours[i]], *[f"{1e3 * x:.5f}" for x in right[i]]] for i in range(len(ours))])
    result.compare_all(f"{name}: Jacobian of the equilibrium", ours, right[: len(ours)], 1e-3, "m/N", "central differences of equilibria", of=float(np.abs(right).max()))

# From forces to the tip, and from the tip to forces.
model = sinew.build(arm)
told, found, off = [], [], []
direct, seeking = model.initial_state(), model.initial_state()
for k in range(1, 41):
    a = 2 * np.pi * k / 40
    forces = np.array([1.5 + np.sin(a), 1.2 + 0.8 * np.cos(a), 1.0 - 0.7 * np.sin(2 * a)]) * min(1.0, k / 8)
    report = sinew.step(model, forces.tolist(), direct)
    assert report.accepted, report.meaning
    report = sinew.step(model, None, seeking, targets={"tip": direct.output("tip")})
    assert report.accepted, report.meaning
    told.append(forces)
    found.append(seeking.forces)
    off.append(float(np.linalg.norm(seeking.output("tip") - direct.output("tip"))))
figure, axes = plt.subplots(figsize=(6, 3.5), layout="constrained")
axes.plot(np.array(told), "k:")
axes.plot(np.array(found))
axes.set(xlabel="step", ylabel="tension [N]", title="told (dotted) and found from the tip")
result.picture(figure, "inverse.png", "Tensions that made the path of the tip, and those found from it")
result.compare_all("rod: forces found from the tip that these forces made", found, told, 1e-3, "N", "the direct problem", of=2.5)
result.check("the tip is off its target by", 1e3 * max(off), most=1e-3, unit="mm")
result.finish()
