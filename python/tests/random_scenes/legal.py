"""Anything that a user may write: objects, analyses and solvers at random."""

from __future__ import annotations

import math
import random
from typing import Any

from . import overlap
from .scene import Judge, Row, Scene, circle, from_nowhere, shape_of


def table_of(random_: random.Random, duration: float, most: float) -> dict[str, Any]:
    return {"times": [0, duration * random_.uniform(0.2, 0.9)], "values": [0, most]}


def finger(random_: random.Random, scene: Scene, duration: float) -> None:
    """A soft finger and its cable, pulled by a length, a force or what a target asks for."""
    scene["solids"] = {"finger": {
        "mesh": "finger.vtk", "scale": 0.001, "density": 1070,
        "material": {"law": random_.choice(["corotational", "neo_hookean", "saint_venant_kirchhoff"]),
                     "young": 10 ** random_.uniform(5, 6.5), "poisson": random_.uniform(0.2, 0.49)},
        "rayleigh": {"mass": 0.1, "stiffness": random_.choice([0.005, 0.02])},
        "fixed": {"box": [[-0.001, -0.008, -0.008], [0.001, 0.008, 0.008]]}}}
    points = sorted({round(random_.uniform(0.005, 0.085), 4) for _ in range(random_.randint(1, 8))})
    scene["rods"] = {"cable": {
        "path": [[0, 0, 0.002], [0.09, 0, 0.002]], "sections": random_.randint(2, 20),
        "strains": ["torsion", "bending_y", "bending_z"], "section": {"circle": {"radius": 10 ** random_.uniform(-3.7, -3)}},
        "material": {"young": 10 ** random_.uniform(8, 10), "poisson": 0.4, "density": 1100}}}
    scene["couplings"] = [{"slide": {"rod": "cable", "solid": "finger", "points": points + [0.09],
                                     "anchor_tip": "position"}}]
    pull: dict[str, Any] = {"rod": "cable"}
    how = random_.choice(["displacement", "force", "inverse"])
    scene["outputs"] = {"tip": {"solid": "finger", "point": [0.095, 0, 0]}}
    if how == "displacement":
        pull["displacement"] = table_of(random_, duration, random_.uniform(0, 0.015))
    elif how == "force" or scene["analysis"] in ("static", "modal"):
        pull["force"] = table_of(random_, duration, random_.uniform(0, 3))
    else:
        pull["force"] = "inverse"
        scene["targets"] = {"tip": {"at": [0.095, 0, random_.uniform(0, 0.03)], "weights": [0, 0, 1]}}
    scene["actuators"] = {"pull": pull}


def arm(random_: random.Random, scene: Scene, duration: float) -> None:
    """A rod that tendons, loads and a tie act on."""
    length, radius = random_.uniform(0.05, 0.6), random_.uniform(1e-3, 1e-2)
    young = 10 ** random_.uniform(5.5, 8)
    full = ["torsion", "bending_y", "bending_z", "elongation", "shear_y", "shear_z"]
    scene["rods"] = {"r": {
        "path": random_.choice([[[0, 0, 0.2], [length, 0, 0.2]],
                                [[0, 0, 0.2], [0.5 * length, 0, 0.2], [0.8 * length, 0.3 * length, 0.2]]]),
        "sections": random_.randint(1, 12), "order": random_.choice([0, 1, 2]), "strains": full[:random_.choice([3, 4, 6])],
        "section": {"circle": {"radius": radius}},
        "material": {"young": young, "poisson": 0.45, "density": 1100, "damping": random_.choice([0, 1e-3, 1e-2])}}}
    scene["outputs"] = {"tip": {"rod": "r", "at": 0.7 * length}}
    bends = young * circle(radius) / length**2
    if random_.random() < 0.6:
        scene["loads"] = {"p": {"rod": "r", "force": [bends * random_.uniform(-2, 2) for _ in range(3)],
                                "factor": table_of(random_, duration, 1)}}
    if random_.random() < 0.6:
        scene["actuators"] = {}
        for i in range(random_.randint(1, 3)):
            told = {"tension": table_of(random_, duration, bends * length / radius * random_.uniform(0, 1))}
            if random_.random() < 0.4:
                told = {"displacement": table_of(random_, duration, 0.5 * radius * random_.uniform(-1, 1))}
            scene["actuators"][f"t{i}"] = {"rod": "r", **told,
                                           "tendon": {"distance": 0.6 * radius, "angle": f"{120 * i} deg"}}
    if random_.random() < 0.25 and scene["analysis"] != "modal":
        scene["rods"]["r"]["strains"] = full[:4]
        scene["couplings"] = [{"tie": {"rod": "r", "at": 0.7 * length, "along": random_.choice([["y"], ["y", "z"]])}}]


