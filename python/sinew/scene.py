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
    """A whole scene."""

    title: str | None = None
    """What the scene shows, in a line; for example "A finger pulled by one cable"."""
    time: Time | Tree | None = field(default=None, metadata={"kinds": ("Time",)})
    """The time step and the duration; for example {"step": "10 ms", "duration": "2 s"}."""
    gravity: Vector | None = None
    """The acceleration of free fall [m/s^2]; for example [0, -9.81, 0]; if left out [0.0, 0.0, 0.0]."""
    analysis: Literal["dynamic", "quasi_static", "static", "modal"] | None = None
    """What is computed: the motion (dynamic), equilibria over time (quasi_static) or at the end (static), or natural
    frequencies at the start (modal); for example "static"; if left out "dynamic"."""
    modes: int | None = None
    """The number of modes of a modal analysis; for example 6; if left out 6."""
    newton: Literal["converged"] | int | Newton | Tree | None = field(default=None, metadata={"kinds": ("Newton",)})
    """How a step is solved: `converged`, a number of linearisations (1 is a linearised step), or a map; for example
    "converged"."""
    view: View | Tree | None = field(default=None, metadata={"kinds": ("View",)})
    """What is written for ParaView; for example {"interval": "20 ms"}."""
    frames: Mapping[str, Frame | Tree] | None = field(default=None, metadata={"kinds": ("Frame",), "named": True})
    """Frames by name, which may move and carry solids and rods; for example {"hand": {"pose": {"translate": [0, "20
    mm", 0]}}}."""
    solids: Mapping[str, Solid | Tree] | None = field(default=None, metadata={"kinds": ("Solid",), "named": True})
    """Soft bodies by name; for example {"finger": {"mesh": "finger.vtk", "mass": "75 g", "material": {"young": "600
    kPa", "poisson": 0.45}}}."""
    rods: Mapping[str, Rod | Tree] | None = field(default=None, metadata={"kinds": ("Rod",), "named": True})
    """Rods and cables by name; for example {"cable": {"path": [[0, 0, 0], ["100 mm", 0, 0]], "section": {"circle":
    {"radius": "0.5 mm"}}, "material": {"young": "5 GPa", "poisson": 0.4, "density": 1100}}}."""
    bodies: Mapping[str, RigidBody | Tree] | None = field(default=None, metadata={"kinds": ("RigidBody",), "named": True})
    """Rigid bodies by name; for example {"cube": {"box": {"size": ["20 mm", "20 mm", "20 mm"]}, "mass": "30 g"}}."""
    obstacles: Mapping[str, Obstacle | Tree] | None = field(default=None, metadata={"kinds": ("Obstacle",), "named": True})
    """What stands still or is carried by a frame, by name; for example {"floor": {"plane": {"normal": [0, 0, 1]}}}."""
    contact: Contact | Tree | None = field(default=None, metadata={"kinds": ("Contact",)})
    """How bodies and obstacles meet each other, solids and rods; friction is 0.5 if left out; for example {"friction":
    0.3}."""
    couplings: Sequence[Slide | Tie | Glue | Tree] | None = field(default=None, metadata={"kinds": ("Slide", "Tie", "Glue",)})
    """What ties rods to solids, frames, the ground and each other; for example [{"slide": {"rod": "cable", "solid":
    "finger", "points": 15}}]."""
    actuators: Mapping[str, Actuator | Tree] | None = field(default=None, metadata={"kinds": ("Actuator",), "named": True})
    """What moves rods: their bases or tendons in them, by name; for example {"pull": {"rod": "cable", "displacement":
    "20 mm"}}."""
    loads: Mapping[str, RodLoad | Tree | SolidLoad] | None = field(default=None, metadata={"kinds": ("RodLoad", "SolidLoad",), "named": True})
    """Forces and moments on rods, by name; for example {"weight": {"rod": "cable", "force": [0, 0, "-1 N"]}}."""
    outputs: Mapping[str, Output | Tree] | None = field(default=None, metadata={"kinds": ("Output",), "named": True})
    """What is recorded of points of solids and rods, by name; for example {"tip": {"solid": "finger", "point": ["100
    mm", 0, 0]}}."""
    targets: Mapping[str, Target | Tree] | None = field(default=None, metadata={"kinds": ("Target",), "named": True})
    """Where outputs are to be brought by the actuators that are `inverse`, by the names of the outputs; for example
    {"tip": {"at": ["120 mm", 0, "30 mm"]}}."""
    folder: str | os.PathLike[str] = field(default=".", metadata={"not_a_key": True})
    """Where files that the scene names are looked for."""


@dataclass(kw_only=True)
class Time(Part):
    """The time step and the duration."""

    step: Quantity | None = None
    """The time step [s]; for example "10 ms"; if left out 0.01."""
    duration: Quantity | None = None
    """The time at which the run ends [s]; for example "2 s"; if left out 1.0."""


@dataclass(kw_only=True)
class Newton(Part):
    """Newton."""

    iterations: Literal["converged"] | int | None = None
    """`converged`, or the number of linearisations in every step; for example "converged"; if left out "converged"."""
    limit: int | None = None
    """The number of linearisations after which a step is halved; for example 25; if left out 25."""
    tolerance: Quantity | None = None
    """The relative residual at which a step is converged; for example 1e-09; if left out 1e-09."""
    precision: Literal["double", "single"] | None = None
    """The precision of factors of solids: `single` takes half the memory, and less time from some 100 000 elements on;
    solutions are refined to double precision all the same; for example "double"; if left out "double"."""


@dataclass(kw_only=True)
class View(Part):
    """What is written for ParaView."""

    interval: Quantity | None = None
    """The time between views for ParaView [s], 0 for about 100 in a run; for example "20 ms"; if left out 0.0."""


