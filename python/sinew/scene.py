"""Scenes as Python objects, with the names of scene files. Made by python/make_scene.py from `sinew schema`.

Every class takes keyword arguments, and quantities as numbers in SI or as text with a unit. Where a class is expected, a
dict with the same keys will do.
"""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar, Literal

from sinew.parts import Matrix, MeshSource, Part, Quantity, SceneMethods, Tree, Vector

__all__ = [
    "Actuator",
    "BoxShape",
    "CapsuleShape",
    "Circle",
    "Contact",
    "ContactPair",
    "CylinderShape",
    "Ellipse",
    "FileTable",
    "FileTrack",
    "Formula",
    "Frame",
    "FrameMotion",
    "Glue",
    "Held",
    "Limits",
    "MeshShape",
    "Newton",
    "Obstacle",
    "Orders",
    "Output",
    "Plane",
    "PlaneShape",
    "Pose",
    "Rayleigh",
    "Rectangle",
    "Region",
    "RigidBody",
    "Rod",
    "RodLoad",
    "RodMaterial",
    "RodPart",
    "Scene",
    "Slide",
    "Solid",
    "SolidLoad",
    "SolidMaterial",
    "SolidPart",
    "Span",
    "Sphere",
    "SphereShape",
    "Spring",
    "StiffnessSection",
    "StrainTable",
    "Table",
    "Target",
    "Tendon",
    "Tie",
    "Time",
    "Track",
    "Tube",
    "View",
]


@dataclass(kw_only=True)
class Scene(SceneMethods):
    """A whole scene.

    title: What the scene shows, in a line; for example "A finger pulled by one cable".
    time: The time step and the duration; for example {"step": "10 ms", "duration": "2 s"}.
    gravity: The acceleration of free fall [m/s^2]; for example [0, -9.81, 0]; if left out [0.0, 0.0, 0.0].
    analysis: What is computed: the motion (dynamic), equilibria over time (quasi_static) or at the end (static), or
        natural frequencies at the start (modal); for example "static"; if left out "dynamic".
    snap: Where a quasi_static run finds no equilibrium that goes on from the one before: follow what lets go to the
        next one, with a warning, or stop; for example "stop"; if left out "follow".
    modes: The number of modes of a modal analysis; for example 6; if left out 6.
    newton: How a step is solved: `converged`, a number of linearisations (1 is a linearised step), or a map; for
        example "converged".
    view: What is written for ParaView; for example {"interval": "20 ms"}.
    frames: Frames by name, which may move and carry solids and rods; for example {"hand": {"pose": {"translate": [0,
        "20 mm", 0]}}}.
    solids: Soft bodies by name; for example {"finger": {"mesh": "finger.vtk", "mass": "75 g", "material": {"young":
        "600 kPa", "poisson": 0.45}}}.
    rods: Rods and cables by name; for example {"cable": {"path": [[0, 0, 0], ["100 mm", 0, 0]], "section": {"circle":
        {"radius": "0.5 mm"}}, "material": {"young": "5 GPa", "poisson": 0.4, "density": 1100}}}.
    bodies: Rigid bodies by name; for example {"cube": {"box": {"size": ["20 mm", "20 mm", "20 mm"]}, "mass": "30 g"}}.
    obstacles: What stands still or is carried by a frame, by name; for example {"floor": {"plane": {"normal": [0, 0,
        1]}}}.
    contact: How bodies and obstacles meet each other, solids and rods; friction is 0.5 if left out; for example
        {"friction": 0.3}.
    couplings: What ties rods to solids, frames, the ground and each other; for example [{"slide": {"rod": "cable",
        "solid": "finger", "points": 15}}].
    actuators: What moves rods: their bases or tendons in them, by name; for example {"pull": {"rod": "cable",
        "displacement": "20 mm"}}.
    loads: Forces and moments on rods, by name; for example {"weight": {"rod": "cable", "force": [0, 0, "-1 N"]}}.
    outputs: What is recorded of points of solids and rods, by name; for example {"tip": {"solid": "finger", "point":
        ["100 mm", 0, 0]}}.
    targets: Where outputs are to be brought by the actuators that are `inverse`, by the names of the outputs; for
        example {"tip": {"at": ["120 mm", 0, "30 mm"]}}.
    folder: Where files that the scene names are looked for.
    """

    title: str | None = None
    time: Time | Tree | None = field(default=None, metadata={"kinds": ("Time",)})
    gravity: Vector | None = None
    analysis: Literal["dynamic", "quasi_static", "static", "modal"] | None = None
    snap: Literal["follow", "stop"] | None = None
    modes: int | None = None
    newton: Literal["converged"] | int | Newton | Tree | None = field(default=None, metadata={"kinds": ("Newton",)})
    view: View | Tree | None = field(default=None, metadata={"kinds": ("View",)})
    frames: dict[str, Frame] = field(default_factory=dict, metadata={"kinds": ("Frame",), "named": True})
    solids: dict[str, Solid] = field(default_factory=dict, metadata={"kinds": ("Solid",), "named": True})
    rods: dict[str, Rod] = field(default_factory=dict, metadata={"kinds": ("Rod",), "named": True})
    bodies: dict[str, RigidBody] = field(default_factory=dict, metadata={"kinds": ("RigidBody",), "named": True})
    obstacles: dict[str, Obstacle] = field(default_factory=dict, metadata={"kinds": ("Obstacle",), "named": True})
    contact: Contact | Tree | None = field(default=None, metadata={"kinds": ("Contact",)})
    couplings: list[Slide | Tie | Glue] = field(default_factory=list, metadata={"kinds": ("Slide", "Tie", "Glue",)})
    actuators: dict[str, Actuator] = field(default_factory=dict, metadata={"kinds": ("Actuator",), "named": True})
    loads: dict[str, RodLoad | SolidLoad] = field(default_factory=dict, metadata={"kinds": ("RodLoad", "SolidLoad",), "named": True})
    outputs: dict[str, Output] = field(default_factory=dict, metadata={"kinds": ("Output",), "named": True})
    targets: dict[str, Target] = field(default_factory=dict, metadata={"kinds": ("Target",), "named": True})
    folder: str | os.PathLike[str] = field(default=".", metadata={"not_a_key": True})


