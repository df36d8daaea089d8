"""Variations of scenes that once ended `converged` and wrong (tests/validation/faults), each beside what is right."""

from __future__ import annotations

import copy
import math
import random
from functools import lru_cache
from typing import Any

import yaml

from .scene import ROOT, Case, Judge, Maker, Row, Scene, Vec, at, circle, judge_program, norm, run, shape_of, sub
from .throws import judge_rod_peg, rod_points

FOLDER = ROOT / "tests/validation/faults"
FULL = ["torsion", "bending_y", "bending_z", "elongation", "shear_y", "shear_z"]


@lru_cache(maxsize=None)
def text_of(name: str) -> str:
    return (FOLDER / f"{name}.yaml").read_text()


def fault(name: str) -> Scene:
    scene: Scene = yaml.safe_load(text_of(name))
    for solid in scene.get("solids", {}).values():
        solid["mesh"] = str((FOLDER / solid["mesh"]).resolve())
    scene["view"] = {"interval": 1000}
    return scene


def codes(report: Any) -> set[str]:
    return {own["code"] for own in report["warnings"]}


def end_of(report: Any) -> str:
    """ "done", or the status with which a run stopped, and why."""
    end = report["end"]
    return "done" if end["how"] == "done" else f"{end.get('status', end['how'])} {end.get('where', '')}"


def second(scene: Scene) -> tuple[list[Row], Any]:
    """Rows and report of another scene."""
    verdict = run(Case("second", 0, scene), judge_program())
    return verdict.rows, verdict.report


# Constraints that depend on each other.


def tendons(random_: random.Random) -> tuple[Scene, Judge]:
    """Opposite tendons told opposite lengths, or such that they contradict each other."""
    length, radius = random_.uniform(0.1, 0.4), random_.uniform(4e-3, 12e-3)
    distance = radius * random_.uniform(0.3, 0.9)
    pairs = random_.randint(1, 3)
    gives = random_.random() < 0.3
    off = random_.choice([0.0, 0.0, 0.0, 0.3e-3])
    pulls = [distance * random_.uniform(-1, 1) for _ in range(pairs)]
    if pairs == 3:  # the third one's are those of the two others together
        pulls[2] = pulls[1] - pulls[0]
    analysis = random_.choice(["dynamic", "quasi_static", "static"])
    young = 10 ** random_.uniform(5.5, 7)
    scene: Scene = {
        "analysis": analysis, "time": {"step": 0.01, "duration": 0.3}, "view": {"interval": 1000},
        "rods": {"arm": {"path": [[0, 0, 0], [length, 0, 0]], "sections": random_.randint(1, 6), "order": random_.choice([0, 1]),
                         "strains": FULL[:4] if gives else FULL[:3], "section": {"circle": {"radius": radius}},
                         "material": {"young": young, "poisson": 0.5, "density": 1100, "damping": 0.02}}},
        "actuators": {}, "outputs": {"tip": {"rod": "arm", "at": 0.999 * length}}}
    for i, pull in enumerate(pulls):
        for side in (0, 1):
            told = (pull if side == 0 else -pull) + (off if i == 0 and side == 1 else 0.0)
            scene["actuators"][f"t{i}{side}"] = {
                "rod": "arm", "tendon": {"distance": distance, "angle": f"{60 * i + 180 * side} deg"},
                "displacement": {"times": [0, 0.2], "values": [0, told]}}

    def judge(rows: list[Row], report: Any) -> list[str]:
        end = end_of(report)
        if off and (not gives or pairs > 1):  # (with elongation both pairs say how much there is of it)
            if not end.startswith("inconsistent") or "actuators.t00" not in end:
                return [f"contradicting lengths end with {end}"]
            return []
        if end != "done":
            return [end]
        last = rows[-1]
        depends = not gives or pairs > 1
        if ("redundant_constraints" in codes(report)) != depends:
            return [f"told as redundant: {not depends}"]
        largest = max(abs(last[f"t{i}{side}.force"]) for i in range(pairs) for side in (0, 1))
        limit = 20 * young * circle(radius) / (length * distance)
        told = [f"{largest:.3g} N, more than {limit:.3g} N"] if largest > limit else []
        for i in range(0 if gives else pairs):  # the least that do the same are opposite
            both = last[f"t{i}0.force"] + last[f"t{i}1.force"]
            if abs(both) > 1e-6 * max(largest, 1e-9):
                told.append(f"forces of pair {i} add up to {both:.3g} N of {largest:.3g} N")
        return told

    return scene, judge