@dataclass(kw_only=True)
class Frame(Part):
    """A frame."""

    pose: Pose | Tree | None = field(default=None, metadata={"kinds": ("Pose",)})
    """Where the frame stands at rest; for example {"translate": [0, "20 mm", 0]}."""
    motion: FrameMotion | Tree | None = field(default=None, metadata={"kinds": ("FrameMotion",)})
    """How the frame moves over time; for example {"times": [0, 1], "translate": [[0, 0, 0], [0, "20 mm", 0]]}."""


@dataclass(kw_only=True)
class Pose(Part):
    """Where the frame stands at rest."""

    rotate: Vector | None = None
    """The angles [a, b, c] of R = Rz(c) Ry(b) Rx(a) [rad]; for example [0, 0, "90 deg"]; if left out [0.0, 0.0,
    0.0]."""
    translate: Vector | None = None
    """The shift after the rotation [m]; for example [0, "20 mm", 0]; if left out [0.0, 0.0, 0.0]."""


@dataclass(kw_only=True)
class FrameMotion(Part):
    """How the frame moves over time."""

    times: Vector
    """The ascending times of the entries below [s]; for example [0, 2]."""
    rotate: Matrix | None = None
    """The angles [a, b, c] at each time [rad]; for example [[0, 0, 0], [0, 0, 1]]."""
    translate: Matrix | None = None
    """The shift at each time [m]; for example [[0, 0, 0], [0, "20 mm", 0]]."""


@dataclass(kw_only=True)
class Solid(Part):
    """A solid."""

    mesh: MeshSource
    """The file with its elements, looked up from the scene's folder; for example "finger.vtk"."""
    material: SolidMaterial | Tree = field(metadata={"kinds": ("SolidMaterial",)})
    """What it is made of; for example {"young": "600 kPa", "poisson": 0.45}."""
    scale: Quantity | None = None
    """What mesh coordinates are multiplied by to be in m; for example 0.001; if left out 1.0."""
    order: int | None = None
    """Of its elements: 1 as the file has them, 2 with 10-node tetrahedra in place of 4-node ones; for example 2; if
    left out 1."""
    pose: Pose | Tree | None = field(default=None, metadata={"kinds": ("Pose",)})
    """Where the solid stands, after scale; for example {"translate": [0, "20 mm", 0]}."""
    frame: str | None = None
    """The frame that carries it and its pose; for example "hand"."""
    mass: Quantity | None = None
    """Its total mass [kg], instead of density; for example "75 g"."""
    density: Quantity | None = None
    """Its density [kg/m^3], instead of mass; for example "1100 kg/m^3"."""
    rayleigh: Rayleigh | Tree | None = field(default=None, metadata={"kinds": ("Rayleigh",)})
    """Its damping; for example {"mass": 0.1, "stiffness": 0.1}."""
    mass_matrix: Literal["lumped", "consistent"] | None = None
    """Lumped at the nodes, or consistent; none: consistent with 10-node tetrahedra, else lumped; for example
    "lumped"."""
    parts: Sequence[SolidPart | Tree] | None = field(default=None, metadata={"kinds": ("SolidPart",)})
    """Regions of another material; for example [{"group": "bone", "material": {"young": "1 GPa", "poisson": 0.3}}]."""
    fixed: Held | Tree | Sequence[Held | Tree] | None = field(default=None, metadata={"kinds": ("Held",)})
    """A region, or a list of regions, whose nodes are held; for example {"box": [[0, 0, 0], ["5 mm", "1 cm", "1
    cm"]]}."""
    springs: Sequence[Spring | Tree] | None = field(default=None, metadata={"kinds": ("Spring",)})
    """Springs to where it is at rest; for example [{"surface": true, "stiffness": ["10 N/m", "10 N/m", "10 N/m"]}]."""


@dataclass(kw_only=True)
class SolidMaterial(Part):
    """What it is made of."""

    law: Literal["corotational", "saint_venant_kirchhoff", "neo_hookean", "mooney_rivlin", "ogden"] | None = None
    """The constitutive law; for example "corotational"; if left out "corotational"."""
    young: Quantity | None = None
    """Young's modulus [Pa]; for example "600 kPa"; if left out 0.0."""
    poisson: Quantity | None = None
    """Poisson's ratio; for example 0.45; if left out 0.0."""
    c10: Quantity | None = None
    """Its first constant [Pa]; for example "80 kPa"; if left out 0.0."""
    c01: Quantity | None = None
    """Its second constant [Pa]; for example "20 kPa"; if left out 0.0."""
    mu: Vector | None = None
    """Its moduli [Pa]; for example ["630 kPa", "1.2 kPa", "-10 kPa"]."""
    alpha: Vector | None = None
    """Its powers; for example [1.3, 5, -2]."""
    bulk: Quantity | None = None
    """The bulk modulus [Pa]; for example "50 MPa"."""
    viscosity: Quantity | None = None
    """Its viscosity against shear [Pa s]; 4/3 (1 + nu)^2 of it against extension; for example "300 Pa s"; if left out
    0.0."""
    density: Quantity | None = None
    """Its density [kg/m^3], instead of the solid's; for example "1100 kg/m^3"."""


@dataclass(kw_only=True)
class Rayleigh(Part):
    """Its damping."""

    mass: Quantity | None = None
    """The damping per mass [1/s]; for example "0.1 1/s"; if left out 0.0."""
    stiffness: Quantity | None = None
    """The damping per stiffness [s]; for example "10 ms"; if left out 0.0."""