@dataclass(kw_only=True)
class Time(Part):
    """The time step and the duration.

    step: The time step [s]; for example "10 ms"; if left out 0.01.
    duration: The time at which the run ends [s]; for example "2 s"; if left out 1.0.
    smallest: The smallest part of a step that is tried where the whole does not converge [s]; if not told, 1e-4 of the
        step, and a 64th of a linearised one (`newton: n`); for example "1 us"; if left out 0.0.
    """

    step: Quantity | None = None
    duration: Quantity | None = None
    smallest: Quantity | None = None


@dataclass(kw_only=True)
class Newton(Part):
    """Newton.

    iterations: `converged`, or the number of linearisations in every step; for example "converged"; if left out
        "converged".
    limit: The number of linearisations after which a step is halved; for example 25; if left out 25.
    tolerance: The relative residual at which a step is converged; for example 1e-09; if left out 1e-09.
    precision: The precision of factors of solids: `single` takes half the memory, and less time from some 100 000
        elements on; solutions are refined to double precision all the same; for example "double"; if left out "double".
    """

    iterations: Literal["converged"] | int | None = None
    limit: int | None = None
    tolerance: Quantity | None = None
    precision: Literal["double", "single"] | None = None


@dataclass(kw_only=True)
class View(Part):
    """What is written for ParaView.

    interval: The time between views for ParaView [s], 0 for about 100 in a run; for example "20 ms"; if left out 0.0.
    """

    interval: Quantity | None = None


@dataclass(kw_only=True)
class Frame(Part):
    """A frame.

    pose: Where the frame stands at rest; for example {"translate": [0, "20 mm", 0]}.
    motion: How the frame moves over time; for example {"times": [0, 1], "translate": [[0, 0, 0], [0, "20 mm", 0]]}.
    """

    pose: Pose | Tree | None = field(default=None, metadata={"kinds": ("Pose",)})
    motion: FrameMotion | Tree | None = field(default=None, metadata={"kinds": ("FrameMotion",)})


@dataclass(kw_only=True)
class Pose(Part):
    """Where the frame stands at rest.

    rotate: The angles [a, b, c] of R = Rz(c) Ry(b) Rx(a) [rad]; for example [0, 0, "90 deg"]; if left out [0.0, 0.0,
        0.0].
    translate: The shift after the rotation [m]; for example [0, "20 mm", 0]; if left out [0.0, 0.0, 0.0].
    """

    rotate: Vector | None = None
    translate: Vector | None = None


@dataclass(kw_only=True)
class FrameMotion(Part):
    """How the frame moves over time.

    times: The ascending times of the entries below [s]; for example [0, 2].
    rotate: The angles [a, b, c] at each time [rad]; for example [[0, 0, 0], [0, 0, 1]].
    translate: The shift at each time [m]; for example [[0, 0, 0], [0, "20 mm", 0]].
    """

    times: Vector
    rotate: Matrix | None = None
    translate: Matrix | None = None


@dataclass(kw_only=True)
class Solid(Part):
    """A solid.

    mesh: The file with its elements, looked up from the scene's folder; for example "finger.vtk".
    material: What it is made of; for example {"young": "600 kPa", "poisson": 0.45}.
    scale: What mesh coordinates are multiplied by to be in m; for example 0.001; if left out 1.0.
    order: Of its elements: 1 as the file has them, 2 with 10-node tetrahedra in place of 4-node ones; for example 2; if
        left out 1.
    pose: Where the solid stands, after scale; for example {"translate": [0, "20 mm", 0]}.
    frame: The frame that carries it and its pose; for example "hand".
    mass: Its total mass [kg], instead of density; for example "75 g".
    density: Its density [kg/m^3], instead of mass; for example "1100 kg/m^3".
    rayleigh: Its damping; for example {"mass": 0.1, "stiffness": 0.1}.
    mass_matrix: Lumped at the nodes, or consistent; none: consistent with 10-node tetrahedra, else lumped; for example
        "lumped".
    parts: Regions of another material; for example [{"group": "bone", "material": {"young": "1 GPa", "poisson": 0.3}}].
    fixed: A region, or a list of regions, whose nodes are held; for example {"box": [[0, 0, 0], ["5 mm", "1 cm", "1
        cm"]]}.
    springs: Springs to where it is at rest; for example [{"surface": true, "stiffness": ["10 N/m", "10 N/m", "10
        N/m"]}].
    """

    mesh: MeshSource
    material: SolidMaterial | Tree = field(metadata={"kinds": ("SolidMaterial",)})
    scale: Quantity | None = None
    order: int | None = None
    pose: Pose | Tree | None = field(default=None, metadata={"kinds": ("Pose",)})
    frame: str | None = None
    mass: Quantity | None = None
    density: Quantity | None = None
    rayleigh: Rayleigh | Tree | None = field(default=None, metadata={"kinds": ("Rayleigh",)})
    mass_matrix: Literal["lumped", "consistent"] | None = None
    parts: list[SolidPart] = field(default_factory=list, metadata={"kinds": ("SolidPart",)})
    fixed: Held | Tree | Sequence[Held | Tree] | None = field(default=None, metadata={"kinds": ("Held",)})
    springs: list[Spring] = field(default_factory=list, metadata={"kinds": ("Spring",)})


@dataclass(kw_only=True)
class SolidMaterial(Part):
    """What it is made of.

    law: The constitutive law; for example "corotational"; if left out "corotational".
    young: Young's modulus [Pa]; for example "600 kPa"; if left out 0.0.
    poisson: Poisson's ratio; for example 0.45; if left out 0.0.
    c10: Its first constant [Pa]; for example "80 kPa"; if left out 0.0.
    c01: Its second constant [Pa]; for example "20 kPa"; if left out 0.0.
    mu: Its moduli [Pa]; for example ["630 kPa", "1.2 kPa", "-10 kPa"].
    alpha: Its powers; for example [1.3, 5, -2].
    bulk: The bulk modulus [Pa]; for example "50 MPa".
    viscosity: Its viscosity against shear [Pa s]; 4/3 (1 + nu)^2 of it against extension; for example "300 Pa s"; if
        left out 0.0.
    density: Its density [kg/m^3], instead of the solid's; for example "1100 kg/m^3".
    """

    law: Literal["corotational", "saint_venant_kirchhoff", "neo_hookean", "mooney_rivlin", "ogden"] | None = None
    young: Quantity | None = None
    poisson: Quantity | None = None
    c10: Quantity | None = None
    c01: Quantity | None = None
    mu: Vector | None = None
    alpha: Vector | None = None
    bulk: Quantity | None = None
    viscosity: Quantity | None = None
    density: Quantity | None = None