def welds(random_: random.Random) -> tuple[Scene, Judge]:
    """Rods without shear welded side by side at several places."""
    length, radius = random_.uniform(0.1, 0.3), random_.uniform(2e-3, 6e-3)
    count, at_once = random_.randint(2, 3), random_.randint(2, 4)
    young = 10 ** random_.uniform(5.5, 8)
    scene: Scene = {"time": {"step": 5e-3, "duration": 0.1}, "view": {"interval": 1000}, "rods": {}, "couplings": [],
                    "outputs": {"t": {"rod": "r1", "at": 0.999 * length}},
                    "loads": {"p": {"rod": "r1", "force": [0, 0, young * circle(radius) / length**2]}}}
    for i in range(count):
        y = 2.5 * radius * i
        scene["rods"][f"r{i}"] = {
            "path": [[0, y, 0], [length, y, 0]], "sections": at_once, "strains": FULL[:4],
            "section": {"circle": {"radius": radius}},
            "material": {"young": young, "poisson": 0.5, "density": 1000, "damping": 0.02}}
        if i > 0:
            for k in range(at_once):
                s = length * (k + 1) / at_once
                scene["couplings"].append({"tie": {"rod": f"r{i - 1}", "at": s, "other": f"r{i}", "other_at": s,
                                                   "about": ["x", "y", "z"]}})

    def judge(rows: list[Row], report: Any) -> list[str]:
        told = [own for own in report["warnings"] if own["code"] == "redundant_constraints"]
        if end_of(report) != "done":
            return [end_of(report)]
        if not told:
            return ["not told as redundant"]
        return [] if any("shear" in own["remedy"] for own in told) else ["the remedy does not name shear"]

    return scene, judge


def endwise(random_: random.Random) -> tuple[Scene, Judge]:
    """A rod that cannot stretch is fed straight into something."""
    length, radius = random_.uniform(0.05, 0.3), random_.uniform(0.5e-3, 4e-3)
    scene = fault("rod_endwise")
    gap = random_.uniform(2e-3, 20e-3)
    turn = random_.choice([0.0, random_.uniform(-3, 3)])
    way: Vec = (math.cos(turn), math.sin(turn), 0.0)
    scene["rods"]["r"].update(path=[[0, 0, 0], [length * u for u in way]], sections=random_.randint(1, 8),
                              strains=random_.choice([FULL[:3], FULL[1:3], FULL[:3] + FULL[4:]]),
                              section={"circle": {"radius": radius}})
    scene["time"]["step"] = random_.choice([1e-3, 5e-3, 1e-2])
    scene["frames"]["feed"]["motion"] = {"times": [0, 0.5], "translate": [[0, 0, 0], [2 * gap * u for u in way]]}
    if random_.random() < 0.5:
        ball = random_.uniform(5e-3, 30e-3)
        scene["obstacles"]["ball"] = {"sphere": {"radius": ball},
                                      "pose": {"translate": [(length + radius + gap + ball) * u for u in way]}}
    else:
        scene["obstacles"]["ball"] = {"plane": {"point": [(length + radius + gap) * u for u in way],
                                                "normal": [-u for u in way]}}
    scene["outputs"]["tip"]["at"] = length * (1 - 1e-9)

    def judge(rows: list[Row], report: Any) -> list[str]:
        end = end_of(report)
        if not end.startswith("inconsistent") or "elongation" not in end:
            return [f"ends with {end}"]
        return [f"{row['f.normal']:.3g} N" for row in rows if row["f.normal"] > 1e3][:1]

    return scene, judge


# Contact that was missed.