@dataclass(kw_only=True)
class SolidPart(Part):
    """A part of a solid."""

    material: SolidMaterial | Tree = field(metadata={"kinds": ("SolidMaterial",)})
    """What it is made of; for example {"young": "2 MPa", "poisson": 0.45}."""
    box: Matrix | None = None
    """The lower and the upper corner of a box [m]; for example [[0, 0, 0], ["5 mm", "1 cm", "1 cm"]]."""
    sphere: Sphere | Tree | None = field(default=None, metadata={"kinds": ("Sphere",)})
    """A sphere; for example {"center": [0, 0, "10 mm"], "radius": "5 mm"}."""
    plane: Plane | Tree | None = field(default=None, metadata={"kinds": ("Plane",)})
    """A plane, with what lies on it; for example {"point": [0, 0, 0], "normal": [1, 0, 0]}."""
    nodes: Sequence[int] | None = None
    """Node numbers of the mesh file, from 0; for example [0, 3, 17]."""
    group: str | None = None
    """What the mesh file has given this name: a physical group, or a cell tag; for example "base"."""
    surface: Literal["True"] | None = None
    """True: the whole boundary; for example true."""
    in_: Literal["object", "world"] | None = None
    """Where the region is given, in the object before its pose or the world; for example "world"."""


@dataclass(kw_only=True)
class Sphere(Part):
    """A sphere."""

    center: Vector
    """Its centre [m]; for example [0, 0, "10 mm"]."""
    radius: Quantity
    """Its radius [m]; for example "5 mm"."""


@dataclass(kw_only=True)
class Plane(Part):
    """A plane, with what lies on it."""

    point: Vector
    """A point of it [m]; for example [0, 0, 0]."""
    normal: Vector
    """The direction across it; for example [1, 0, 0]."""
    within: Quantity | None = None
    """How far to either side nodes still count [m]; for example "0.1 mm"."""


@dataclass(kw_only=True)
class Held(Part):
    """A region."""

    box: Matrix | None = None
    """The lower and the upper corner of a box [m]; for example [[0, 0, 0], ["5 mm", "1 cm", "1 cm"]]."""
    sphere: Sphere | Tree | None = field(default=None, metadata={"kinds": ("Sphere",)})
    """A sphere; for example {"center": [0, 0, "10 mm"], "radius": "5 mm"}."""
    plane: Plane | Tree | None = field(default=None, metadata={"kinds": ("Plane",)})
    """A plane, with what lies on it; for example {"point": [0, 0, 0], "normal": [1, 0, 0]}."""
    nodes: Sequence[int] | None = None
    """Node numbers of the mesh file, from 0; for example [0, 3, 17]."""
    group: str | None = None
    """What the mesh file has given this name: a physical group, or a cell tag; for example "base"."""
    surface: Literal["True"] | None = None
    """True: the whole boundary; for example true."""
    in_: Literal["object", "world"] | None = None
    """Where the region is given, in the object before its pose or the world; for example "world"."""
    axes: Sequence[Literal["x", "y", "z"]] | None = None
    """The axes of the world along which it is held; for example ["x", "y"]; if left out ["x", "y", "z"]."""
    frame: str | None = None
    """The frame that holds and moves it; the solid's own; for example "hand"."""


@dataclass(kw_only=True)
class Spring(Part):
    """Springs."""

    stiffness: Vector
    """Along x, y and z, all nodes together [N/m]; for example [0, 0, "200 N/m"]."""
    box: Matrix | None = None
    """The lower and the upper corner of a box [m]; for example [[0, 0, 0], ["5 mm", "1 cm", "1 cm"]]."""
    sphere: Sphere | Tree | None = field(default=None, metadata={"kinds": ("Sphere",)})
    """A sphere; for example {"center": [0, 0, "10 mm"], "radius": "5 mm"}."""
    plane: Plane | Tree | None = field(default=None, metadata={"kinds": ("Plane",)})
    """A plane, with what lies on it; for example {"point": [0, 0, 0], "normal": [1, 0, 0]}."""
    nodes: Sequence[int] | None = None
    """Node numbers of the mesh file, from 0; for example [0, 3, 17]."""
    group: str | None = None
    """What the mesh file has given this name: a physical group, or a cell tag; for example "base"."""
    surface: Literal["True"] | None = None
    """True: the whole boundary; for example true."""
    in_: Literal["object", "world"] | None = None
    """Where the region is given, in the object before its pose or the world; for example "world"."""


@dataclass(kw_only=True)
class Rod(Part):
    """A rod."""

    path: Matrix
    """The points from base to tip [m]; for example [[0, 0, 0], ["100 mm", 0, 0]]."""
    in_: Literal["object", "world"] | None = None
    """Where path is given, in the object before its pose or the world; for example "world"; if left out "object"."""
    up: Vector | None = None
    """The direction of the base's y axis; z, or y if the path starts along z; for example [0, 0, 1]."""
    pose: Pose | Tree | None = field(default=None, metadata={"kinds": ("Pose",)})
    """Where the rod stands; for example {"translate": [0, "20 mm", 0]}."""
    frame: str | None = None
    """The frame that carries its base; for example "hand"."""
    cable: Literal["cosserat", "geometric"] | None = None
    """Cosserat for a rod with stiffness, geometric for a massless cable without any; for example "cosserat"; if left
    out "cosserat"."""
    sections: int | Vector | None = None
    """Their number, or the ascending ends of all from 0 to the length [m]; for example 15; if left out 1."""
    strains: Sequence[Literal["torsion", "bending_y", "bending_z", "elongation", "shear_y", "shear_z"]] | None = None
    """The strains that may vary; for example ["torsion", "bending_y", "bending_z"]; if left out ["torsion",
    "bending_y", "bending_z"]."""
    order: int | Orders | Tree | None = field(default=None, metadata={"kinds": ("Orders",)})
    """The Legendre order of the strains in a section, 0 (constant) to 5: one for all that vary, or some by name; for
    example {"torsion": 1, "bending_y": 2}; if left out 0."""
    rest: Literal["path", "straight"] | StrainTable | Tree | None = field(default=None, metadata={"kinds": ("StrainTable",)})
    """The stress-free shape: along the path, straight, or strains, constant or over the abscissae `at`; for example
    {"at": [0, "50 mm"], "bending_z": [0, "20 1/m"]}; if left out "path"."""
    start: Literal["path", "rest"] | None = None
    """How it lies at the start: bent to its path, or stress-free (rest, the default if `rest` is a map); for example
    "rest"."""
    base: Literal["clamped", "free"] | Sequence[Literal["x", "y", "z", "turn_x", "turn_y", "turn_z"]] | None = None
    """Clamped, free, or a list of the free motions of the base; for example ["x", "turn_z"]; if left out "clamped"."""
    section: Circle | Tube | Ellipse | Rectangle | StiffnessSection | Tree | None = field(default=None, metadata={"kinds": ("Circle", "Tube", "Ellipse", "Rectangle", "StiffnessSection",)})
    """The shape across; for example {"circle": {"radius": "0.5 mm"}}."""
    material: RodMaterial | Tree | None = field(default=None, metadata={"kinds": ("RodMaterial",)})
    """What it is made of; for example {"young": "5 GPa", "poisson": 0.4, "density": 1100}."""
    parts: Sequence[RodPart | Tree] | None = field(default=None, metadata={"kinds": ("RodPart",)})
    """Pieces with a section and a material each, instead of those of the whole rod; for example [{"to": "0.3 m",
    "section": {"circle": {"radius": "1 mm"}}, "material": {"young": "5 GPa", "poisson": 0.4, "density": 1100}}]."""