@dataclass(kw_only=True)
class Rayleigh(Part):
    """Its damping.

    mass: The damping per mass [1/s]; for example "0.1 1/s"; if left out 0.0.
    stiffness: The damping per stiffness [s]; for example "10 ms"; if left out 0.0.
    """

    mass: Quantity | None = None
    stiffness: Quantity | None = None


@dataclass(kw_only=True)
class SolidPart(Part):
    """A part of a solid.

    material: What it is made of; for example {"young": "2 MPa", "poisson": 0.45}.
    box: The lower and the upper corner of a box [m]; for example [[0, 0, 0], ["5 mm", "1 cm", "1 cm"]].
    sphere: A sphere; for example {"center": [0, 0, "10 mm"], "radius": "5 mm"}.
    plane: A plane, with what lies on it; for example {"point": [0, 0, 0], "normal": [1, 0, 0]}.
    nodes: Node numbers of the mesh file, from 0; for example [0, 3, 17].
    group: What the mesh file has given this name: a physical group, or a cell tag; for example "base".
    surface: True: the whole boundary; for example true.
    in_: Where the region is given, in the object before its pose or the world; for example "world".
    """

    material: SolidMaterial | Tree = field(metadata={"kinds": ("SolidMaterial",)})
    box: Matrix | None = None
    sphere: Sphere | Tree | None = field(default=None, metadata={"kinds": ("Sphere",)})
    plane: Plane | Tree | None = field(default=None, metadata={"kinds": ("Plane",)})
    nodes: Sequence[int] | None = None
    group: str | None = None
    surface: Literal[True] | None = None
    in_: Literal["object", "world"] | None = None


@dataclass(kw_only=True)
class Sphere(Part):
    """A sphere.

    center: Its centre [m]; for example [0, 0, "10 mm"].
    radius: Its radius [m]; for example "5 mm".
    """

    center: Vector
    radius: Quantity


@dataclass(kw_only=True)
class Plane(Part):
    """A plane, with what lies on it.

    point: A point of it [m]; for example [0, 0, 0].
    normal: The direction across it; for example [1, 0, 0].
    within: How far to either side nodes still count [m]; for example "0.1 mm".
    """

    point: Vector
    normal: Vector
    within: Quantity | None = None


@dataclass(kw_only=True)
class Held(Part):
    """A region.

    box: The lower and the upper corner of a box [m]; for example [[0, 0, 0], ["5 mm", "1 cm", "1 cm"]].
    sphere: A sphere; for example {"center": [0, 0, "10 mm"], "radius": "5 mm"}.
    plane: A plane, with what lies on it; for example {"point": [0, 0, 0], "normal": [1, 0, 0]}.
    nodes: Node numbers of the mesh file, from 0; for example [0, 3, 17].
    group: What the mesh file has given this name: a physical group, or a cell tag; for example "base".
    surface: True: the whole boundary; for example true.
    in_: Where the region is given, in the object before its pose or the world; for example "world".
    axes: The axes of the world along which it is held; for example ["x", "y"]; if left out ["x", "y", "z"].
    frame: The frame that holds and moves it; the solid's own; for example "hand".
    """

    box: Matrix | None = None
    sphere: Sphere | Tree | None = field(default=None, metadata={"kinds": ("Sphere",)})
    plane: Plane | Tree | None = field(default=None, metadata={"kinds": ("Plane",)})
    nodes: Sequence[int] | None = None
    group: str | None = None
    surface: Literal[True] | None = None
    in_: Literal["object", "world"] | None = None
    axes: Sequence[Literal["x", "y", "z"]] | None = None
    frame: str | None = None


@dataclass(kw_only=True)
class Spring(Part):
    """Springs.

    stiffness: Along x, y and z, all nodes together [N/m]; for example [0, 0, "200 N/m"].
    box: The lower and the upper corner of a box [m]; for example [[0, 0, 0], ["5 mm", "1 cm", "1 cm"]].
    sphere: A sphere; for example {"center": [0, 0, "10 mm"], "radius": "5 mm"}.
    plane: A plane, with what lies on it; for example {"point": [0, 0, 0], "normal": [1, 0, 0]}.
    nodes: Node numbers of the mesh file, from 0; for example [0, 3, 17].
    group: What the mesh file has given this name: a physical group, or a cell tag; for example "base".
    surface: True: the whole boundary; for example true.
    in_: Where the region is given, in the object before its pose or the world; for example "world".
    """

    stiffness: Vector
    box: Matrix | None = None
    sphere: Sphere | Tree | None = field(default=None, metadata={"kinds": ("Sphere",)})
    plane: Plane | Tree | None = field(default=None, metadata={"kinds": ("Plane",)})
    nodes: Sequence[int] | None = None
    group: str | None = None
    surface: Literal[True] | None = None
    in_: Literal["object", "world"] | None = None


