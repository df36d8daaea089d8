"""A deep arch, clamped at one foot and hinged at the other, snaps under a weight at its apex."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import RAMP, Array, Result, Strains, path_length, stiffness, straight_rod

import sinew

result = Result(__file__, "A deep arch that snaps")
values = result.reference("deep_arch_buckling")
half = np.radians(215 / 2)
angles = half * np.linspace(1.0, -1.0, 401)
ARCH = np.stack([-100 * np.sin(angles), 100 * np.cos(angles), 0 * angles], axis=1)
LENGTH = path_length(ARCH)


def path_of(sections: int, order: int, strains: Strains) -> tuple[Array, Array, list[sinew.State]]:
    """Loads and how far the apex goes down along the path of equilibria, until the load has fallen for a while."""
    scene = straight_rod(LENGTH, stiffness(1e6, 1e6, 1e6, 1e9, 1e9, 1e9), sections, strains, order, path=ARCH.tolist(), up=[0, 0, 1])
    scene.analysis = "static"
    scene.couplings.append(sinew.Tie(rod="rod", along=["x", "y"]))
    scene.loads["weight"] = sinew.RodLoad(rod="rod", at=LENGTH / 2, force=[0, -1000, 0], factor=RAMP)
    scene.outputs["apex"] = sinew.Output(rod="rod", at=LENGTH / 2)
    model = sinew.build(scene)
    state = model.initial_state()
    states, loads = [state.copy()], [0.0]
    for _ in range(400):
        report = sinew.step(model, None, state)
        assert report.accepted, report.meaning
        states.append(state.copy())
        loads.append(1000 * state.time)
        if state.time >= 1 or loads[-1] < 0.97 * max(loads):
            break
    return np.array(loads), np.array([100 - own.output("apex")[1] for own in states]), states


found = {}
cuts: dict[str, tuple[int, int, Strains]] = {
    "40 sections, constant strain": (40, 0, ["bending_y"]),
    "10 sections, quadratic strain": (10, 2, ["bending_y"]),
    "40 sections that also stretch and shear": (40, 0, ["bending_y", "elongation", "shear_z"]),
}
for name, own in cuts.items():
    loads, down, states = path_of(*own)
    found[name] = float(loads.max())
figure, (way, shape) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
way.plot(down, loads)
way.axhline(values["P_cr"], color="black", ls=":", label="DaDeppo and Schmidt")
way.set(xlabel="the apex goes down", ylabel="weight")
way.legend()
for k in (0, int(np.argmax(loads)), -1):
    x = states[k].snapshot().rods[0].points
    shape.plot(x[:, 0], x[:, 1], label=f"{loads[k]:.0f}")
shape.set(aspect="equal", xlabel="x", ylabel="y")
shape.legend(title="weight")
result.picture(figure, "deep_arch.png", "Weight against the way of the apex, and the arch at rest, where it snaps and after")
for name, load in found.items():
    result.compare(f"weight at which it snaps, {name}", load, values["P_cr"], values["tolerance"], source="DaDeppo and Schmidt, J. Appl. Mech. 42, 1975")
result.finish()
