"""The direct model refined: mesh, sections, points and time step, each by itself and points with the mesh."""

import sys
from collections.abc import Sequence
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
import matplotlib.pyplot as plt
import numpy as np
import numpy.typing as npt
from paper import Result, smooth
from pictures import Array

import sinew

result = Result(__file__, "The direct model, refined")
SCENE = result.scene()
# [mm] of the cable in material: base, four ribs, tip
WITHIN = [(0.0, 18.8), (25.2, 32.8), (39.2, 46.8), (53.2, 60.8), (67.2, 74.8), (81.2, 90.0)]
Cells = npt.NDArray[np.int64]


def finer(points: Array, cells: Cells) -> tuple[Array, Cells]:
    """Every tetrahedron in eight (Bey's), the shape as it was."""
    edges = np.sort(cells[:, [[0, 1], [0, 2], [0, 3], [1, 2], [1, 3], [2, 3]]].reshape(-1, 2), axis=1)
    unique, number = np.unique(edges, axis=0, return_inverse=True)
    ab, ac, ad, bc, bd, cd = (len(points) + number.reshape(-1, 6)).T
    a, b, c, d = cells.T
    children = [
        (a, ab, ac, ad),
        (ab, b, bc, bd),
        (ac, bc, c, cd),
        (ad, bd, cd, d),
        (ab, ac, ad, bd),
        (ab, ac, bc, bd),
        (ac, ad, bd, cd),
        (ac, bc, bd, cd),
    ]
    made = np.concatenate([np.stack(own, axis=1) for own in children])
    points = np.concatenate([points, points[unique].mean(axis=1)])
    corners = points[made]
    turned = np.linalg.det(corners[:, 1:] - corners[:, :1]) < 0.0
    made[turned] = made[turned][:, [0, 2, 1, 3]]
    return points, made


start = sinew.build(SCENE).initial_state().snapshot().solids[0]
levels = [(start.rest.copy(), start.cells["tetra"].astype(np.int64))]
while len(levels) < 3:
    levels.append(finer(*levels[-1]))
meshes = [sinew.Mesh(points, {"tetra": cells}) for points, cells in levels]


def places(per_piece: int) -> list[float]:
    """[m] of so many points in every piece of material, the tip besides."""
    return [1e-3 * (low + (high - low) * (k + 0.5) / per_piece) for low, high in WITHIN for k in range(per_piece)] + [0.09]


def at_rest(level: int = 0, order: int = 1, sections: int = 15, degree: int = 0, per_piece: int = 1, radius: float = 0.5e-3) -> tuple[Array, float]:
    """Where the tip comes to rest [mm], and how far the cable is pulled out [mm]."""
    scene = sinew.Scene.from_file(SCENE)
    body, rod, slide = scene.solids["finger"], scene.rods["cable"], scene.couplings[0]
    assert isinstance(slide, sinew.Slide)
    if level > 0:
        body.mesh, body.scale = meshes[level], 1.0
    body.order, rod.sections, rod.order, slide.points = order, sections, degree, places(per_piece)
    rod.section = sinew.Circle(radius=radius)
    state = sinew.simulate(scene, progress=False).state()
    return 1e3 * state.output("tip"), 1e3 * float(state.displacements[0])


def orders(sizes: Sequence[float], errors: Sequence[float]) -> list[str]:
    """From one to the next."""
    e, h = np.log(errors), np.log(sizes)
    return ["", *[f"{(e[k] - e[k + 1]) / (h[k] - h[k + 1]):.2f}" for k in range(len(errors) - 1)]]


def fitted(sizes: Sequence[float], errors: Sequence[float]) -> float:
    """The order of all of them."""
    return float(np.polyfit(np.log(sizes), np.log(errors), 1)[0])


figure, panels = plt.subplots(2, 2, figsize=(11, 8.4), layout="constrained")
(by_sections, by_points), (by_mesh, by_step) = panels

# Sections
COUNTS = [3, 6, 12, 24, 48, 96]
found: dict[int, float] = {}
rows: list[list[object]] = []
for degree in (0, 1):
    counts = COUNTS if degree == 0 else COUNTS[:-1]
    tips = [at_rest(sections=count, degree=degree)[0] for count in [*counts, 4 * counts[-1]]]
    errors = [float(np.linalg.norm(own - tips[-1])) for own in tips[:-1]]
    found[degree] = fitted([90.0 / c for c in counts[1:]], errors[1:])
    for count, error, told in zip(counts, errors, orders([90.0 / c for c in counts], errors), strict=True):
        rows.append([["constant", "linear"][degree], count, f"{error:.2g}", told])
    by_sections.loglog(counts, errors, "o-", label=f"strains {['constant', 'linear'][degree]} in a section")