def hook(random_: random.Random) -> tuple[Scene, Judge]:
    """A frame starts to move a rod sideways at a peg."""
    scene = fault("contact_frame_moves")
    radius, peg = random_.uniform(0.5e-3, 2e-3), random_.uniform(1e-3, 4e-3)
    x, gap, way = random_.uniform(0.01, 0.04), random_.uniform(0.5e-3, 5e-3), random_.uniform(0.02, 0.12)
    h = random_.choice([1e-3, 2e-3, 5e-3, 1e-2])
    scene["time"]["step"] = h
    scene["rods"]["r"]["section"]["circle"]["radius"] = radius
    scene["frames"]["hand"]["motion"] = {"times": [0, 0.1], "translate": [[0, 0, 0], [0, way, 0]]}
    y = radius + peg + gap
    scene["obstacles"]["peg"] = {"cylinder": {"radius": peg, "length": 0.04}, "pose": {"translate": [x, y, 0]}}
    outputs, names = rod_points(0.06, 49)
    scene["outputs"] = {**outputs, "f": {"between": ["r", "peg"]}}
    axis: tuple[Vec, Vec] = ((x, y, -0.02), (x, y, 0.02))
    looks = judge_rod_peg(names, axis, lambda t: (0.0, 0.0, 0.0), peg + radius, 0.6 * min(radius, peg) + 1.5e-4)

    def judge(rows: list[Row], report: Any) -> list[str]:
        told = looks(rows, report)
        if end_of(report) == "done" and way > y + 0.01 and not any(row["f.contacts"] > 0 for row in rows):
            told.append("the rod never touches the peg")
        return told

    return scene, judge


def pushed(random_: random.Random) -> tuple[Scene, Judge]:
    """A light rod that slides along itself is pushed at a wall."""
    scene = fault("contact_rod_pushed")
    force, gap, radius = 10 ** random_.uniform(-1, 0.7), random_.uniform(1e-3, 0.03), random_.uniform(0.5e-3, 3e-3)
    h = random_.choice([1e-3, 2e-3, 5e-3, 1e-2, 2e-2])
    scene["time"] = {"step": h, "duration": 20 * h if h > 2e-3 else 0.1}
    scene["rods"]["r"].update(sections=random_.randint(1, 8), section={"circle": {"radius": radius}})
    scene["loads"]["push"]["force"] = [force, 0, 0]
    scene["obstacles"]["wall"]["plane"]["point"] = [0.1 + radius + gap, 0, 0]

    def judge(rows: list[Row], report: Any) -> list[str]:
        told = [f"{1e3 * (row['tip.x'] - 0.1 - gap):.3g} mm in the wall" for row in rows
                if row["tip.x"] - 0.1 - gap > 0.25 * 2 * radius][:1]
        if end_of(report) != "done":
            return told + [end_of(report)]
        if abs(rows[-1]["f.normal"] - force) > 1e-3 * force:
            told.append(f"{rows[-1]['f.normal']:.4g} N instead of {force:.4g} N")
        return told

    return scene, judge


def loop(random_: random.Random) -> tuple[Scene, Judge]:
    """A rubber loop around a peg is pulled by its two ends: it stays on the peg."""
    scene = fault("contact_loop_pulled")
    peg = random_.uniform(3e-3, 6e-3)
    h = random_.choice([2e-3, 5e-3, 1e-2])
    scene["time"] = {"step": h, "duration": 0.2}
    scene["rods"]["band"]["material"]["young"] = 10 ** random_.uniform(5.7, 6.7)
    scene["frames"]["left"]["motion"]["translate"] = [[0, 0, 0], [-random_.uniform(0.02, 0.08), 0, 0]]
    scene["obstacles"]["peg"]["cylinder"]["radius"] = peg
    scene["contact"] = {"friction": random_.choice([0, 0.3])}

    def judge(rows: list[Row], report: Any) -> list[str]:
        return [f"the loop is through the peg at t = {row['time']:.4g} s" for row in rows
                if row["mid.x"] < 0.022 + 0.5 * peg][:1]

    return scene, judge