@dataclass(kw_only=True)
class Orders(Part):
    """An order."""

    torsion: int | None = None
    """Its Legendre order in a section; for example 1; if left out 0."""
    bending_y: int | None = None
    """Its Legendre order in a section; for example 1; if left out 0."""
    bending_z: int | None = None
    """Its Legendre order in a section; for example 1; if left out 0."""
    elongation: int | None = None
    """Its Legendre order in a section; for example 1; if left out 0."""
    shear_y: int | None = None
    """Its Legendre order in a section; for example 1; if left out 0."""
    shear_z: int | None = None
    """Its Legendre order in a section; for example 1; if left out 0."""


@dataclass(kw_only=True)
class StrainTable(Part):
    """A rest shape."""

    at: Vector | None = None
    """The ascending abscissae of the values below [m]; for example [0, "50 mm"]."""
    torsion: Quantity | Vector | None = None
    """Its stress-free torsion [1/m]; for example "20 1/m"."""
    bending_y: Quantity | Vector | None = None
    """Its stress-free bending about y [1/m]; for example "20 1/m"."""
    bending_z: Quantity | Vector | None = None
    """Its stress-free bending about z [1/m]; for example "20 1/m"."""
    elongation: Quantity | Vector | None = None
    """Its stress-free stretch minus 1; for example 0.01."""
    shear_y: Quantity | Vector | None = None
    """Its stress-free shear along y; for example 0.01."""
    shear_z: Quantity | Vector | None = None
    """Its stress-free shear along z; for example 0.01."""


@dataclass(kw_only=True)
class Circle(Part):
    """A full circle."""

    _kind: ClassVar[str] = "circle"

    radius: Quantity | Vector
    """Its radius [m], or a pair [start, end]; for example "0.5 mm"."""


@dataclass(kw_only=True)
class Tube(Part):
    """A circle with a hole."""

    _kind: ClassVar[str] = "tube"

    outer: Quantity | Vector
    """Its outer radius [m], or a pair [start, end]; for example "5 mm"."""
    inner: Quantity | Vector
    """Its inner radius [m], or a pair [start, end]; for example "4 mm"."""


@dataclass(kw_only=True)
class Ellipse(Part):
    """A full ellipse."""

    _kind: ClassVar[str] = "ellipse"

    y: Quantity | Vector
    """Its half axis along y [m], or a pair [start, end]; for example "2 mm"."""
    z: Quantity | Vector
    """Its half axis along z [m], or a pair [start, end]; for example "1 mm"."""


@dataclass(kw_only=True)
class Rectangle(Part):
    """A full rectangle."""

    _kind: ClassVar[str] = "rectangle"

    y: Quantity | Vector
    """Its side along y [m], or a pair [start, end]; for example "4 mm"."""
    z: Quantity | Vector
    """Its side along z [m], or a pair [start, end]; for example "2 mm"."""


@dataclass(kw_only=True)
class StiffnessSection(Part):
    """A section whose stiffness is known."""

    _kind: ClassVar[str] = "stiffness"

    matrix: Vector | Matrix
    """The stiffness [N m^2, N m, N] against torsion, bending_y, bending_z, elongation, shear_y, shear_z: its diagonal
    or its six rows; for example [0.0004, 0.0005, 0.0005, 4000.0, 1000.0, 1000.0]."""
    line_density: Quantity
    """Its mass per length [kg/m], 0 for a massless rod; for example "1 g/m"."""
    radius: Quantity
    """The radius with which it is drawn and turns [m]; for example "5 mm"."""


@dataclass(kw_only=True)
class RodMaterial(Part):
    """What it is made of."""

    young: Quantity | None = None
    """Young's modulus [Pa]; for example "5 GPa"."""
    poisson: Quantity | None = None
    """Poisson's ratio; for example 0.4."""
    density: Quantity | None = None
    """Its density [kg/m^3], 0 for a massless rod; for example "1100 kg/m^3"."""
    viscosity: Quantity | None = None
    """Its viscosity against shear [Pa s]; three times as much against extension; for example "300 Pa s"; if left out
    0.0."""
    damping: Quantity | None = None
    """Its damping over its stiffness [s], which adds to viscosity; for example "10 ms"; if left out 0.0."""