by_sections.set(xlabel="sections", ylabel="tip from that of the finest [mm]", title="sections (7 points, mesh as it is)")
result.say("*Sections.* How far the tip is from where four times the largest number of sections brings it, with 7 points:")
result.table(["strains in a section", "sections", "tip off [mm]", "order"], rows)

# Mesh and points
PIECES = (1, 2, 4, 8)
MADE = [(1, 0), (1, 1), (1, 2), (2, 0), (2, 1)]  # order, level
FINEST = (2, 1)
names = {1: "linear", 2: "quadratic"}
counted = {own: f"{names[own[0]]}, {len(levels[own[1]][1])}" for own in MADE}
rest = {(own, p): at_rest(own[1], own[0], 30, 0, p) for own in MADE for p in PIECES}
travel = {key: float(np.linalg.norm(tip - [95.0, 0.0, 0.0])) for key, (tip, _) in rest.items()}
thin = [float(np.linalg.norm(at_rest(0, 2, 30, 0, p, 0.25e-3)[0] - [95.0, 0.0, 0.0])) for p in (1, 8)]
result.say("*Mesh and points.* How far the tip travels and, behind it, the cable is pulled out [mm], at 1 N, with 30 sections:")
result.table(
    ["elements, tetrahedra", *[f"{6 * p + 1} points" for p in PIECES], "more points: 7 to 49"],
    [
        [counted[own], *[f"{travel[own, p]:.2f}, {rest[own, p][1]:.2f}" for p in PIECES], f"{100 * (travel[own, 8] / travel[own, 1] - 1):.1f} %"]
        for own in MADE
    ],
)
halves = [4.0, 2.0, 1.0]
mesh_errors = {p: [float(np.linalg.norm(rest[own, p][0] - rest[FINEST, p][0])) for own in MADE[:-1]] for p in PIECES}
result.say(
    f"How far the tip is from that of the finest ({counted[FINEST]}) [mm], which is itself still some mm short of its limit, and "
    "orders from one linear mesh to the next:"
)
result.table(
    ["points", *[counted[own] for own in MADE[:-1]], "orders"],
    [[6 * p + 1, *[f"{e:.2f}" for e in mesh_errors[p]], ", ".join(orders(halves, mesh_errors[p][:3])[1:])] for p in PIECES],
)
squeeze = {p: 100.0 * (rest[FINEST, p][1] / rest[(2, 0), p][1] - 1.0) for p in PIECES}
result.say(
    "Linear tetrahedra are far too stiff (at a Poisson's ratio of 0.45 each has one strain to bend with, see `docs/elements.md`): the mesh as it "
    "is lets the tip travel half as far as it should. They converge, at about first order: two is what they promise where stress is smooth, and "
    "here it has peaks in the corners of the gaps and at every point of the cable. Quadratic ones on the coarsest mesh are nearer than linear "
    "ones on the finest. What does not converge is the place where a point pulls: a force at a point goes the deeper into a solid the smaller "
    f"its elements (as 1 / h), so from one quadratic mesh to the next the cable is pulled out by {squeeze[1]:.0f} % more with 7 points and by "
    f"{squeeze[8]:.0f} % with 49 (the anchor is one point in both), the tip travels by {100 * (travel[FINEST, 1] / travel[(2, 0), 1] - 1):.0f} "
    f"and {100 * (travel[FINEST, 8] / travel[(2, 0), 8] - 1):.0f} % more. Elements smaller than the cable is thick make no sense."
)
result.say(
    "More points make the finger stiffer on every mesh: two or more in a rib turn the cable with it, and only what lies in the gaps can bend. It "
    f"is the cable's own stiffness that tells: one of half the radius loses {100 * (1 - thin[1] / thin[0]):.0f} % of the travel from 7 to 49 "
    f"points on quadratic elements, where this one loses {100 * (1 - travel[(2, 0), 8] / travel[(2, 0), 1]):.0f} %. On linear tetrahedra there is "
    "a second reason, which goes away as they are refined: an element with two points of its own stays straight, and so must the cable "
    "(`docs/points.md`)."
)
for own in MADE:
    by_points.semilogx([6 * p + 1 for p in PIECES], [travel[own, p] for p in PIECES], "os"[own[0] - 1] + "-", label=counted[own])