@dataclass(kw_only=True)
class Rod(Part):
    """A rod.

    path: The points from base to tip [m]; for example [[0, 0, 0], ["100 mm", 0, 0]].
    in_: Where path is given, in the object before its pose or the world; for example "world"; if left out "object".
    up: The direction of the base's y axis; z, or y if the path starts along z; for example [0, 0, 1].
    pose: Where the rod stands; for example {"translate": [0, "20 mm", 0]}.
    frame: The frame that carries its base; for example "hand".
    cable: Cosserat for a rod with stiffness, geometric for a massless cable without any; for example "cosserat"; if
        left out "cosserat".
    sections: Their number, or the ascending ends of all from 0 to the length [m]; for example 15; if left out 1.
    strains: The strains that may vary; for example ["torsion", "bending_y", "bending_z"]; if left out ["torsion",
        "bending_y", "bending_z"].
    order: The Legendre order of the strains in a section, 0 (constant) to 5: one for all that vary, or some by name;
        for example {"torsion": 1, "bending_y": 2}; if left out 0.
    rest: The stress-free shape: along the path, straight, or strains, constant or over the abscissae `at`; for example
        {"at": [0, "50 mm"], "bending_z": [0, "20 1/m"]}; if left out "path".
    start: How it lies at the start: bent to its path, or stress-free (rest, the default if `rest` is a map); for
        example "rest".
    base: Clamped, free, or a list of the free motions of the base; for example ["x", "turn_z"]; if left out "clamped".
    section: The shape across; for example {"circle": {"radius": "0.5 mm"}}.
    material: What it is made of; for example {"young": "5 GPa", "poisson": 0.4, "density": 1100}.
    parts: Pieces with a section and a material each, instead of those of the whole rod; for example [{"to": "0.3 m",
        "section": {"circle": {"radius": "1 mm"}}, "material": {"young": "5 GPa", "poisson": 0.4, "density": 1100}}].
    """

    path: Matrix
    in_: Literal["object", "world"] | None = None
    up: Vector | None = None
    pose: Pose | Tree | None = field(default=None, metadata={"kinds": ("Pose",)})
    frame: str | None = None
    cable: Literal["cosserat", "geometric"] | None = None
    sections: int | Vector | None = None
    strains: Sequence[Literal["torsion", "bending_y", "bending_z", "elongation", "shear_y", "shear_z"]] | None = None
    order: int | Orders | Tree | None = field(default=None, metadata={"kinds": ("Orders",)})
    rest: Literal["path", "straight"] | StrainTable | Tree | None = field(default=None, metadata={"kinds": ("StrainTable",)})
    start: Literal["path", "rest"] | None = None
    base: Literal["clamped", "free"] | Sequence[Literal["x", "y", "z", "turn_x", "turn_y", "turn_z"]] | None = None
    section: Circle | Tube | Ellipse | Rectangle | StiffnessSection | Tree | None = field(default=None, metadata={"kinds": ("Circle", "Tube", "Ellipse", "Rectangle", "StiffnessSection",)})
    material: RodMaterial | Tree | None = field(default=None, metadata={"kinds": ("RodMaterial",)})
    parts: list[RodPart] = field(default_factory=list, metadata={"kinds": ("RodPart",)})


@dataclass(kw_only=True)
class Orders(Part):
    """An order.

    torsion: Its Legendre order in a section; for example 1; if left out 0.
    bending_y: Its Legendre order in a section; for example 1; if left out 0.
    bending_z: Its Legendre order in a section; for example 1; if left out 0.
    elongation: Its Legendre order in a section; for example 1; if left out 0.
    shear_y: Its Legendre order in a section; for example 1; if left out 0.
    shear_z: Its Legendre order in a section; for example 1; if left out 0.
    """

    torsion: int | None = None
    bending_y: int | None = None
    bending_z: int | None = None
    elongation: int | None = None
    shear_y: int | None = None
    shear_z: int | None = None


@dataclass(kw_only=True)
class StrainTable(Part):
    """A rest shape.

    at: The ascending abscissae of the values below [m]; for example [0, "50 mm"].
    torsion: Its stress-free torsion [1/m]; for example "20 1/m".
    bending_y: Its stress-free bending about y [1/m]; for example "20 1/m".
    bending_z: Its stress-free bending about z [1/m]; for example "20 1/m".
    elongation: Its stress-free stretch minus 1; for example 0.01.
    shear_y: Its stress-free shear along y; for example 0.01.
    shear_z: Its stress-free shear along z; for example 0.01.
    """

    at: Vector | None = None
    torsion: Quantity | Vector | None = None
    bending_y: Quantity | Vector | None = None
    bending_z: Quantity | Vector | None = None
    elongation: Quantity | Vector | None = None
    shear_y: Quantity | Vector | None = None
    shear_z: Quantity | Vector | None = None


@dataclass(kw_only=True)
class Circle(Part):
    """A full circle.

    radius: Its radius [m], or a pair [start, end]; for example "0.5 mm".
    """

    _kind: ClassVar[str] = "circle"

    radius: Quantity | Vector


@dataclass(kw_only=True)
class Tube(Part):
    """A circle with a hole.

    outer: Its outer radius [m], or a pair [start, end]; for example "5 mm".
    inner: Its inner radius [m], or a pair [start, end]; for example "4 mm".
    """

    _kind: ClassVar[str] = "tube"

    outer: Quantity | Vector
    inner: Quantity | Vector


@dataclass(kw_only=True)
class Ellipse(Part):
    """A full ellipse.

    y: Its half axis along y [m], or a pair [start, end]; for example "2 mm".
    z: Its half axis along z [m], or a pair [start, end]; for example "1 mm".
    """

    _kind: ClassVar[str] = "ellipse"

    y: Quantity | Vector
    z: Quantity | Vector


@dataclass(kw_only=True)
class Rectangle(Part):
    """A full rectangle.

    y: Its side along y [m], or a pair [start, end]; for example "4 mm".
    z: Its side along z [m], or a pair [start, end]; for example "2 mm".
    """

    _kind: ClassVar[str] = "rectangle"

    y: Quantity | Vector
    z: Quantity | Vector


@dataclass(kw_only=True)
class StiffnessSection(Part):
    """A section whose stiffness is known.

    matrix: The stiffness [N m^2, N m, N] against torsion, bending_y, bending_z, elongation, shear_y, shear_z: its
        diagonal or its six rows; for example [0.0004, 0.0005, 0.0005, 4000.0, 1000.0, 1000.0].
    line_density: Its mass per length [kg/m], 0 for a massless rod; for example "1 g/m".
    radius: The radius with which it is drawn and turns [m]; for example "5 mm".
    """

    _kind: ClassVar[str] = "stiffness"

    matrix: Vector | Matrix
    line_density: Quantity
    radius: Quantity