@dataclass(kw_only=True)
class RodPart(Part):
    """A part of a rod."""

    to: Quantity
    """The abscissa of its end [m]; of the last one, the rod's length; for example "0.3 m"."""
    section: Circle | Tube | Ellipse | Rectangle | StiffnessSection | Tree = field(metadata={"kinds": ("Circle", "Tube", "Ellipse", "Rectangle", "StiffnessSection",)})
    """The shape across; for example {"circle": {"radius": "0.5 mm"}}."""
    material: RodMaterial | Tree | None = field(default=None, metadata={"kinds": ("RodMaterial",)})
    """What it is made of; for example {"young": "5 GPa", "poisson": 0.4, "density": 1100}."""


@dataclass(kw_only=True)
class RigidBody(Part):
    """A rigid body."""

    box: BoxShape | Tree | None = field(default=None, metadata={"kinds": ("BoxShape",)})
    """A box around the origin of its axes; for example {"size": ["20 mm", "20 mm", "20 mm"]}."""
    sphere: SphereShape | Tree | None = field(default=None, metadata={"kinds": ("SphereShape",)})
    """A sphere around the origin; for example {"radius": "10 mm"}."""
    cylinder: CylinderShape | Tree | None = field(default=None, metadata={"kinds": ("CylinderShape",)})
    """A cylinder about z; for example {"radius": "10 mm", "length": "50 mm"}."""
    capsule: CapsuleShape | Tree | None = field(default=None, metadata={"kinds": ("CapsuleShape",)})
    """All within a radius of a segment along z; for example {"radius": "5 mm", "length": "30 mm"}."""
    mesh: MeshShape | Tree | None = field(default=None, metadata={"kinds": ("MeshShape",)})
    """A closed surface of triangles, in the axes of its file; for example {"file": "part.stl"}."""
    pose: Pose | Tree | None = field(default=None, metadata={"kinds": ("Pose",)})
    """Where its axes are at the start: at its middle, or those of its mesh; for example {"translate": [0, 0, "10
    mm"]}."""
    mass: Quantity | None = None
    """Its mass [kg], instead of density; for example "30 g"."""
    density: Quantity | None = None
    """Its density [kg/m^3], instead of mass; for example "1200 kg/m^3"."""
    velocity: Vector | None = None
    """At the start [m/s]; for example [0, 0, "-1 m/s"]; if left out [0.0, 0.0, 0.0]."""
    spin: Vector | None = None
    """Its angular velocity at the start, about the world's axes [rad/s]; for example [0, 0, "10 rad/s"]; if left out
    [0.0, 0.0, 0.0]."""


@dataclass(kw_only=True)
class BoxShape(Part):
    """A box around the origin of its axes."""

    size: Vector
    """Its edges along x, y and z [m]; for example ["20 mm", "20 mm", "20 mm"]."""


@dataclass(kw_only=True)
class SphereShape(Part):
    """A sphere around the origin."""

    radius: Quantity
    """Its radius [m]; for example "10 mm"."""


@dataclass(kw_only=True)
class CylinderShape(Part):
    """A cylinder about z."""

    radius: Quantity
    """Its radius [m]; for example "10 mm"."""
    length: Quantity
    """Its length [m]; for example "50 mm"."""


@dataclass(kw_only=True)
class CapsuleShape(Part):
    """All within a radius of a segment along z."""

    radius: Quantity
    """Its radius [m]; for example "5 mm"."""
    length: Quantity
    """Its length without the round ends [m]; for example "30 mm"."""


@dataclass(kw_only=True)
class MeshShape(Part):
    """A closed surface of triangles, in the axes of its file."""

    file: MeshSource
    """Its triangles (.stl, .obj, or a volume mesh), looked up from the scene's folder; for example "part.stl"."""
    scale: Quantity | None = None
    """What its coordinates are multiplied by to be in m; for example 0.001; if left out 1.0."""
    hull: bool | None = None
    """The smallest convex body around it instead; for example true; if left out false."""


@dataclass(kw_only=True)
class Obstacle(Part):
    """An obstacle."""

    box: BoxShape | Tree | None = field(default=None, metadata={"kinds": ("BoxShape",)})
    """A box around the origin of its axes; for example {"size": ["20 mm", "20 mm", "20 mm"]}."""
    sphere: SphereShape | Tree | None = field(default=None, metadata={"kinds": ("SphereShape",)})
    """A sphere around the origin; for example {"radius": "10 mm"}."""
    cylinder: CylinderShape | Tree | None = field(default=None, metadata={"kinds": ("CylinderShape",)})
    """A cylinder about z; for example {"radius": "10 mm", "length": "50 mm"}."""
    capsule: CapsuleShape | Tree | None = field(default=None, metadata={"kinds": ("CapsuleShape",)})
    """All within a radius of a segment along z; for example {"radius": "5 mm", "length": "30 mm"}."""
    mesh: MeshShape | Tree | None = field(default=None, metadata={"kinds": ("MeshShape",)})
    """A closed surface of triangles, in the axes of its file; for example {"file": "part.stl"}."""
    plane: PlaneShape | Tree | None = field(default=None, metadata={"kinds": ("PlaneShape",)})
    """A half-space; given by its surface; for example {"point": [0, 0, 0], "normal": [0, 0, 1]}."""
    pose: Pose | Tree | None = field(default=None, metadata={"kinds": ("Pose",)})
    """Where it stands; for example {"translate": [0, 0, "10 mm"]}."""
    frame: str | None = None
    """The frame that carries it; for example "hand"."""


@dataclass(kw_only=True)
class PlaneShape(Part):
    """A half-space; given by its surface."""

    normal: Vector
    """The direction out of the ground; for example [0, 0, 1]."""
    point: Vector | None = None
    """A point of it [m]; for example [0, 0, "-160 mm"]; if left out [0.0, 0.0, 0.0]."""