def heap(random_: random.Random, scene: Scene, duration: float) -> None:
    """Bodies above a floor, and a rod between them at times."""
    scene["bodies"] = {}
    for i in range(random_.randint(1, 4)):
        shape, _, around = shape_of(random_, 0.02)
        scene["bodies"][f"b{i}"] = {
            **shape, "density": 10 ** random_.uniform(2, 4),
            "pose": {"translate": [random_.uniform(-0.02, 0.02), random_.uniform(-0.02, 0.02), 0.05 + 0.07 * i],
                     "rotate": [random_.uniform(-2, 2) for _ in range(3)]},
            "velocity": [random_.gauss(0, 0.2) for _ in range(3)]}
    scene["obstacles"] = {"floor": {"plane": {"normal": [0, 0, 1]}}}
    scene["contact"] = {"friction": random_.choice([0, 0.3, 0.8]), "restitution": random_.choice([0, 0.5])}
    scene["outputs"] = overlap.outputs(scene)
    if random_.random() < 0.3:
        scene["rods"] = {"r": {
            "path": [[-0.1, 0, 0.04], [0.1, 0, 0.04]], "sections": 6, "base": random_.choice(["free", ["z"]]),
            "section": {"circle": {"radius": 0.003}},
            "material": {"young": 10 ** random_.uniform(6, 8), "poisson": 0.45, "density": 1100, "damping": 0.01}}}
        scene["contact"]["pairs"] = [{"between": ["r", "floor"]}, {"between": ["r", "b0"]}]


def trunk(random_: random.Random, scene: Scene, duration: float) -> None:
    """A trunk that two to four cables pull, or bring to where it is told."""
    scene["solids"] = {"trunk": {
        "mesh": "trunk.vtk", "scale": 0.001, "density": random_.uniform(400, 1200),
        "material": {"law": random_.choice(["corotational", "corotational", "neo_hookean"]),
                     "young": 10 ** random_.uniform(5.2, 6.2), "poisson": random_.uniform(0.2, 0.48)},
        "rayleigh": {"mass": 0.1, "stiffness": 0.02},
        "fixed": {"box": [[-0.017, -0.017, -0.001], [0.017, 0.017, 0.001]]}}}
    scene["rods"], scene["couplings"], scene["actuators"] = {}, [], {}
    seeks = scene["analysis"] in ("dynamic", "quasi_static") and random_.random() < 0.4
    rubs = scene["analysis"] == "dynamic" and not seeks
    for i in range(random_.randint(2, 4)):
        x, y = [(1, 0), (0, 1), (-1, 0), (0, -1)][i]
        scene["rods"][f"c{i}"] = {
            "path": [[0.008 * x, 0.008 * y, 0], [0.008 * x, 0.008 * y, 0.195]], "sections": random_.randint(6, 20),
            "section": {"circle": {"radius": 2e-4}}, "material": {"young": 5e9, "poisson": 0.4, "density": 1100}}
        scene["couplings"].append({"slide": {"rod": f"c{i}", "solid": "trunk", "points": [0.05, 0.1, 0.15, 0.195],
                                             "anchor_tip": "position",
                                             "friction": random_.choice([0, 0, 0.2]) if rubs else 0}})
        told: Any = "inverse" if seeks else table_of(random_, duration, random_.uniform(0, 2))
        scene["actuators"][f"p{i}"] = {"rod": f"c{i}", "force": told}
    if seeks:
        scene["targets"] = {"tip": {"at": [random_.uniform(-0.03, 0.03), random_.uniform(-0.03, 0.03), 0.19],
                                    "weights": [1, 1, 0]}}
    scene["outputs"] = {"tip": {"solid": "trunk", "point": [0, 0, 0.195]}}