@dataclass(kw_only=True)
class RodMaterial(Part):
    """What it is made of.

    young: Young's modulus [Pa]; for example "5 GPa".
    poisson: Poisson's ratio; for example 0.4.
    density: Its density [kg/m^3], 0 for a massless rod; for example "1100 kg/m^3".
    viscosity: Its viscosity against shear [Pa s]; three times as much against extension; for example "300 Pa s"; if
        left out 0.0.
    damping: Its damping over its stiffness [s], which adds to viscosity; for example "10 ms"; if left out 0.0.
    """

    young: Quantity | None = None
    poisson: Quantity | None = None
    density: Quantity | None = None
    viscosity: Quantity | None = None
    damping: Quantity | None = None


@dataclass(kw_only=True)
class RodPart(Part):
    """A part of a rod.

    to: The abscissa of its end [m]; of the last one, the rod's length; for example "0.3 m".
    section: The shape across; for example {"circle": {"radius": "0.5 mm"}}.
    material: What it is made of; for example {"young": "5 GPa", "poisson": 0.4, "density": 1100}.
    """

    to: Quantity
    section: Circle | Tube | Ellipse | Rectangle | StiffnessSection | Tree = field(metadata={"kinds": ("Circle", "Tube", "Ellipse", "Rectangle", "StiffnessSection",)})
    material: RodMaterial | Tree | None = field(default=None, metadata={"kinds": ("RodMaterial",)})


@dataclass(kw_only=True)
class RigidBody(Part):
    """A rigid body.

    box: A box around the origin of its axes; for example {"size": ["20 mm", "20 mm", "20 mm"]}.
    sphere: A sphere around the origin; for example {"radius": "10 mm"}.
    cylinder: A cylinder about z; for example {"radius": "10 mm", "length": "50 mm"}.
    capsule: All within a radius of a segment along z; for example {"radius": "5 mm", "length": "30 mm"}.
    mesh: A surface of triangles, closed or with a thickness, in the axes of its file; for example {"file": "part.stl"}.
    pose: Where its axes are at the start: at its middle, or those of its mesh; for example {"translate": [0, 0, "10
        mm"]}.
    mass: Its mass [kg], instead of density; for example "30 g".
    density: Its density [kg/m^3], instead of mass; for example "1200 kg/m^3".
    velocity: At the start [m/s]; for example [0, 0, "-1 m/s"]; if left out [0.0, 0.0, 0.0].
    spin: Its angular velocity at the start, about the world's axes [rad/s]; for example [0, 0, "10 rad/s"]; if left out
        [0.0, 0.0, 0.0].
    """

    box: BoxShape | Tree | None = field(default=None, metadata={"kinds": ("BoxShape",)})
    sphere: SphereShape | Tree | None = field(default=None, metadata={"kinds": ("SphereShape",)})
    cylinder: CylinderShape | Tree | None = field(default=None, metadata={"kinds": ("CylinderShape",)})
    capsule: CapsuleShape | Tree | None = field(default=None, metadata={"kinds": ("CapsuleShape",)})
    mesh: MeshShape | Tree | None = field(default=None, metadata={"kinds": ("MeshShape",)})
    pose: Pose | Tree | None = field(default=None, metadata={"kinds": ("Pose",)})
    mass: Quantity | None = None
    density: Quantity | None = None
    velocity: Vector | None = None
    spin: Vector | None = None


@dataclass(kw_only=True)
class BoxShape(Part):
    """A box around the origin of its axes.

    size: Its edges along x, y and z [m]; for example ["20 mm", "20 mm", "20 mm"].
    """

    size: Vector


@dataclass(kw_only=True)
class SphereShape(Part):
    """A sphere around the origin.

    radius: Its radius [m]; for example "10 mm".
    """

    radius: Quantity


@dataclass(kw_only=True)
class CylinderShape(Part):
    """A cylinder about z.

    radius: Its radius [m]; for example "10 mm".
    length: Its length [m]; for example "50 mm".
    """

    radius: Quantity
    length: Quantity


@dataclass(kw_only=True)
class CapsuleShape(Part):
    """All within a radius of a segment along z.

    radius: Its radius [m]; for example "5 mm".
    length: Its length without the round ends [m]; for example "30 mm".
    """

    radius: Quantity
    length: Quantity


@dataclass(kw_only=True)
class MeshShape(Part):
    """A surface of triangles, closed or with a thickness, in the axes of its file.

    file: Its triangles (.stl, .obj, or a volume mesh), looked up from the scene's folder; for example "part.stl".
    scale: What its coordinates are multiplied by to be in m; for example 0.001; if left out 1.0.
    hull: The smallest convex body around it instead; for example true; if left out false.
    thickness: Of a sheet with the surface in its middle, met from both sides; the surface may be open [m]; for example
        "1 mm"; if left out 0.0.
    """

    file: MeshSource
    scale: Quantity | None = None
    hull: bool | None = None
    thickness: Quantity | None = None


@dataclass(kw_only=True)
class Obstacle(Part):
    """An obstacle.

    box: A box around the origin of its axes; for example {"size": ["20 mm", "20 mm", "20 mm"]}.
    sphere: A sphere around the origin; for example {"radius": "10 mm"}.
    cylinder: A cylinder about z; for example {"radius": "10 mm", "length": "50 mm"}.
    capsule: All within a radius of a segment along z; for example {"radius": "5 mm", "length": "30 mm"}.
    mesh: A surface of triangles, closed or with a thickness, in the axes of its file; for example {"file": "part.stl"}.
    plane: A half-space; given by its surface; for example {"point": [0, 0, 0], "normal": [0, 0, 1]}.
    pose: Where it stands; for example {"translate": [0, 0, "10 mm"]}.
    frame: The frame that carries it; for example "hand".
    """

    box: BoxShape | Tree | None = field(default=None, metadata={"kinds": ("BoxShape",)})
    sphere: SphereShape | Tree | None = field(default=None, metadata={"kinds": ("SphereShape",)})
    cylinder: CylinderShape | Tree | None = field(default=None, metadata={"kinds": ("CylinderShape",)})
    capsule: CapsuleShape | Tree | None = field(default=None, metadata={"kinds": ("CapsuleShape",)})
    mesh: MeshShape | Tree | None = field(default=None, metadata={"kinds": ("MeshShape",)})
    plane: PlaneShape | Tree | None = field(default=None, metadata={"kinds": ("PlaneShape",)})
    pose: Pose | Tree | None = field(default=None, metadata={"kinds": ("Pose",)})
    frame: str | None = None


