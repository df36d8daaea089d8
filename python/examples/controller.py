"""A controller in Python: at every step it looks where the tip is and tells the motor what to do."""

from pathlib import Path

import sinew

examples = Path(__file__).resolve().parents[2] / "examples"
scene = sinew.Scene.from_file(examples / "finger.yaml")
scene.newton = 1  # one linearised step: faster than real time
assert scene.actuators is not None
scene.actuators = {"pull": sinew.Actuator(rod="cable", displacement="external")}

model = sinew.build(scene)
state = model.initial_state()
wanted = 0.02  # [m] height of the tip
pulled = 0.0
for _ in range(300):
    error = wanted - state.output("tip")[2]
    pulled = min(max(pulled + 0.05 * error, 0.0), 0.02)  # integrates, within what the motor can do
    report = sinew.step(model, {"pull": pulled}, state)
    assert report.accepted, f"{report.status}: {report.meaning}"

print(f"tip at {1e3 * state.output('tip')[2]:.3f} mm, pulled {1e3 * pulled:.3f} mm with {state.forces[0]:.2f} N")
assert abs(state.output("tip")[2] - wanted) < 1e-4
