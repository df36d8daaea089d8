"""Friction around a bend: a rope on a drum, a cable in its channel."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import EXTENSIBLE, Array, Result, block, path_length

import sinew

result = Result(__file__, "Friction around a bend")
values = result.reference("capstan")
DRUM, ROPE, MU = 0.05, 1e-3, 0.3
FORCE = 1.0


def half_turn(radius: float, parts: int, begin: list[float], end: list[float], turned: list[int]) -> Array:
    """A path with half a turn in it."""
    angles = np.linspace(0, np.pi, parts + 1)
    round_, axis = radius * np.array([-np.cos(angles), np.sin(angles)]), np.zeros((parts + 1, 3))
    axis[:, turned] = round_.T
    path = np.vstack([begin, axis, end])
    return path


def drawn_over_drum(mu: float) -> float:
    """The force at the base that draws a rope with a weight at its end over half a drum."""
    axis = DRUM + ROPE
    path = half_turn(axis, 30, [-axis, 0, -0.04], [axis, 0, -0.04], [0, 2])
    length = path_length(path)
    ends = np.concatenate([np.linspace(0, 0.04, 9), 0.04 + (length - 0.08) * np.arange(1, 31) / 30, length - 0.04 + np.linspace(0, 0.04, 9)[1:]])
    rope = sinew.Rod(path=path.tolist(), sections=ends.tolist(), section=sinew.Circle(radius=ROPE), rest="path", start="path", strains=EXTENSIBLE,
                     material=sinew.RodMaterial(young=3e7, poisson=0.4, density=1000, viscosity=300))
    scene = sinew.Scene(
        time=sinew.Time(step=0.005, duration=0.4), rods={"rope": rope}, contact=sinew.Contact(friction=mu),
        obstacles={"drum": sinew.Obstacle(cylinder=sinew.CylinderShape(radius=DRUM, length=0.1), pose=sinew.Pose(rotate=[np.pi / 2, 0, 0]))},
        actuators={"draw": sinew.Actuator(rod="rope", displacement=sinew.Table(times=[0.1, 0.4], values=[0, 0.012]))},
        loads={"weight": sinew.RodLoad(rod="rope", force=[0, 0, -FORCE], factor=sinew.Table(times=[0, 0.1], values=[0, 1]))},
    )
    return float(sinew.simulate(scene, progress=False).state().forces[0])


def drawn_through_channel(mu: float, pull: float) -> float:
    """The same through a channel with half a turn in a block; `pull` < 0 lets it go back."""
    straight, radius = 0.04, 0.02
    path = half_turn(radius, 24, [-0.01, 0.01, 0.005], [-0.01, 0.05, 0.005], [1, 0])
    path[1:-1] += [0.03, 0.03, 0.005]
    length = path_length(path)
    points = straight + (length - 2 * straight) * np.arange(25) / 24
    mesh = block((12, 12, 2), lambda x: x * [0.06, 0.06, 0.01], "tet4")
    scene = sinew.Scene(
        time=sinew.Time(step=0.01, duration=0.24),
        solids={"block": sinew.Solid(mesh=mesh, material=sinew.SolidMaterial(young=1e8, poisson=0.3), density=1000, fixed=sinew.Held(box=[[-1, -1, -1], [1, 1, 0.001]]))},
        rods={"rod": sinew.Rod(path=path.tolist(), sections=112, section=sinew.Circle(radius=0.25e-3),
                               material=sinew.RodMaterial(young=1e7, poisson=0.4, density=1100, viscosity=100))},
        couplings=[sinew.Slide(rod="rod", solid="block", points=points.tolist(), anchor_tip="none", friction=mu)],
        actuators={"draw": sinew.Actuator(rod="rod", displacement=sinew.Table(times=[0.05, 0.25], values=[0, pull]))},
        loads={"weight": sinew.RodLoad(rod="rod", force=[-FORCE, 0, 0], factor=sinew.Table(times=[0, 0.05], values=[0, 1]))},
    )
    return float(sinew.simulate(scene, progress=False).state().forces[0])


drum = drawn_over_drum(MU)
frictions = [0.0, 0.1, 0.3, 0.6]
out = [drawn_through_channel(mu, 0.004) / FORCE for mu in frictions]
back = [drawn_through_channel(mu, -0.004) / FORCE for mu in frictions]
law: Array = np.exp(np.pi * np.array(frictions))
result.table(["friction", "drawn out of its channel: T2 / T1", "let back in", "exp(mu pi)", "exp(-mu pi)"],
             [[m, f"{a:.4f}", f"{b:.4f}", f"{c:.4f}", f"{1 / c:.4f}"] for m, a, b, c in zip(frictions, out, back, law, strict=True)])
figure, axes = plt.subplots(figsize=(5.5, 3.5), layout="constrained")
fine = np.linspace(0, 0.6, 50)
axes.semilogy(fine, np.exp(np.pi * fine), "C0", label="exp(mu pi)")
axes.semilogy(fine, np.exp(-np.pi * fine), "C1", label="exp(-mu pi)")
axes.semilogy(frictions, out, "oC0", label="channel, drawn out")
axes.semilogy(frictions, back, "oC1", label="channel, let back")
axes.semilogy([MU], [drum / FORCE], "s", color="black", label="rope on a drum")
axes.set(xlabel="friction", ylabel="tension over that at the other end")
axes.legend()
result.picture(figure, "capstan.png", "Ratio of tensions against friction, on the capstan law")
source, tolerance = "Euler and Eytelwein: " + values["what"], values["tolerance"]
result.compare("rope over half a drum: T2 / T1", drum / FORCE, values["ratio"], tolerance, source=source)
thick = float(np.exp(MU * np.pi * DRUM / (DRUM + ROPE)))
result.compare("the same, its thickness counted: exp(mu pi R / (R + r))", drum / FORCE, thick, 7e-3, source="closed form: moments about the drum's axis")
result.compare_all("cable drawn out of half a turn of channel: T2 / T1", out, law, tolerance, source="capstan law: exp(mu pi)")
result.compare_all("cable let back in", back, 1 / law, tolerance, source="capstan law: exp(-mu pi)")
result.finish()
