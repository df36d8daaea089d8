"""The tendon-driven rod that rod codes publish times for."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import time

import matplotlib.pyplot as plt
import numpy as np
from validation import EXTENSIBLE, Array, Result

import sinew

result = Result(__file__, "Three seconds of a rod with two tendons: what it costs")
values = result.reference("peer_timing_rods")


def arm(step: float, duration: float, analysis: str = "dynamic") -> sinew.Scene:
    rod = sinew.Rod(path=[[0, 0, 0], [0.6, 0, 0]], sections=2, strains=EXTENSIBLE, order=1, section=sinew.Circle(radius=0.03),
                    material=sinew.RodMaterial(young=1e6, poisson=0.5, density=1000, viscosity=1e4))
    tendons = {name: sinew.Actuator(rod="arm", tendon=sinew.Tendon(distance=0.02, angle=angle), tension=1) for name, angle in [("side", 0.0), ("top", np.pi / 2)]}
    return sinew.Scene(analysis=analysis, time=sinew.Time(step=step, duration=duration), gravity=[0, 0, -9.81], rods={"arm": rod}, actuators=tendons,  # type: ignore[arg-type]
                       outputs={"tip": sinew.Output(rod="arm", at=0.6)})


def timed(step: float) -> tuple[float, float, Array, Array]:
    """Seconds of the processor and of the clock that 3 s of motion take, and the tip over time."""
    model = sinew.build(arm(step, 3.0))
    state, count = model.initial_state(), round(3.0 / step)
    tips, keep = [], max(1, round(0.01 / step))
    begin, used = time.perf_counter(), time.process_time()
    for k in range(count):
        report = sinew.step(model, None, state)
        if not report.accepted:
            raise RuntimeError(report.meaning)
        if (k + 1) % keep == 0:
            tips.append(state.output("tip"))
    return time.process_time() - used, time.perf_counter() - begin, np.array(tips), np.linspace(0.01, 3, len(tips))


figure, axes = plt.subplots(figsize=(6, 3.5), layout="constrained")
theirs = dict(zip(["SoRoSim", "SoRoMoX"], values["tendons"], strict=True))
rows, ends = [], {}
for step in (1e-4, 1e-3, 5e-3):
    used, seconds, tips, at = timed(step)
    ends[step] = tips
    rows.append([f"{1e3 * step:g}", round(3 / step), f"{used:.2f}", f"{seconds:.2f}", f"{1e6 * used / (3 / step):.0f}", ", ".join(f"{x:.5f}" for x in tips[-1])])
    axes.plot(at, 1e3 * tips[:, 2], label=f"{1e3 * step:g} ms")
    for name, published in theirs.items():
        if step == 1e-4:
            result.tell(f"3 s of motion in steps of 0.1 ms, processor time, beside {name}", used, published, "s", "published, on a Core Ultra 7 165H")
axes.set(xlabel="time [s]", ylabel="height of the tip [mm]")
axes.legend(title="step")
result.table(["step [ms]", "steps", "processor time [s]", "by the clock [s]", "us a step", "tip at 3 s [m]"], rows)
result.picture(figure, "peer_timing.png", "Height of the tip over time, three steps")

coarse, middle, fine = (sinew.simulate(arm(step, 0.2), progress=False).state().output("tip") for step in (4e-3, 2e-3, 1e-3))
result.check("tip after 0.2 s: halving the step halves what is left (4, 2, 1 ms)", float(np.linalg.norm(coarse - middle) / np.linalg.norm(middle - fine)), 1.7, 2.3)
still = sinew.simulate(arm(1, 1, "static"), progress=False).state().output("tip")
settled = sinew.simulate(arm(5e-3, 20), progress=False).state().output("tip")
result.check("after 20 s it is where it is at rest", 1e3 * float(np.linalg.norm(settled - still)), most=0.1, unit="mm")
result.finish()