@dataclass(kw_only=True)
class Contact(Part):
    """How bodies and obstacles meet each other, solids and rods; friction is 0.5 if left out."""

    friction: Quantity | None = None
    """Coulomb's coefficient of all pairs; for example 0.5; if left out 0.5."""
    restitution: Quantity | None = None
    """How much of its speed any hit gives back; for example 0.3; if left out 0.0."""
    pairs: Sequence[ContactPair | Tree] | None = field(default=None, metadata={"kinds": ("ContactPair",)})
    """Pairs of objects with rules of their own; for example [{"between": ["cube", "floor"], "friction": 0.08}]."""


@dataclass(kw_only=True)
class ContactPair(Part):
    """A pair of objects."""

    between: Sequence[str]
    """The names of the two; a solid named twice meets itself; for example ["cube", "floor"]."""
    friction: Quantity | None = None
    """Coulomb's coefficient between them; for example 0.5."""
    restitution: Quantity | None = None
    """How much of its speed a hit gives back; for example 0.3."""
    off: bool | None = None
    """They pass through each other; for example true; if left out false."""


@dataclass(kw_only=True)
class Slide(Part):
    """A rod that slides through a solid."""

    _kind: ClassVar[str] = "slide"

    rod: str
    """The rod that slides; for example "cable"."""
    solid: str
    """The solid it slides in; for example "finger"."""
    points: int | Vector | None = None
    """Their number from base to tip, or their ascending abscissae [m]; for example 15; if left out 2."""
    channel: Matrix | None = None
    """The points in the solid that the rod runs through, at rest [m]; for example [["10 mm", 0, "2 mm"], ["90 mm", 0,
    "2 mm"]]."""
    anchor_tip: Literal["none", "position", "pose"] | None = None
    """What holds the tip: its position, its pose, or none; for example "position"; if left out "position"."""
    friction: Quantity | None = None
    """Coulomb's coefficient between the rod and its channel; 0 if left out; for example 0.1; if left out 0.0."""
    reach: Quantity | None = None
    """How far outside the mesh a point may lie [m]; for example "2 mm"."""


@dataclass(kw_only=True)
class Tie(Part):
    """A point of a rod that is held."""

    _kind: ClassVar[str] = "tie"

    rod: str
    """The rod whose point is held; for example "cable"."""
    at: Quantity | None = None
    """The abscissa of that point [m]; its tip if left out; for example "50 mm"."""
    frame: str | None = None
    """The frame that holds it; the ground if there is no frame, solid, body or other; for example "hand"."""
    solid: str | None = None
    """The solid that holds it; for example "finger"."""
    body: str | None = None
    """The rigid body that holds it; for example "disc"."""
    other: str | None = None
    """The other rod that holds it; for example "spine"."""
    other_at: Quantity | None = None
    """The abscissa on the other rod [m]; its tip if left out; for example "50 mm"."""
    along: Sequence[Literal["x", "y", "z"]] | None = None
    """The axes of the holder along which it is held; for example ["x", "y", "z"]; if left out ["x", "y", "z"]."""
    about: Sequence[Literal["x", "y", "z"]] | None = None
    """The axes of the holder about which it is held; for example ["x", "y", "z"]."""
    reach: Quantity | None = None
    """How far outside the solid's mesh the point may lie [m]; for example "2 mm"."""


@dataclass(kw_only=True)
class Glue(Part):
    """Nodes of a solid that a rigid body carries."""

    _kind: ClassVar[str] = "glue"

    solid: str
    """The solid that is glued; for example "finger"."""
    body: str
    """The rigid body that carries it; for example "plate"."""
    box: Matrix | None = None
    """The lower and the upper corner of a box [m]; for example [[0, 0, 0], ["5 mm", "1 cm", "1 cm"]]."""
    sphere: Sphere | Tree | None = field(default=None, metadata={"kinds": ("Sphere",)})
    """A sphere; for example {"center": [0, 0, "10 mm"], "radius": "5 mm"}."""
    plane: Plane | Tree | None = field(default=None, metadata={"kinds": ("Plane",)})
    """A plane, with what lies on it; for example {"point": [0, 0, 0], "normal": [1, 0, 0]}."""
    nodes: Sequence[int] | None = None
    """Node numbers of the mesh file, from 0; for example [0, 3, 17]."""
    group: str | None = None
    """What the mesh file has given this name: a physical group, or a cell tag; for example "base"."""
    surface: Literal["True"] | None = None
    """True: the whole boundary; for example true."""
    in_: Literal["object", "world"] | None = None
    """Where the region is given, in the object before its pose or the world; for example "world"."""


@dataclass(kw_only=True)
class Actuator(Part):
    """An actuator."""

    rod: str
    """The rod that it moves; for example "cable"."""
    motion: Literal["translation", "rotation"] | None = None
    """Along the axis or about it; follows from what is driven; for example "translation"; if left out "translation"."""
    axis: Literal["x", "y", "z"] | None = None
    """The axis of the base along or about which it moves; along -x or about x if left out; for example "y"."""
    tendon: Tendon | Tree | None = field(default=None, metadata={"kinds": ("Tendon",)})
    """The tendon in the rod that it pulls, instead of moving the base; for example {"distance": "10 mm", "angle": "90
    deg"}."""
    force: Quantity | Literal["external"] | Table | Tree | FileTable | Formula | Literal["inverse"] | None = field(default=None, metadata={"kinds": ("Table", "FileTable", "Formula",)})
    """The force that it exerts [N], pulling if there is no axis: a value, a table over time, `external` or `inverse`;
    for example "3 N"."""
    displacement: Quantity | Literal["external"] | Table | Tree | FileTable | Formula | Literal["inverse"] | None = field(default=None, metadata={"kinds": ("Table", "FileTable", "Formula",)})
    """How far it pulls or moves [m]: a value, a table over time, `external` or `inverse`; for example {"times": [0, 1],
    "values": [0, "20 mm"]}."""
    torque: Quantity | Literal["external"] | Table | Tree | FileTable | Formula | Literal["inverse"] | None = field(default=None, metadata={"kinds": ("Table", "FileTable", "Formula",)})
    """The torque it exerts about the axis [N m]: a value, a table over time, `external` or `inverse`; for example "20
    mN m"."""
    angle: Quantity | Literal["external"] | Table | Tree | FileTable | Formula | Literal["inverse"] | None = field(default=None, metadata={"kinds": ("Table", "FileTable", "Formula",)})
    """How far it turns the base [rad]: a value, a table over time, `external` or `inverse`; for example {"times": [0,
    1], "values": [0, "90 deg"]}."""
    tension: Quantity | Literal["external"] | Table | Tree | FileTable | Formula | Literal["inverse"] | None = field(default=None, metadata={"kinds": ("Table", "FileTable", "Formula",)})
    """The tension of the tendon [N], another word for its force: a value, a table over time, `external` or `inverse`;
    for example "3 N"."""
    limits: Limits | Tree | None = field(default=None, metadata={"kinds": ("Limits",)})
    """What it can do, to which the inverse keeps; for example {"force": ["0 N", "20 N"]}."""
    preferred: Quantity | None = None
    """The force that it takes where targets leave a choice [N]; as little as possible if left out; for example "1
    N"."""


