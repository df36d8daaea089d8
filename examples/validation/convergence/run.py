"""How fast errors of rods fall with sections, and with steps of time."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
from validation import ALL, BENDING, RAMP, Array, Result, Strains, shoot, stiffness, straight_rod

import sinew

result = Result(__file__, "How fast errors of rods fall")
SIX = np.array([0.8, 1.0, 1.5, 60.0, 25.0, 30.0])
FORCE = np.array([-0.6, 1.2, 0.9])


def tip(strains: Strains, order: int, sections: int) -> Array:
    scene = straight_rod(1.0, stiffness(*SIX), sections, strains, order, steps=2)
    scene.newton = sinew.Newton(tolerance=1e-13)
    scene.loads["force"] = sinew.RodLoad(rod="rod", force=FORCE.tolist(), factor=RAMP)
    return sinew.simulate(scene, progress=False).state().output("tip")


figure, (space, time) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
rows = []
for name, strains in {"torsion and bending": BENDING, "six strains": ALL}.items():
    exact = shoot(1.0, FORCE, SIX, strains is ALL)
    for order, counts, promised in [(0, [8, 16, 32], 2), (1, [8, 16, 32], 4), (2, [4, 8, 16], 6)]:
        errors = [float(np.linalg.norm(tip(strains, order, n) - exact)) for n in counts]
        power = float(np.log2(errors[1] / errors[2]))
        rows.append([name, order, ", ".join(map(str, counts)), ", ".join(f"{e:.1e}" for e in errors), f"{power:.2f}", promised])
        result.check(f"{name}, strains of order {order}: the error falls with the power", power, promised - 0.3, promised + 0.5)
        if strains is ALL:
            space.loglog(counts, errors, "o-", label=f"order {order}")
result.say(f"Without the engine the tip of the rod of six strains is at ({', '.join(f'{x:.9f}' for x in exact)}), a shift by {np.linalg.norm(exact - [1, 0, 0]):.2f} of its length.")
result.table(["rod", "order of strains", "sections", "errors of the tip / L", "power, last two", "promised"], rows)
space.set(xlabel="sections", ylabel="error of the tip / L", title="six strains, against shooting")
space.set_xscale("log", base=2)
space.legend()

# A stiff rod on a hinge is a pendulum, let go from horizontal: theta'' = 3 g / (2 L) cos theta.
L, G, END = 0.5, 9.81, 0.6


def swung(step: float) -> float:
    """How far it has turned down [rad]."""
    scene = straight_rod(L, sinew.Circle(radius=0.01), 1, base=["turn_z"], material=sinew.RodMaterial(young=1e11, poisson=0.3, density=1000))
    scene.analysis, scene.time, scene.gravity = "dynamic", sinew.Time(step=step, duration=END), [0, -G, 0]
    x, y, _ = sinew.simulate(scene, progress=False).state().output("tip")
    return float(np.arctan2(-y, x)) % (2 * np.pi)


inertia = L**2 / 3 + 0.01**2 / 4
state, h = np.zeros(2), END / 4000
for _ in range(4000):
    def slope(s: Array) -> Array:
        return np.array([s[1], G * L / 2 / inertia * np.cos(s[0])])

    a = slope(state)
    b = slope(state + h / 2 * a)
    c = slope(state + h / 2 * b)
    state = state + h / 6 * (a + 2 * b + 2 * c + slope(state + h * c))
steps = [4e-3, 2e-3, 1e-3, 5e-4]
angles = [swung(step) for step in steps]
off = np.abs(np.array(angles) - state[0])
time.loglog(np.array(steps) * 1e3, off, "o-")
time.set(xlabel="step [ms]", ylabel="error of the angle after 0.6 s [rad]", title="a pendulum")
time.set_xscale("log", base=2)
result.picture(figure, "convergence.png", "Errors against sections and against steps")
result.table(["step of the pendulum [ms]", "angle after 0.6 s [rad]", "error"], [[f"{1e3 * s:g}", f"{x:.6f}", f"{e:.1e}"] for s, x, e in zip(steps, angles, off, strict=True)])
result.check("pendulum: the error falls with the step to the power", float(np.log2(off[2] / off[3])), 0.8, 1.2)
result.compare("pendulum: extrapolated to a step of nothing", 2 * angles[3] - angles[2], float(state[0]), 1e-3, "rad", "Runge and Kutta's method: theta'' = m g L cos(theta) / (2 I)")
result.finish()