@dataclass(kw_only=True)
class PlaneShape(Part):
    """A half-space; given by its surface.

    normal: The direction out of the ground; for example [0, 0, 1].
    point: A point of it [m]; for example [0, 0, "-160 mm"]; if left out [0.0, 0.0, 0.0].
    """

    normal: Vector
    point: Vector | None = None


@dataclass(kw_only=True)
class Contact(Part):
    """How bodies and obstacles meet each other, solids and rods; friction is 0.5 if left out.

    friction: Coulomb's coefficient of all pairs; for example 0.5; if left out 0.5.
    restitution: How much of its speed any hit gives back; for example 0.3; if left out 0.0.
    pairs: Pairs of objects with rules of their own; for example [{"between": ["cube", "floor"], "friction": 0.08}].
    """

    friction: Quantity | None = None
    restitution: Quantity | None = None
    pairs: list[ContactPair] = field(default_factory=list, metadata={"kinds": ("ContactPair",)})


@dataclass(kw_only=True)
class ContactPair(Part):
    """A pair of objects.

    between: The names of the two; a solid named twice meets itself; for example ["cube", "floor"].
    friction: Coulomb's coefficient between them; for example 0.5.
    restitution: How much of its speed a hit gives back; for example 0.3.
    off: They pass through each other; for example true; if left out false.
    """

    between: Sequence[str]
    friction: Quantity | None = None
    restitution: Quantity | None = None
    off: bool | None = None


@dataclass(kw_only=True)
class Slide(Part):
    """A rod that slides through a solid.

    rod: The rod that slides; for example "cable".
    solid: The solid it slides in; for example "finger".
    points: Their number from base to tip, or their ascending abscissae [m]; for example 15; if left out 2.
    channel: The points in the solid that the rod runs through, at rest [m]; for example [["10 mm", 0, "2 mm"], ["90
        mm", 0, "2 mm"]].
    anchor_tip: What holds the tip: its position, its pose, or none; for example "position"; if left out "position".
    friction: Coulomb's coefficient between the rod and its channel; 0 if left out; for example 0.1; if left out 0.0.
    reach: How far outside the mesh a point may lie [m]; for example "2 mm".
    """

    _kind: ClassVar[str] = "slide"

    rod: str
    solid: str
    points: int | Vector | None = None
    channel: Matrix | None = None
    anchor_tip: Literal["none", "position", "pose"] | None = None
    friction: Quantity | None = None
    reach: Quantity | None = None


@dataclass(kw_only=True)
class Tie(Part):
    """A point of a rod that is held.

    rod: The rod whose point is held; for example "cable".
    at: The abscissa of that point [m]; `tip`, as if left out, is its tip; for example "50 mm".
    frame: The frame that holds it; the ground if there is no frame, solid, body or other; for example "hand".
    solid: The solid that holds it; for example "finger".
    body: The rigid body that holds it; for example "disc".
    other: The other rod that holds it; for example "spine".
    other_at: The abscissa on the other rod [m]; `tip`, as if left out, is its tip; for example "50 mm".
    along: The axes of the holder along which it is held; for example ["x", "y", "z"]; if left out ["x", "y", "z"].
    about: The axes of the holder about which it is held; for example ["x", "y", "z"].
    reach: How far outside the solid's mesh the point may lie [m]; for example "2 mm".
    """

    _kind: ClassVar[str] = "tie"

    rod: str
    at: Literal["tip"] | Quantity | None = None
    frame: str | None = None
    solid: str | None = None
    body: str | None = None
    other: str | None = None
    other_at: Literal["tip"] | Quantity | None = None
    along: Sequence[Literal["x", "y", "z"]] | None = None
    about: Sequence[Literal["x", "y", "z"]] | None = None
    reach: Quantity | None = None


@dataclass(kw_only=True)
class Glue(Part):
    """Nodes of a solid that a rigid body carries.

    solid: The solid that is glued; for example "finger".
    body: The rigid body that carries it; for example "plate".
    box: The lower and the upper corner of a box [m]; for example [[0, 0, 0], ["5 mm", "1 cm", "1 cm"]].
    sphere: A sphere; for example {"center": [0, 0, "10 mm"], "radius": "5 mm"}.
    plane: A plane, with what lies on it; for example {"point": [0, 0, 0], "normal": [1, 0, 0]}.
    nodes: Node numbers of the mesh file, from 0; for example [0, 3, 17].
    group: What the mesh file has given this name: a physical group, or a cell tag; for example "base".
    surface: True: the whole boundary; for example true.
    in_: Where the region is given, in the object before its pose or the world; for example "world".
    """

    _kind: ClassVar[str] = "glue"

    solid: str
    body: str
    box: Matrix | None = None
    sphere: Sphere | Tree | None = field(default=None, metadata={"kinds": ("Sphere",)})
    plane: Plane | Tree | None = field(default=None, metadata={"kinds": ("Plane",)})
    nodes: Sequence[int] | None = None
    group: str | None = None
    surface: Literal[True] | None = None
    in_: Literal["object", "world"] | None = None