@dataclass(kw_only=True)
class Tendon(Part):
    """The tendon in the rod that it pulls, instead of moving the base."""

    distance: Quantity | Vector
    """Its distance from the centreline [m], or a pair [start, end]; for example "10 mm"."""
    from_: Quantity | None = None
    """The abscissa where it enters the rod [m]; for example "10 mm"; if left out 0.0."""
    to: Quantity | None = None
    """The abscissa where it ends [m]; the tip if left out; for example "90 mm"."""
    angle: Quantity | Vector | None = None
    """Its angle in the cross-section from y towards z [rad], or a pair [start, end]; for example "30 deg"; if left out
    0.0."""


@dataclass(kw_only=True)
class Table(Part):
    """A table over time."""

    times: Vector
    """The ascending times of the values [s]; for example [0, 1]."""
    values: Vector
    """The value at each time [N], linear in between; for example [0, 0.02]."""


@dataclass(kw_only=True)
class FileTable(Part):
    """A table in a file."""

    file: str
    """A CSV file whose first row names its columns, from the scene's folder; for example "out/signals.csv"."""
    column: str
    """The column of the values, in SI units; for example "pull.force"."""
    time: str | None = None
    """The column of the times [s]; for example "time"; if left out "time"."""


@dataclass(kw_only=True)
class Formula(Part):
    """A formula."""

    formula: str | Sequence[str]
    """The value in SI units as a formula of the time t [s]; for example "0.01 * sin(2 * pi * t)"."""


@dataclass(kw_only=True)
class Limits(Part):
    """What it can do, to which the inverse keeps."""

    force: Vector | Span | Tree | None = field(default=None, metadata={"kinds": ("Span",)})
    """The least and most force [N]; of what pulls the least is 0 if left out; for example ["0.5 N", "20 N"]."""
    torque: Vector | Span | Tree | None = field(default=None, metadata={"kinds": ("Span",)})
    """The least and most torque of what turns [N m]; for example ["-20 mN m", "20 mN m"]."""
    displacement: Vector | Span | Tree | None = field(default=None, metadata={"kinds": ("Span",)})
    """The least and most displacement [m]; for example ["0 mm", "30 mm"]."""
    angle: Vector | Span | Tree | None = field(default=None, metadata={"kinds": ("Span",)})
    """The least and most angle of what turns [rad]; for example ["-90 deg", "90 deg"]."""
    speed: Quantity | None = None
    """How fast it moves at most [m/s]; for example "50 mm/s"."""
    turning_speed: Quantity | None = None
    """How fast it turns at most [rad/s]; for example "90 deg/s"."""
    force_rate: Quantity | None = None
    """How fast its force changes at most [N/s]; for example "20 N/s"."""


@dataclass(kw_only=True)
class Span(Part):
    """Limits."""

    least: Quantity | None = None
    """The least [N]; for example 0."""
    most: Quantity | None = None
    """The most [N]; for example 10."""


@dataclass(kw_only=True)
class RodLoad(Part):
    """A load."""

    rod: str
    """The rod that is loaded; for example "cable"."""
    at: Quantity | None = None
    """The abscissa of a point load [m]; the tip if left out; for example "50 mm"."""
    from_: Quantity | None = None
    """The abscissa where a distributed load begins [m]; for example 0."""
    to: Quantity | None = None
    """The abscissa where a distributed load ends [m]; for example "100 mm"."""
    force: Vector | None = None
    """The force [N], of a distributed load per length [N/m]; for example [0, 0, "-1 N"]."""
    moment: Vector | None = None
    """The moment [N m], of a distributed load per length [N]; for example [0, "20 mN m", 0]."""
    follower: bool | None = None
    """In the axes of the turning cross-section instead of the world's; for example true; if left out false."""
    factor: Quantity | Literal["external"] | Table | Tree | FileTable | Formula | None = field(default=None, metadata={"kinds": ("Table", "FileTable", "Formula",)})
    """What both are multiplied by: a number, a table over time or `external`; for example {"times": [0, 1], "values":
    [0, 1]}."""


