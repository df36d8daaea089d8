"""What a step costs in Python beyond the engine's own time.

    python3 bench/python_overhead.py [SCENE] [STEPS]

Each step is timed from outside, and its report tells the engine's own time; the difference is Python's: the call, the
command, the report. Medians of all steps, the finger of examples/ with `newton: 1` if no scene is given.
"""

import statistics
import sys
import time
from pathlib import Path

import sinew

scene = sys.argv[1] if len(sys.argv) > 1 else Path(__file__).parents[1] / "examples" / "finger.yaml"
steps = int(sys.argv[2]) if len(sys.argv) > 2 else 2000
model = sinew.build(scene, {"newton": 1})
name = model.actuators[0]


def measure(commanded: bool, full: bool) -> tuple[float, float]:
    """Median seconds of a step as seen from outside, and of what is not the engine's."""
    state = model.initial_state()
    whole, beyond = [], []
    for k in range(steps):
        command = {name: 1e-3 * min(k / 200, 1.0)} if commanded else None
        begin = time.perf_counter()
        report = sinew.step(model, command, state, full=full)
        spent = time.perf_counter() - begin
        whole.append(spent)
        beyond.append(spent - report.times["step"])
    return statistics.median(whole), statistics.median(beyond)


print(f"{scene}, {steps} steps; medians in microseconds")
print(f"{'':34}{'step':>10}{'beyond the engine':>20}")
for commanded in (False, True):
    for full in (True, False):
        whole, beyond = measure(commanded, full)
        what = f"command {'given' if commanded else 'of the scene'}, {'full' if full else 'motion only'}"
        print(f"{what:34}{1e6 * whole:10.1f}{1e6 * beyond:20.1f}")
