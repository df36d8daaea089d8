"""Loads at which straight rods lose their stability."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from collections.abc import Callable

import numpy as np
from validation import ALL, BENDING, RAMP, Axis, Result, Strains, stiffness, straight_rod

import sinew

result = Result(__file__, "Buckling: Euler's columns, Greenhill's shafts")
L, EI = 1.5, 2.0
TINY = 1e-6 * EI / L**2


def column(load: float, pinned: bool, strains: Strains) -> float:
    """How far a tiny force across moves a column under an axial load."""
    scene = straight_rod(L, stiffness(1.5, EI, EI, 1e7, 1e7, 1e7), 24, strains, steps=4)
    place = L / 2 if pinned else L
    scene.loads["axial"] = sinew.RodLoad(rod="rod", force=[-load, 0, 0], factor=RAMP)
    scene.loads["across"] = sinew.RodLoad(rod="rod", at=place, force=[0, TINY, 0], factor=RAMP)
    if pinned:
        scene.rods["rod"].base = ["turn_y", "turn_z"]
        scene.couplings.append(sinew.Tie(rod="rod", along=["y", "z"]))
    scene.outputs["place"] = sinew.Output(rod="rod", at=place)
    return float(sinew.simulate(scene, progress=False).state().output("place")[1])


def shaft(load: float, ends: str) -> float:
    """The same of a shaft under end moments of fixed direction."""
    scene = straight_rod(L, stiffness(40 * EI, EI, EI, 1e7, 1e7, 1e7), 32, ALL, steps=4)
    scene.loads["across"] = sinew.RodLoad(rod="rod", at=L / 2, force=[0, TINY, 0], factor=RAMP)
    held: dict[str, list[Axis] | None] = {"pins": ["x"], "clamps": ["x", "y", "z"], "joint": None}
    scene.couplings.append(sinew.Tie(rod="rod", along=["y", "z"], about=held[ends]))
    if ends == "clamps":
        scene.actuators["turn"] = sinew.Actuator(rod="rod", angle=sinew.Table(times=[0, 1], values=[0, load * L / (40 * EI)]))
    else:
        scene.rods["rod"].base = ["turn_x", "turn_y", "turn_z"] if ends == "pins" else ["turn_y", "turn_z"]
        scene.loads["twist"] = sinew.RodLoad(rod="rod", moment=[load, 0, 0], factor=RAMP)
        if ends == "pins":
            scene.loads["back"] = sinew.RodLoad(rod="rod", at=0, moment=[-load, 0, 0], factor=RAMP)
    scene.outputs["place"] = sinew.Output(rod="rod", at=L / 2)
    return float(sinew.simulate(scene, progress=False).state().output("place")[1])


def critical(moved: Callable[[float], float], guess: float) -> float:
    """Where 1 / w falls to zero, by secants from below."""
    a, b = 0.72 * guess, 0.81 * guess
    ya, yb = 1 / moved(a), 1 / moved(b)
    for _ in range(8):
        following = b - yb * (b - a) / (yb - ya)
        if abs(following - b) < 1e-3 * b:
            return following
        a, ya, b = b, yb, b + 0.7 * (following - b)
        yb = 1 / moved(b)
    return b


def root(of: Callable[[float], float], low: float, high: float) -> float:
    for _ in range(100):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if of(low) * of(middle) > 0 else (low, middle)
    return low


clamps = 2 * root(lambda x: float(np.sin(x) - x * np.cos(x)), 3.2, 4.7)
joint = 2 * root(lambda x: float(np.sin(x) + x * np.cos(x)), 1.6, 3.1)
euler, greenhill = "Euler: closed form", "Greenhill 1883: closed form"
for what, moved, factor, source in [
    ("column clamped at one end: F L^2 / (E I)", lambda F: column(F, False, BENDING), np.pi**2 / 4, euler),
    ("the same, of a rod that stretches and shears", lambda F: column(F, False, ALL), np.pi**2 / 4, euler),
    ("column on two pins: F L^2 / (E I)", lambda F: column(F, True, BENDING), np.pi**2, euler),
    ("the same, of a rod that stretches and shears", lambda F: column(F, True, ALL), np.pi**2, euler),
    ("shaft on two pins: M L / (E I)", lambda M: shaft(M, "pins"), 2 * np.pi, greenhill),
    ("shaft between clamps: M L / (E I)", lambda M: shaft(M, "clamps"), clamps, greenhill),
    ("shaft on a universal joint: M L / (E I)", lambda M: shaft(M, "joint"), joint, "the same equations, joint's reaction leaning with it"),
]:
    unit = EI / L**2 if "F" in what or "column" in what or "the same" in what else EI / L
    result.compare(what, critical(moved, 0.9 * factor * unit) / unit, factor, 1e-2, source=source)
below, beyond = (column(part * np.pi**2 * EI / L**2, True, BENDING) / column(0.0, True, BENDING) for part in (0.99, 1.01))
result.check("on pins, 1 % below the load: the response to a tiny force over that without load", below, 50, 200)
result.check("1 % beyond: it has changed its sign, or is without bound: 1 / response", 1 / beyond, most=1e-4)
result.finish()
