"""The inverse problem, live: the target moves while the robot follows it, within what its motors can do."""

from pathlib import Path

import numpy as np

import sinew

examples = Path(__file__).resolve().parents[2] / "examples"
model = sinew.build(examples / "reach.yaml")
state = model.initial_state()
farthest = 0.0
for k in range(300):
    time = k * model.time_step
    aside = 0.02 * min(time, 1.0)
    target = [aside * np.cos(time), aside * np.sin(time), 0.195]
    report = sinew.step(model, None, state, targets={"tip": target})
    assert report.accepted, report.meaning
    if time > 0.2:
        farthest = max(farthest, float(np.linalg.norm(state.output("tip")[:2] - target[:2])))

pulls = ", ".join(f"{name} {force:.2f} N" for name, force in zip(model.actuators, state.forces, strict=True))
print(f"at most {1e6 * farthest:.2g} micrometres off; at the end {pulls}")
assert farthest < 1e-4
assert (state.forces > -1e-9).all()  # cables only pull

# How the cables move the tip here, and how well in each direction.
told = sinew.jacobian(model, state)
best, *_, worst = sinew.manipulability(told.effectors[:2]).gains
print(f"a newton more moves the tip by {1e3 * worst:.3f} to {1e3 * best:.3f} mm in a step")
assert best > worst > 0