def pin_rod(random_: random.Random, scene: Scene, pins: list[tuple[float, float, float]]) -> None:
    """Pins across the rod at x, z, with a radius."""
    for i, (x, z, radius) in enumerate(pins):
        scene["obstacles"][f"p{i}"] = {"cylinder": {"radius": radius, "length": 0.05},
                                       "pose": {"rotate": [math.pi / 2, 0, 0], "translate": [x, 0, z]}}
    scene["rods"]["rod"]["sections"] = random_.randint(60, 100)


def tunnel(random_: random.Random) -> tuple[Scene, Judge]:
    """At rest, a rod that is pressed against a pin."""
    scene = fault("tunnel")
    pin, x = random_.uniform(1e-3, 4e-3), random_.uniform(0.1, 0.3)
    z = 0.002 + pin + random_.choice([0.0, random_.uniform(0, 2e-3)])
    pin_rod(random_, scene, [(x, z, pin)])
    scene["time"]["step"] = random_.choice([0.02, 0.05, 0.1])
    scene["loads"]["p"]["force"] = [0, 0, random_.uniform(0.2, 1.2)]
    outputs, names = rod_points(0.45, 181, "rod")
    scene["outputs"] = {**outputs, "c0": {"between": ["rod", "p0"]}}
    axis: tuple[Vec, Vec] = ((x, -0.025, z), (x, 0.025, z))
    looks = judge_rod_peg(names, axis, lambda t: (0.0, 0.0, 0.0), pin + 0.002, 0.6 * min(pin, 0.002) + 1e-4)

    def judge(rows: list[Row], report: Any) -> list[str]:
        told = looks(rows, report)
        if end_of(report) == "done" and not rows[-1]["c0.normal"] > 0.0:
            told.append("the pin does not hold the rod")
        return told

    return scene, judge


def two_pins(random_: random.Random) -> tuple[Scene, Judge]:
    """A rod between two pins, without friction: the force along it at its base is P sin(theta) of its tip."""
    scene = fault("contact_two_pins")
    pins = [random_.uniform(1.5e-3, 4e-3) for _ in range(2)]
    x = random_.uniform(0.15, 0.25)
    pin_rod(random_, scene, [(x, 0.002 + pins[0], pins[0]), (x - random_.uniform(0.02, 0.06), -0.002 - pins[1], pins[1])])
    push = random_.uniform(0.2, 0.8)
    scene["analysis"] = random_.choice(["dynamic", "quasi_static"])
    scene["time"] = {"step": 0.01 if scene["analysis"] == "dynamic" else 0.05, "duration": 1.0}
    scene["loads"]["p"]["force"] = [0, 0, push]
    scene["outputs"] = {name: scene["outputs"][name] for name in ("turn", "basef")}

    def judge(rows: list[Row], report: Any) -> list[str]:
        if end_of(report) != "done":
            return []
        along = push * math.sin(-rows[-1]["turn.y"])
        if abs(rows[-1]["basef.x"] - along) > 0.02 * along:
            return [f"{rows[-1]['basef.x']:.4g} N along the rod, right is {along:.4g} N"]
        return []

    return scene, judge


def sleeve(random_: random.Random) -> tuple[Scene, Judge]:
    """A rod bent out of a slit between two flat faces: the force along it is P sin(theta) of its tip."""
    scene = fault("contact_sleeve")
    scene["rods"]["rod"]["sections"] = random_.choice([90, 180, 240, 270])  # (ripples where the edge is within a section)
    push, slit = random_.uniform(0.2, 0.9), 10 ** random_.uniform(-5, -4)
    scene["loads"]["p"]["force"] = [0, 0, push]
    for name, side in (("top", 1), ("bottom", -1)):
        scene["obstacles"][name]["pose"]["translate"] = [0.1, 0, side * (0.012 + slit)]
    scene["outputs"] = {"turn": scene["outputs"]["turn"]}

    def judge(rows: list[Row], report: Any) -> list[str]:
        if end_of(report) != "done":
            return []
        along, found = push * math.sin(abs(rows[-1]["turn.y"])), abs(rows[-1]["pull.force"])
        return [f"{found:.4g} N along the rod, right is {along:.4g} N"] if abs(found - along) > 0.02 * along else []

    return scene, judge