def chambers(random_: random.Random, scene: Scene, duration: float) -> None:
    """A bar of silicone that air bends."""
    scene["solids"] = {"bar": {
        "mesh": "chambers.msh", "scale": 0.001, "density": 1070, "fixed": {"group": "root"},
        "material": {"law": random_.choice(["neo_hookean", "corotational", "saint_venant_kirchhoff"]),
                     "young": 10 ** random_.uniform(5.3, 6.2), "poisson": random_.uniform(0.3, 0.49)},
        "rayleigh": {"mass": 0.1, "stiffness": 0.01}}}
    young = scene["solids"]["bar"]["material"]["young"]
    scene["loads"] = {"air": {"solid": "bar", "group": "chambers", "pressure": young * random_.uniform(-0.02, 0.1),
                              "factor": table_of(random_, duration, 1)}}
    scene["outputs"] = {"tip": {"solid": "bar", "point": [0.06, 0, 0]}}


def glued(random_: random.Random, scene: Scene, duration: float) -> None:
    """A finger with a plate at its end, and something that it may hit."""
    finger(random_, scene, duration)
    scene["bodies"] = {"plate": {"box": {"size": [0.004, 0.02, 0.02]}, "density": 10 ** random_.uniform(2, 4),
                                 "pose": {"translate": [0.097, 0, 0]}}}
    scene["couplings"].append({"glue": {"solid": "finger", "body": "plate", "box": [[0.09, -0.01, -0.01], [0.1, 0.01, 0.01]]}})


def pressed(random_: random.Random, scene: Scene, duration: float) -> None:
    """A finger and what it is pressed against: a post, a ball that falls on it, a plate that a frame moves at it."""
    finger(random_, scene, duration)
    how = random_.choice(["post", "ball", "plate"])
    scene["contact"] = {"friction": random_.choice([0, 0.3, 0.8])}
    if how == "ball":
        scene["bodies"] = {"ball": {"sphere": {"radius": random_.uniform(0.003, 0.012)}, "density": 10 ** random_.uniform(2, 4),
                                    "pose": {"translate": [random_.uniform(0.03, 0.08), random_.uniform(-5e-3, 5e-3), 0.03]}}}
        return
    lower = random_.uniform(0.009, 0.02)
    if how == "post":
        scene["obstacles"] = {"post": {"cylinder": {"radius": 0.004, "length": 0.06},
                                       "pose": {"translate": [random_.uniform(0.03, 0.09), 0, -lower - 0.004],
                                                "rotate": ["90 deg", 0, 0]}}}
        return
    scene["obstacles"] = {"plate": {"box": {"size": [0.1, 0.1, 0.006]}, "pose": {"translate": [0.08, 0, -lower - 0.003]},
                                    "frame": "hand"}}
    scene["frames"] = {"hand": {"motion": {"times": [0, duration], "translate": [[0, 0, 0], [0, 0, random_.uniform(0, 0.02)]]}}}


def bundle(random_: random.Random, scene: Scene, duration: float) -> None:
    """Rods that lie across each other, or are tied, and are pushed."""
    count, radius = random_.randint(2, 3), random_.uniform(1e-3, 3e-3)
    young = 10 ** random_.uniform(5.5, 8)
    scene["rods"], scene["loads"] = {}, {}
    for i in range(count):
        turn = 0.0 if i == 0 else random_.uniform(-0.5, 0.5)
        x, y = 0.1 * (1 - turn**2 / 2), 0.1 * turn
        scene["rods"][f"r{i}"] = {
            "path": [[0, 0, 2.2 * radius * i], [x, y, 2.2 * radius * i]], "sections": random_.randint(2, 10),
            "order": random_.choice([0, 1]), "section": {"circle": {"radius": radius}},
            "material": {"young": young, "poisson": 0.45, "density": 1100, "damping": random_.choice([1e-3, 1e-2])}}
        scene["loads"][f"f{i}"] = {"rod": f"r{i}", "force": [0, 0, young * circle(radius) / 0.01 * random_.uniform(-1, 1)],
                                   "factor": table_of(random_, duration, 1)}
    scene["outputs"] = {"tip": {"rod": "r0", "at": 0.05}}
    if random_.random() < 0.5:
        scene["contact"] = {"friction": random_.choice([0, 0.4]),
                            "pairs": [{"between": [f"r{i - 1}", f"r{i}"]} for i in range(1, count)]}
    else:
        s = random_.uniform(0.02, 0.09)
        scene["couplings"] = [{"tie": {"rod": "r0", "at": s, "other": "r1", "other_at": s, "along": ["y", "z"]}}]