by_points.set(xlabel="points", ylabel="tip travels [mm]", title="points, on meshes of so many tetrahedra", ylim=(10, None))
by_points.set_xticks([6 * p + 1 for p in PIECES], labels=[str(6 * p + 1) for p in PIECES])
by_points.minorticks_off()
for p, color in ((1, "tab:blue"), (8, "tab:orange")):
    for order, own_levels in ((1, (0, 1, 2)), (2, (0, 1))):
        nodes = [3 * len(levels[level + order - 1][0]) for level in own_levels]
        by_mesh.semilogx(
            nodes,
            [travel[(order, level), p] for level in own_levels],
            "os"[order - 1] + "-:"[order - 1],
            color=color,
            label=f"{names[order]}, {6 * p + 1} points",
        )
by_mesh.set(xlabel="unknowns of the solid", ylabel="tip travels [mm]", title="mesh, element order", ylim=(20, None))

# Time step
STEP, SECONDS, PULL = 0.64e-3, 0.5, 0.010
WHEN = 39 * 16 * STEP
SIZES = [16 * STEP, 8 * STEP, 4 * STEP, 2 * STEP]


def in_motion(step: float, newton: int | str) -> Array:
    """Where the tip is as the pull ends [mm]."""
    changes: dict[str, object] = {
        "analysis": "dynamic",
        "time.step": step,
        "newton": newton,
        "actuators.pull": sinew.Actuator(rod="cable", displacement="external"),
    }
    model = sinew.build(SCENE, changes)
    state = model.initial_state()
    count = round(WHEN / step)
    for k in range(count):
        report = sinew.step(model, {"pull": PULL * smooth(min(1.0, (k + 1) * step / SECONDS))}, state)
        assert report.accepted, report.meaning
    return 1e3 * state.output("tip")


rows = []
steps_order: dict[str, float] = {}
finest = {step: in_motion(step, "converged") for step in (STEP, STEP / 2)}
limit = 2.0 * finest[STEP / 2] - finest[STEP]  # first order taken out
ways: dict[str, int | str] = {"converged": "converged", "one linearisation": 1}
for name, newton in ways.items():
    errors = [float(np.linalg.norm(in_motion(step, newton) - limit)) for step in SIZES]
    steps_order[name] = fitted(SIZES[-2:], errors[-2:])
    rows += [[name, f"{1e3 * step:.2f}", f"{error:.4f}", told] for step, error, told in zip(SIZES, errors, orders(SIZES, errors), strict=True)]
    by_step.loglog([1e3 * step for step in SIZES], errors, "o-", label=name)
by_step.set(xlabel="time step [ms]", ylabel="tip off [mm]", title="time step, in motion")
result.say("*Time step.* How far the tip is, in the midst of a pull of 10 mm in 0.5 s, from where steps of 0.32 and 0.64 ms head for:")
result.table(["steps", "h [ms]", "tip off [mm]", "order"], rows)
result.say(
    "Steps that converge head for the first order of backward Euler, from errors that are small at any step. One linearisation a step has it, "
    "too, with errors more than a hundred times as large (`docs/newton.md`)."
)
for axes, place in zip(panels.flat, ("upper right", "lower left", "lower right", "center right"), strict=True):
    axes.grid(True, which="both", alpha=0.3)
    axes.legend(fontsize=8, loc=place)
result.picture(figure, "refinement.png", "Errors of the tip against sections, points, mesh and time step")

result.check("sections, constant strains: order (2 of theory)", found[0], 1.7, 2.3)
result.check("sections, linear strains: order at least", found[1], least=2.0)
result.check("linear tetrahedra: least order from mesh to mesh", min(fitted(halves, own[:3]) for own in mesh_errors.values()), least=0.7)
result.check("quadratic on the coarsest mesh beside linear on the finest: error", max(own[3] / own[2] for own in mesh_errors.values()), most=0.5)
steps = np.abs(np.diff([travel[FINEST, p] for p in PIECES]))
result.check("points on the finest: the last doubling changes less than the first, ratio", float(steps[-1] / steps[0]), most=0.6)
stiffer = {own: 1.0 - travel[own, 8] / travel[own, 1] for own in MADE}
result.check("7 to 49 points stiffen the coarsest linear mesh more than the finest quadratic, ratio", stiffer[MADE[0]] / stiffer[FINEST], least=1.2)
result.check("time step, converged: order of the last two (1 of theory)", steps_order["converged"], 0.85, 1.15)
result.check("time step, one linearisation: order of the last two (1 of theory)", steps_order["one linearisation"], 0.85, 1.15)
result.finish()