@dataclass(kw_only=True)
class Actuator(Part):
    """An actuator.

    rod: The rod that it moves; for example "cable".
    motion: Along the axis or about it; follows from what is driven; for example "translation"; if left out
        "translation".
    axis: The axis of the base along or about which it moves; along -x or about x if left out; for example "y".
    tendon: The tendon in the rod that it pulls, instead of moving the base; for example {"distance": "10 mm", "angle":
        "90 deg"}.
    force: The force that it exerts [N], pulling if there is no axis: a value, a table over time, `external` or
        `inverse`; for example "3 N".
    displacement: How far it pulls or moves [m]: a value, a table over time, `external` or `inverse`; for example
        {"times": [0, 1], "values": [0, "20 mm"]}.
    torque: The torque it exerts about the axis [N m]: a value, a table over time, `external` or `inverse`; for example
        "20 mN m".
    angle: How far it turns the base [rad]: a value, a table over time, `external` or `inverse`; for example {"times":
        [0, 1], "values": [0, "90 deg"]}.
    tension: The tension of the tendon [N], another word for its force: a value, a table over time, `external` or
        `inverse`; for example "3 N".
    limits: What it can do, to which the inverse keeps; for example {"force": ["0 N", "20 N"]}.
    preferred: The force that it takes where targets leave a choice [N]; as little as possible if left out; for example
        "1 N".
    """

    rod: str
    motion: Literal["translation", "rotation"] | None = None
    axis: Literal["x", "y", "z"] | None = None
    tendon: Tendon | Tree | None = field(default=None, metadata={"kinds": ("Tendon",)})
    force: Quantity | Literal["external"] | Table | Tree | FileTable | Formula | Literal["inverse"] | None = field(default=None, metadata={"kinds": ("Table", "FileTable", "Formula",)})
    displacement: Quantity | Literal["external"] | Table | Tree | FileTable | Formula | Literal["inverse"] | None = field(default=None, metadata={"kinds": ("Table", "FileTable", "Formula",)})
    torque: Quantity | Literal["external"] | Table | Tree | FileTable | Formula | Literal["inverse"] | None = field(default=None, metadata={"kinds": ("Table", "FileTable", "Formula",)})
    angle: Quantity | Literal["external"] | Table | Tree | FileTable | Formula | Literal["inverse"] | None = field(default=None, metadata={"kinds": ("Table", "FileTable", "Formula",)})
    tension: Quantity | Literal["external"] | Table | Tree | FileTable | Formula | Literal["inverse"] | None = field(default=None, metadata={"kinds": ("Table", "FileTable", "Formula",)})
    limits: Limits | Tree | None = field(default=None, metadata={"kinds": ("Limits",)})
    preferred: Quantity | None = None


@dataclass(kw_only=True)
class Tendon(Part):
    """The tendon in the rod that it pulls, instead of moving the base.

    distance: Its distance from the centreline [m], or a pair [start, end]; for example "10 mm".
    from_: The abscissa where it enters the rod [m]; for example "10 mm"; if left out 0.0.
    to: The abscissa where it ends [m]; the tip if left out; for example "90 mm".
    angle: Its angle in the cross-section from y towards z [rad], or a pair [start, end]; for example "30 deg"; if left
        out 0.0.
    """

    distance: Quantity | Vector
    from_: Quantity | None = None
    to: Quantity | None = None
    angle: Quantity | Vector | None = None


@dataclass(kw_only=True)
class Table(Part):
    """A table over time.

    times: The ascending times of the values [s]; for example [0, 1].
    values: The value at each time [N], linear in between; for example [0, 0.02].
    """

    times: Vector
    values: Vector


@dataclass(kw_only=True)
class FileTable(Part):
    """A table in a file.

    file: A CSV file whose first row names its columns, from the scene's folder; for example "out/signals.csv".
    column: The column of the values, in SI units; for example "pull.force".
    time: The column of the times [s]; for example "time"; if left out "time".
    """

    file: str
    column: str
    time: str | None = None


@dataclass(kw_only=True)
class Formula(Part):
    """A formula.

    formula: The value in SI units as a formula of the time t [s]; for example "0.01 * sin(2 * pi * t)".
    """

    formula: str | Sequence[str]


@dataclass(kw_only=True)
class Limits(Part):
    """What it can do, to which the inverse keeps.

    force: The least and most force [N]; of what pulls the least is 0 if left out; for example ["0.5 N", "20 N"].
    tension: The least and most tension of a tendon [N], another word for its force; for example ["0.5 N", "20 N"].
    torque: The least and most torque of what turns [N m]; for example ["-20 mN m", "20 mN m"].
    displacement: The least and most displacement [m]; for example ["0 mm", "30 mm"].
    angle: The least and most angle of what turns [rad]; for example ["-90 deg", "90 deg"].
    speed: How fast it moves at most [m/s]; for example "50 mm/s".
    turning_speed: How fast it turns at most [rad/s]; for example "90 deg/s".
    force_rate: How fast its force changes at most [N/s]; for example "20 N/s".
    """

    force: Vector | Span | Tree | None = field(default=None, metadata={"kinds": ("Span",)})
    tension: Vector | Span | Tree | None = field(default=None, metadata={"kinds": ("Span",)})
    torque: Vector | Span | Tree | None = field(default=None, metadata={"kinds": ("Span",)})
    displacement: Vector | Span | Tree | None = field(default=None, metadata={"kinds": ("Span",)})
    angle: Vector | Span | Tree | None = field(default=None, metadata={"kinds": ("Span",)})
    speed: Quantity | None = None
    turning_speed: Quantity | None = None
    force_rate: Quantity | None = None


@dataclass(kw_only=True)
class Span(Part):
    """Limits.

    least: The least [N]; for example 0.
    most: The most [N]; for example 10.
    """

    least: Quantity | None = None
    most: Quantity | None = None


@dataclass(kw_only=True)
class RodLoad(Part):
    """A load.

    rod: The rod that is loaded; for example "cable".
    at: The abscissa of a point load [m]; `tip`, as if left out, is the tip; for example "50 mm".
    from_: The abscissa where a distributed load begins [m]; for example 0.
    to: The abscissa where a distributed load ends [m]; for example "100 mm".
    force: The force [N], of a distributed load per length [N/m]; for example [0, 0, "-1 N"].
    moment: The moment [N m], of a distributed load per length [N]; for example [0, "20 mN m", 0].
    follower: In the axes of the turning cross-section instead of the world's; for example true; if left out false.
    factor: What both are multiplied by: a number, a table over time or `external`; for example {"times": [0, 1],
        "values": [0, 1]}.
    """

    rod: str
    at: Literal["tip"] | Quantity | None = None
    from_: Quantity | None = None
    to: Quantity | None = None
    force: Vector | None = None
    moment: Vector | None = None
    follower: bool | None = None
    factor: Quantity | Literal["external"] | Table | Tree | FileTable | Formula | None = field(default=None, metadata={"kinds": ("Table", "FileTable", "Formula",)})