def beside_post(random_: random.Random) -> tuple[Scene, Judge]:
    """At rest a rod sags; what stands where it never comes changes nothing."""
    scene = fault("sag_beside_post")
    length, radius = random_.uniform(0.05, 0.15), random_.uniform(0.4e-3, 1.5e-3)
    scene["rods"]["rod"].update(path=[[0, 0, 0.15], [length, 0, 0.15]], sections=random_.randint(3, 12),
                                section={"circle": {"radius": radius}})
    scene["outputs"]["tip"]["at"] = length * (1 - 1e-9)
    scene["time"]["step"] = random_.choice([0.02, 0.05, 0.1, 0.25])
    scene["obstacles"]["post"]["pose"]["translate"] = [random_.uniform(-0.05, 0.1), -random_.uniform(0.02, 0.1), 0.1]
    alone = copy.deepcopy(scene)
    del alone["obstacles"]

    def judge(rows: list[Row], report: Any) -> list[str]:
        other, of_other = second(alone)
        if end_of(of_other) != "done" or "unstable" in codes(report) | codes(of_other):
            return []
        if end_of(report) != "done":
            return [end_of(report)]
        off = norm(sub(at(rows[-1], "tip"), at(other[-1], "tip")))
        return [f"the post moves the tip by {off:.3g} m"] if off > 1e-7 * length else []

    return scene, judge


# Contact that is not there, and overlaps that are.


def pass_by(random_: random.Random) -> tuple[Scene, Judge]:
    """A body that turns passes one that does not: nothing but inertia acts."""
    size = 10 ** random_.uniform(-2.5, -1.5)
    other, _, around = shape_of(random_, size)
    edges = [2 * size * random_.uniform(0.2, 1.5) for _ in range(3)]
    h, steps = random_.choice([1e-4, 1e-3, 5e-3]), 60

    def apart(p: Vec) -> float:
        return math.hypot(*(max(abs(x) - 0.5 * edge, 0.0) for x, edge in zip(p, edges)))

    while True:
        start: Vec = (6 * size * random_.uniform(-1, 1), 6 * size * random_.uniform(-1, 1), 6 * size * random_.uniform(-1, 1))
        end: Vec = (6 * size * random_.uniform(-1, 1), 6 * size * random_.uniform(-1, 1), 6 * size * random_.uniform(-1, 1))
        way = [tuple(a + (b - a) * i / 600 for a, b in zip(start, end)) for i in range(601)]
        least = min(apart((p[0], p[1], p[2])) for p in way)
        if around * 1.02 < least < 2 * around:
            break
    duration = h * steps
    scene: Scene = {
        "time": {"step": h, "duration": duration}, "view": {"interval": 1000},
        "bodies": {"a": {**other, "density": 1000, "pose": {"translate": list(start),
                                                            "rotate": [random_.uniform(-2, 2) for _ in range(3)]},
                         "velocity": [(b - a) / duration for a, b in zip(start, end)],
                         "spin": [random_.gauss(0, 2) / duration for _ in range(3)]},
                   "b": {"box": {"size": edges}, "density": 1000}},
        "outputs": {"a": {"body": "a"}, "b": {"body": "b"}}}

    def judge(rows: list[Row], report: Any) -> list[str]:
        if end_of(report) != "done":
            return [end_of(report)]
        told = []
        for row in rows:
            t = row["time"] / duration
            a = norm(sub(at(row, "a"), tuple(x + t * (y - x) for x, y in zip(start, end))))  # type: ignore[arg-type]
            if max(a, norm(at(row, "b"))) > 1e-7 * size:
                told.append(f"something pushes at t = {row['time']:.4g} s")
                break
        return told + [own["message"] for own in report["warnings"]]

    return scene, judge