@dataclass(kw_only=True)
class SolidLoad(Part):
    """A load."""

    solid: str
    """The solid that is loaded; for example "finger"."""
    box: Matrix | None = None
    """The lower and the upper corner of a box [m]; for example [[0, 0, 0], ["5 mm", "1 cm", "1 cm"]]."""
    sphere: Sphere | Tree | None = field(default=None, metadata={"kinds": ("Sphere",)})
    """A sphere; for example {"center": [0, 0, "10 mm"], "radius": "5 mm"}."""
    plane: Plane | Tree | None = field(default=None, metadata={"kinds": ("Plane",)})
    """A plane, with what lies on it; for example {"point": [0, 0, 0], "normal": [1, 0, 0]}."""
    nodes: Sequence[int] | None = None
    """Node numbers of the mesh file, from 0; for example [0, 3, 17]."""
    group: str | None = None
    """What the mesh file has given this name: a physical group, or a cell tag; for example "base"."""
    surface: Literal["True"] | None = None
    """True: the whole boundary; for example true."""
    in_: Literal["object", "world"] | None = None
    """Where the region is given, in the object before its pose or the world; for example "world"."""
    force: Vector | None = None
    """The force in all [N], spread evenly over the region's surface; for example [0, 0, "-1 N"]; if left out [0.0, 0.0,
    0.0]."""
    pressure: Quantity | None = None
    """The pressure [Pa] on the region's surface, which it follows; negative: suction; for example "20 kPa"; if left out
    0.0."""
    factor: Quantity | Literal["external"] | Table | Tree | FileTable | Formula | None = field(default=None, metadata={"kinds": ("Table", "FileTable", "Formula",)})
    """What both are multiplied by: a number, a table over time or `external`; for example {"times": [0, 1], "values":
    [0, 1]}."""


@dataclass(kw_only=True)
class Output(Part):
    """An output."""

    solid: str | None = None
    """The solid whose point is recorded; for example "finger"."""
    point: Vector | None = None
    """The point of the solid [m]; for example ["100 mm", 0, 0]; if left out [0.0, 0.0, 0.0]."""
    in_: Literal["object", "world"] | None = None
    """Where point is given, in the object before its pose or the world; for example "world"; if left out "object"."""
    reach: Quantity | None = None
    """How far outside the mesh the point may lie [m]; for example "2 mm"."""
    body: str | None = None
    """The rigid body that is recorded: its centre of mass, or the force on it; for example "cube"."""
    between: Sequence[str] | None = None
    """Two objects, of which is recorded how they touch; for example ["cube", "floor"]."""
    rod: str | None = None
    """The rod whose point is recorded; for example "cable"."""
    at: Quantity | None = None
    """The abscissa of the point on the rod [m]; for example "100 mm"."""
    quantity: Literal["position", "displacement", "orientation", "strain", "force", "moment", "stress", "reaction"] | None = None
    """What is recorded there: of a solid `position`, `displacement`, `orientation`, `strain`, `stress` or `reaction`;
    of a rod `position`, `orientation`, `strain`, `force`, `moment` or `stress`; of a body `position`, `orientation` or
    `force`. An orientation is how it has turned since the start, a reaction the force on what is held in `region`, the
    force on a body that of all that touches it; for example "strain"; if left out "position"."""
    region: Region | Tree | None = field(default=None, metadata={"kinds": ("Region",)})
    """Whose held nodes a reaction is summed over; all of them if left out; for example {"box": [[0, 0, 0], ["5 mm", "1
    cm", "1 cm"]]}."""


@dataclass(kw_only=True)
class Region(Part):
    """Whose held nodes a reaction is summed over; all of them if left out."""

    box: Matrix | None = None
    """The lower and the upper corner of a box [m]; for example [[0, 0, 0], ["5 mm", "1 cm", "1 cm"]]."""
    sphere: Sphere | Tree | None = field(default=None, metadata={"kinds": ("Sphere",)})
    """A sphere; for example {"center": [0, 0, "10 mm"], "radius": "5 mm"}."""
    plane: Plane | Tree | None = field(default=None, metadata={"kinds": ("Plane",)})
    """A plane, with what lies on it; for example {"point": [0, 0, 0], "normal": [1, 0, 0]}."""
    nodes: Sequence[int] | None = None
    """Node numbers of the mesh file, from 0; for example [0, 3, 17]."""
    group: str | None = None
    """What the mesh file has given this name: a physical group, or a cell tag; for example "base"."""
    surface: Literal["True"] | None = None
    """True: the whole boundary; for example true."""
    in_: Literal["object", "world"] | None = None
    """Where the region is given, in the object before its pose or the world; for example "world"."""


@dataclass(kw_only=True)
class Target(Part):
    """A target."""

    at: Vector | Track | Tree | FileTrack | Formula | Quantity | FileTable | Literal["external"] = field(metadata={"kinds": ("Track", "FileTrack", "Formula", "FileTable",)})
    """Where it is to be: a value, a table over time or `external`; of a position [x, y, z] [m], of an orientation the
    turn since the start as a rotation vector [rad], of a strain one number [1/m], of an output `between` two how hard
    they press [N]; for example ["120 mm", 0, "30 mm"]."""
    strain: Literal["torsion", "bending_y", "bending_z", "elongation", "shear_y", "shear_z"] | None = None
    """Which strain of the output, where that is one; for example "bending_y"; if left out "bending_y"."""
    weights: Vector | None = None
    """How much each component matters, 0 where it may be anything; all 1 if left out; for example [1, 1, 0]."""
    tolerance: Quantity | None = None
    """How far off still counts as reached; 0.1 mm, 0.1 deg, 0.1 1/m, 0.1 % or 0.01 N if left out; for example "0.5
    mm"."""


@dataclass(kw_only=True)
class Track(Part):
    """A table over time."""

    times: Vector
    """The ascending times of the values [s]; for example [0, 1]."""
    values: Matrix | Vector
    """The value at each time [m], linear in between; for example [[0, 0, 0], [0, "10 mm", 0]]."""


@dataclass(kw_only=True)
class FileTrack(Part):
    """A table in a file."""

    file: str
    """A CSV file whose first row names its columns, from the scene's folder; for example "out/signals.csv"."""
    columns: Sequence[str]
    """The columns of x, y and z, in SI units; for example ["tip.x", "tip.y", "tip.z"]."""
    time: str | None = None
    """The column of the times [s]; for example "time"; if left out "time"."""