@dataclass(kw_only=True)
class SolidLoad(Part):
    """A load.

    solid: The solid that is loaded; for example "finger".
    box: The lower and the upper corner of a box [m]; for example [[0, 0, 0], ["5 mm", "1 cm", "1 cm"]].
    sphere: A sphere; for example {"center": [0, 0, "10 mm"], "radius": "5 mm"}.
    plane: A plane, with what lies on it; for example {"point": [0, 0, 0], "normal": [1, 0, 0]}.
    nodes: Node numbers of the mesh file, from 0; for example [0, 3, 17].
    group: What the mesh file has given this name: a physical group, or a cell tag; for example "base".
    surface: True: the whole boundary; for example true.
    in_: Where the region is given, in the object before its pose or the world; for example "world".
    force: The force in all [N], spread evenly over the region's surface; for example [0, 0, "-1 N"]; if left out [0.0,
        0.0, 0.0].
    pressure: The pressure [Pa] on the region's surface, which it follows; negative: suction; for example "20 kPa"; if
        left out 0.0.
    factor: What both are multiplied by: a number, a table over time or `external`; for example {"times": [0, 1],
        "values": [0, 1]}.
    """

    solid: str
    box: Matrix | None = None
    sphere: Sphere | Tree | None = field(default=None, metadata={"kinds": ("Sphere",)})
    plane: Plane | Tree | None = field(default=None, metadata={"kinds": ("Plane",)})
    nodes: Sequence[int] | None = None
    group: str | None = None
    surface: Literal[True] | None = None
    in_: Literal["object", "world"] | None = None
    force: Vector | None = None
    pressure: Quantity | None = None
    factor: Quantity | Literal["external"] | Table | Tree | FileTable | Formula | None = field(default=None, metadata={"kinds": ("Table", "FileTable", "Formula",)})


@dataclass(kw_only=True)
class Output(Part):
    """An output.

    solid: The solid whose point is recorded; for example "finger".
    point: The point of the solid [m]; for example ["100 mm", 0, 0]; if left out [0.0, 0.0, 0.0].
    in_: Where point is given, in the object before its pose or the world; for example "world"; if left out "object".
    reach: How far outside the mesh the point may lie [m]; for example "2 mm".
    body: The rigid body that is recorded: its centre of mass, or the force on it; for example "cube".
    between: Two objects, of which is recorded how they touch; for example ["cube", "floor"].
    rod: The rod whose point is recorded; for example "cable".
    at: The abscissa of the point on the rod [m]; `tip`, as if left out, is its tip; for example "100 mm".
    quantity: What is recorded there: of a solid `position`, `displacement`, `orientation`, `strain`, `stress` or
        `reaction`; of a rod `position`, `orientation`, `strain`, `force`, `moment` or `stress`; of a body `position`,
        `orientation` or `force`. An orientation is how it has turned since the start, a reaction the force on what is
        held in `region`, the force on a body that of all that touches it; for example "strain"; if left out "position".
    region: Whose held nodes a reaction is summed over; all of them if left out; for example {"box": [[0, 0, 0], ["5
        mm", "1 cm", "1 cm"]]}.
    """

    solid: str | None = None
    point: Vector | None = None
    in_: Literal["object", "world"] | None = None
    reach: Quantity | None = None
    body: str | None = None
    between: Sequence[str] | None = None
    rod: str | None = None
    at: Literal["tip"] | Quantity | None = None
    quantity: Literal["position", "displacement", "orientation", "strain", "force", "moment", "stress", "reaction"] | None = None
    region: Region | Tree | None = field(default=None, metadata={"kinds": ("Region",)})


@dataclass(kw_only=True)
class Region(Part):
    """Whose held nodes a reaction is summed over; all of them if left out.

    box: The lower and the upper corner of a box [m]; for example [[0, 0, 0], ["5 mm", "1 cm", "1 cm"]].
    sphere: A sphere; for example {"center": [0, 0, "10 mm"], "radius": "5 mm"}.
    plane: A plane, with what lies on it; for example {"point": [0, 0, 0], "normal": [1, 0, 0]}.
    nodes: Node numbers of the mesh file, from 0; for example [0, 3, 17].
    group: What the mesh file has given this name: a physical group, or a cell tag; for example "base".
    surface: True: the whole boundary; for example true.
    in_: Where the region is given, in the object before its pose or the world; for example "world".
    """

    box: Matrix | None = None
    sphere: Sphere | Tree | None = field(default=None, metadata={"kinds": ("Sphere",)})
    plane: Plane | Tree | None = field(default=None, metadata={"kinds": ("Plane",)})
    nodes: Sequence[int] | None = None
    group: str | None = None
    surface: Literal[True] | None = None
    in_: Literal["object", "world"] | None = None


@dataclass(kw_only=True)
class Target(Part):
    """A target.

    at: Where it is to be: a value, a table over time or `external`; of a position [x, y, z] [m], of an orientation the
        turn since the start as a rotation vector [rad], of a strain one number [1/m], of an output `between` two how
        hard they press [N]; for example ["120 mm", 0, "30 mm"].
    strain: Which strain of the output, where that is one; for example "bending_y"; if left out "bending_y".
    weights: How much each component matters, 0 where it may be anything; all 1 if left out; for example [1, 1, 0].
    tolerance: How far off still counts as reached; 0.1 mm, 0.1 deg, 0.1 1/m, 0.1 % or 0.01 N if left out; for example
        "0.5 mm".
    """

    at: Vector | Track | Tree | FileTrack | Formula | Quantity | FileTable | Literal["external"] = field(metadata={"kinds": ("Track", "FileTrack", "Formula", "FileTable",)})
    strain: Literal["torsion", "bending_y", "bending_z", "elongation", "shear_y", "shear_z"] | None = None
    weights: Vector | None = None
    tolerance: Quantity | None = None


@dataclass(kw_only=True)
class Track(Part):
    """A table over time.

    times: The ascending times of the values [s]; for example [0, 1].
    values: The value at each time [m], linear in between; for example [[0, 0, 0], [0, "10 mm", 0]].
    """

    times: Vector
    values: Matrix | Vector


@dataclass(kw_only=True)
class FileTrack(Part):
    """A table in a file.

    file: A CSV file whose first row names its columns, from the scene's folder; for example "out/signals.csv".
    columns: The columns of x, y and z, in SI units; for example ["tip.x", "tip.y", "tip.z"].
    time: The column of the times [s]; for example "time"; if left out "time".
    """

    file: str
    columns: Sequence[str]
    time: str | None = None