def overlap(random_: random.Random) -> tuple[Scene, Judge]:
    """Two bodies of which the balls in them overlap."""
    size = 10 ** random_.uniform(-2.5, -1.5)
    shapes = [shape_of(random_, size) for _ in range(2)]
    inner = [0.5 * thin for _, thin, _ in shapes]
    away = [random_.gauss(0, 1) for _ in range(3)]
    far = sum(inner) * random_.uniform(0.3, 0.95)
    length = math.hypot(*away)
    places = [[0.0, 0.0, 0.0], [far * x / length for x in away]]
    scene: Scene = {
        "time": {"step": 5e-3, "duration": 0.05}, "view": {"interval": 1000},
        "bodies": {f"b{i}": {**shapes[i][0], "density": 1000,
                             "pose": {"translate": places[i], "rotate": [random_.uniform(-2, 2) for _ in range(3)]}}
                   for i in range(2)},
        "outputs": {"o": {"body": "b0"}}}

    def judge(rows: list[Row], report: Any) -> list[str]:
        for own in report["warnings"]:
            if own["code"] == "overlap_at_start":
                least = sum(inner) - far
                return [] if own["worst"] > 0.99 * least else [f"{own['value']:.3g} m told, at least {least:.3g} m"]
        return ["not told"]

    return scene, judge


# Energy from nowhere.


def total(row: Row) -> float:
    return row["energy.kinetic"] + row["energy.elastic"] + row["energy.weight"]


def spinning(random_: random.Random) -> tuple[Scene, Judge]:
    """A body that spins is thrown on a floor."""
    scene = fault("cylinder_gains")
    shape, thin, around = shape_of(random_, random_.uniform(0.01, 0.05))
    scene["time"] = {"step": random_.choice([2e-3, 5e-3, 1e-2, 2e-2]), "duration": 1.5}
    scene["contact"] = {"friction": random_.choice([0.0, 0.2, 0.5, 1.0])}
    scene["bodies"]["b"] = {**shape, "density": 10 ** random_.uniform(2, 4),
                            "pose": {"translate": [0, 0, around + random_.uniform(0, 0.05)],
                                     "rotate": [random_.uniform(-2, 2) for _ in range(3)]},
                            "spin": [random_.gauss(0, 10) for _ in range(3)]}

    def judge(rows: list[Row], report: Any) -> list[str]:
        if end_of(report) != "done":
            return []
        told = [own["message"] for own in report["warnings"] if own["code"] in ("energy_gain", "penetration")]
        lowest = math.inf
        for row in rows:
            if total(row) > lowest + 1e-3 * max(total(rows[0]), 1e-12):
                told.append(f"{total(row) - lowest:.3g} J from nowhere at t = {row['time']:.4g} s")
                break
            lowest = min(lowest, total(row))
        if rows[-1]["o.z"] < 0.5 * thin - 1e-3 * thin:
            told.append(f"it has sunk in to {rows[-1]['o.z']:.3g} m")
        return told

    return scene, judge


def struck(random_: random.Random) -> tuple[Scene, Judge]:
    """A rod falls on a cylinder: it never has more energy than it came with."""
    scene = fault("rod_impact_gain")
    turn = [random_.gauss(0, 1) for _ in range(3)]
    half = [random_.uniform(0.015, 0.04) * x / math.hypot(*turn) for x in turn]
    length = 2 * math.hypot(*half)
    scene["rods"]["r"].update(path=[[-half[0], -half[1], 0.06 - half[2]], [half[0], half[1], 0.06 + half[2]]],
                              sections=random_.randint(2, 8),
                              section={"circle": {"radius": length * random_.uniform(0.02, 0.06)}})
    scene["rods"]["r"]["material"]["young"] = 10 ** random_.uniform(5.5, 8)
    scene["obstacles"]["x"] = {"cylinder": {"radius": random_.uniform(3e-3, 1e-2), "length": random_.uniform(0.01, 0.04)},
                               "pose": {"rotate": [random_.uniform(-3, 3) for _ in range(3)]}}
    scene["time"]["step"] = random_.choice([5e-4, 1e-3, 2e-3, 5e-3])
    scene["contact"]["friction"] = random_.choice([0, 0.5])
    scene["outputs"]["p"]["at"] = 0.5 * length

    def judge(rows: list[Row], report: Any) -> list[str]:
        told = [own["message"] for own in report["warnings"] if own["code"] == "energy_gain"]
        most = max(row["energy.kinetic"] + row["energy.elastic"] for row in rows)
        lowest = math.inf
        for row in rows:
            if total(row) > lowest + 3e-3 * most:
                told.append(f"{total(row) - lowest:.3g} J from nowhere of {most:.3g} J at t = {row['time']:.4g} s")
                break
            lowest = min(lowest, total(row))
        return told

    return scene, judge