def extent(scene: Scene) -> float:
    """[m] of the box about paths of rods and loose bodies: the scene's size, or less."""
    points = [p for rod in scene.get("rods", {}).values() for p in rod["path"]]
    for body in scene.get("bodies", {}).values():
        if "pose" in body:
            R = overlap.by_pose(body["pose"].get("rotate", [0, 0, 0]))
            points += [[x + side * overlap.reach(body, along) for x, along in zip(body["pose"]["translate"], R)]
                       for side in (-1, 1)]
    return math.dist(*([f(axis) for axis in zip(*points)] for f in (min, max))) if points else 0.0


def legal(random_: random.Random) -> tuple[Scene, Judge]:
    """Objects, analyses and solvers at random."""
    what = random_.choice([finger, arm, arm, heap, heap, trunk, chambers, glued, pressed, bundle, bundle])
    analysis = "dynamic" if what is heap else random_.choice(["dynamic", "dynamic", "quasi_static", "static", "modal"])
    h = random_.choice([1e-3, 5e-3, 1e-2, 2e-2])
    duration = h * random_.randint(5, 30)
    scene: Scene = {"analysis": analysis, "view": {"interval": 1000},
                    "gravity": [0, 0, -9.81] if what is heap or random_.random() < 0.6 else [0, 0, 0]}
    if analysis == "modal":
        scene["modes"] = random_.randint(1, 5)
    else:
        scene["time"] = {"step": h, "duration": duration}
    if what in (glued, pressed) or (what is bundle and analysis != "dynamic"):  # contact is for these
        analysis = scene["analysis"] = random_.choice(["dynamic", "quasi_static"]) if what is bundle else "dynamic"
        scene.pop("modes", None)
        scene["time"] = {"step": h, "duration": duration}
    if random_.random() < 0.25 and analysis in ("dynamic", "quasi_static"):
        scene["newton"] = random_.choice([1, 2])
    what(random_, scene, duration)
    if random_.random() < 0.1 and "solids" in scene and not scene.keys() & {"newton", "contact", "bodies", "obstacles"}:
        scene["newton"] = {"precision": "single"}

    def judge(rows: list[Row], report: Any) -> list[str]:
        told = []
        codes = {own["code"] for own in report["warnings"]}
        summary = report["summary"]
        linearised = isinstance(scene.get("newton"), int)
        if not linearised and summary["largest_violation_m"] > 1e-8:
            told.append(f"converged with constraints off by {summary['largest_violation_m']:.3g} m")
        deep = summary.get("contact", {}).get("deepest_penetration_m", 0.0)
        # One linearisation may leave 1e-4 of the scene's size (docs/contact.md).
        allowed = max(1e-5, 1.1e-4 * extent(scene)) if linearised else 1e-5  # (rods' radii count, too)
        if deep > allowed and "penetration" not in codes and "overlap_at_start" not in codes:
            told.append(f"overlaps of {1e3 * deep:.3g} mm without a word")
        for row in rows:
            lies, who = overlap.deepest(scene, row)
            if lies > 1e-5 + 1.02 * deep and "overlap_at_start" not in codes:
                told.append(f"{who} by {1e3 * lies:.3g} mm at t = {row['time']:.4g} s, told as {1e3 * deep:.3g} mm")
            for name, value in row.items():
                if name.endswith((".force", ".tension", ".normal")) and abs(value) > 1e9:
                    told.append(f"{name} is {value:.3g}")
        if analysis == "dynamic" and not codes & {"energy_gain", "overlap_at_start"}:
            told += from_nowhere(rows)
        return told[:3]

    return scene, judge
