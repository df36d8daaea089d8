"""A finger bent by its cable, and its tip over time: the shortest way from a scene to a picture."""

from pathlib import Path

import matplotlib.pyplot as plt

import sinew
from sinew import plot

examples = Path(__file__).resolve().parents[2] / "examples"

run = sinew.simulate(examples / "finger.yaml")
figure = plt.figure(figsize=(10, 4), layout="constrained")
plot.signals(run, ["tip"], figure.add_subplot(1, 2, 1))
plot.shape(run.state(), figure.add_subplot(1, 2, 2, projection="3d"))
figure.savefig("finger.png", dpi=150)

assert run.signals["pull.displacement"][-1] == 0.01  # what it was told
assert run.signals["tip.z"][-1] > 0.03  # it bends up, to the side of the cable
assert abs(run.signals["energy.kinetic"][-1]) < 1e-9  # and has come to rest