# Verdicts.


def tubes(random_: random.Random) -> tuple[Scene, Judge]:
    """Two tubes of rest curvature, one in the other: stable or not as their natural frequencies say."""
    scene = fault("false_unstable")
    scene["rods"]["outer"]["rest"]["bending_y"] = random_.uniform(-6, 6)
    scene["rods"]["inner"]["rest"]["bending_y"] = random_.uniform(-10, 10)
    scene["time"]["step"] = random_.choice([0.02, 0.05, 0.1])
    scene["couplings"] = scene["couplings"][:random_.randint(2, 4)]
    del scene["actuators"]

    def judge(rows: list[Row], report: Any) -> list[str]:
        modal = {key: value for key, value in scene.items() if key != "time"}
        other, of_other = second({**modal, "analysis": "modal", "modes": 3})
        if end_of(report) != "done" or end_of(of_other) != "done":
            return []
        if norm(sub(at(rows[-1], "tip"), at(other[0], "tip"))) > 1e-4:
            return []  # another equilibrium
        told, first = "unstable" in codes(report), other[1]["mode.frequency"]
        return [f"told as {'unstable' if told else 'stable'}, lowest frequency {first:.4g} Hz"] if told != (first < 0) else []

    return scene, judge


def curled(random_: random.Random) -> tuple[Scene, Judge]:
    """A rod that a moment curls many times: there always is an equilibrium."""
    scene = fault("path_limit")
    scene["rods"]["arm"]["material"]["young"] = 10 ** random_.uniform(3.8, 5)
    scene["rods"]["arm"]["sections"] = random_.randint(2, 12)
    scene["loads"]["t"]["moment"] = [0, random_.choice([-1, 1]) * 10 ** random_.uniform(-2, 0), 0]

    def judge(rows: list[Row], report: Any) -> list[str]:
        end = end_of(report)
        return [] if end == "done" or end.startswith("path_unfinished") else [end]

    return scene, judge


def one_linearisation(random_: random.Random) -> tuple[Scene, Judge]:
    """One long step by one linearisation, beside the same step converged."""
    scene = fault("long_step")
    h = random_.choice([0.1, 0.3, 1.0])
    scene["time"] = {"step": h, "duration": h}
    scene["solids"]["finger"]["material"]["young"] = 10 ** random_.uniform(5.3, 6.3)
    scene["actuators"]["pull"]["displacement"] = {"times": [0, h], "values": [0, random_.uniform(1e-3, 12e-3)]}

    def judge(rows: list[Row], report: Any) -> list[str]:
        other, of_other = second({**scene, "newton": {}})
        if end_of(report) != "done" or end_of(of_other) != "done":
            return []
        rest: Vec = (0.095, 0.0, 0.0)
        off = norm(sub(at(rows[-1], "tip"), at(other[-1], "tip"))) / norm(sub(at(other[-1], "tip"), rest))
        told = max((own["worst"] for own in report["warnings"] if own["code"] == "linearised_step_off"), default=0.0)
        if off > 0.07 and abs(told - off) > 0.05 + 0.3 * off:
            return [f"{100 * off:.3g} % off, told {100 * told:.3g} %"]
        return [f"{100 * off:.3g} % off, told {100 * told:.3g} %"] if off < 0.02 and told > 0.07 else []

    return scene, judge


def ripple(random_: random.Random) -> tuple[Scene, Judge]:
    """A bent rod slides out of a channel of points: ripples of its force are told where they are more than a tenth."""
    scene = fault("sleeve_ripple")
    rod = scene["rods"]["rod"]
    rod["sections"], rod["order"] = random_.choice([(35, 0), (70, 0), (105, 0), (140, 0), (280, 0), (70, 1), (140, 1), (70, 2)])
    push = random_.uniform(0.3, 0.8)
    scene["loads"]["p"]["force"] = [0, 0, push]
    scene["actuators"]["pull"]["displacement"]["values"] = [0, random_.uniform(0.012, 0.03)]

    def judge(rows: list[Row], report: Any) -> list[str]:
        if end_of(report) != "done":
            return [end_of(report)]
        most = max(abs(abs(row["base.x"] / (push * math.sin(row["turn.y"]))) - 1) for row in rows if row["time"] > 0.201)
        told = "sliding_force_ripples" in codes(report)
        return [f"ripples of {100 * most:.3g} %, told: {told}"] if told != (most > 0.1) and not 0.07 < most < 0.13 else []

    return scene, judge


def channel(random_: random.Random) -> tuple[Scene, Judge]:
    """Friction of a rod that bends in a channel of points grows with their number: that is told."""
    scene = fault("sleeve_friction")
    points = scene["couplings"][0]["slide"]["points"]
    every = random_.choice([1, 2, 4])
    scene["couplings"][0]["slide"]["points"] = points[::every]
    scene["couplings"][0]["slide"]["friction"] = random_.uniform(0.05, 0.4)
    scene["rods"]["rod"]["sections"] = 70
    scene["time"]["duration"] = 0.3
    scene["loads"]["p"]["factor"]["times"] = [0, 0.2]
    scene["actuators"]["pull"]["displacement"] = {"times": [0, 0.2, 0.3], "values": [0, 0, 0.001]}

    def judge(rows: list[Row], report: Any) -> list[str]:
        if end_of(report) != "done":
            return []
        told = [own for own in report["warnings"] if own["code"] == "friction_of_points"]
        return [] if told and f"({5 * every} mm)" in told[0]["message"] else ["not told"]

    return scene, judge


def pulled_far(random_: random.Random) -> tuple[Scene, Judge]:
    """The finger's cable is pulled a little, or so far that the finger passes through itself."""
    scene = fault("passes_through_itself")
    far = random_.random() < 0.5
    scene["solids"]["finger"]["material"]["young"] = 10 ** random_.uniform(5.5, 6.2)
    scene["time"] = {"step": 0.01, "duration": 1.2}
    pull = random_.uniform(0.055, 0.065) if far else random_.uniform(2e-3, 12e-3)
    scene["actuators"]["pull"]["displacement"]["values"] = [0, pull]

    def judge(rows: list[Row], report: Any) -> list[str]:
        if end_of(report) != "done":
            return []
        if far and "solid_crosses_itself" not in codes(report):
            return ["the finger passes through itself without a word"]
        return [own["message"] for own in report["warnings"]] if not far else []

    return scene, judge


def lifted(random_: random.Random) -> tuple[Scene, Judge]:
    """A frame lifts a rod, a tie or a floor with a body on it: its work is counted."""
    name = random_.choice(["frame_lifts_rod", "frame_lifts_tie", "frame_lifts_floor"])
    scene = fault(name)
    for _, frame in scene["frames"].items():
        frame["motion"]["translate"] = [[random_.uniform(0.3, 1.2) * _length(x) for x in u]
                                        for u in frame["motion"]["translate"]]

    def judge(rows: list[Row], report: Any) -> list[str]:
        if end_of(report) != "done":
            return []
        return [own["message"] for own in report["warnings"] if own["code"] == "energy_gain"]

    return scene, judge


def _length(value: Any) -> float:
    """Of a number, or a text such as `60 mm`."""
    if isinstance(value, (int, float)):
        return float(value)
    number, unit = value.split()
    return float(number) * {"mm": 1e-3, "cm": 1e-2, "m": 1.0}[unit]


FAULTS: dict[str, Maker] = {
    "tendons": tendons, "welds": welds, "endwise": endwise, "hook": hook, "pushed": pushed, "loop": loop, "tunnel": tunnel,
    "two_pins": two_pins, "sleeve": sleeve, "beside_post": beside_post, "pass_by": pass_by, "overlap": overlap,
    "spinning": spinning, "struck": struck, "tubes": tubes, "curled": curled, "one_linearisation": one_linearisation,
    "ripple": ripple, "channel": channel, "pulled_far": pulled_far, "lifted": lifted,
}
