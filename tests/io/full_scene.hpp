// Scenes that together use every key of the format.
#pragma once

namespace sinew::io {

inline constexpr const char* full_scene = R"(# A finger with one cable.
title: A finger pulled by one cable
time: {step: 10 ms, duration: 2 s, smallest: 10 us}
gravity: [0, -9.81, 0]
newton: {iterations: converged, limit: 20, tolerance: 1e-10, precision: single}
view: {interval: 20 ms}
frames:
  hand:
    pose: {rotate: [0, 0, 90 deg], translate: [0, 1 cm, 0]}
    motion: {times: [0, 1], rotate: [[0, 0, 0], [0, 0, 0.5]], translate: [[0, 0, 0], [0, 20 mm, 0]]}
solids:
  finger:
    mesh: finger.vtk
    scale: 0.001
    pose: {rotate: [0, 0, 0], translate: [0, 2 mm, 0]}
    frame: hand
    material: {law: corotational, young: 600 kPa, poisson: 0.45}
    mass: 75 g
    rayleigh: {mass: 0.1, stiffness: 100 ms}
    fixed: {box: [[-15 mm, 0 mm, 0 mm], [5 mm, 10 mm, 15 mm]], in: object}
  block:
    mesh: block.vtu
    material: {young: 1 MPa, poisson: 0.3}
    density: 1100 kg/m^3
    fixed:
      - box: [[0, 0, 0], [1 mm, 1 mm, 1 mm]]
        in: world
      - box: [[0, 0, 0], [0, 1 mm, 1 mm]]
rods:
  cable:
    path: [[0, 5 mm, 7 mm], [50 mm, 5 mm, 7 mm], [100 mm, 5 mm, 7 mm]]
    in: world
    up: [0, 0, 1]
    pose: {rotate: [0, 0, 0], translate: [0, 0, 0]}
    frame: hand
    cable: cosserat
    sections: 15
    strains: [bending_y, torsion, bending_z]
    section: {circle: {radius: 0.5 mm}}
    material: {young: 5 GPa, poisson: 0.5, density: 1100}
  thread:
    path: [[0, 0, 0], [10 cm, 0, 0]]
    cable: geometric
    sections: [0, 4 cm, 10 cm]
couplings:
  - slide: {rod: cable, solid: finger, points: 15, anchor_tip: position, reach: 2 mm}
  - slide: {rod: thread, solid: block, points: [0, 30 mm], anchor_tip: none, friction: 0.1}
actuators:
  pull: {rod: cable, motion: translation, displacement: {times: [0, 1], values: [0, 20 mm]}}
  twist: {rod: cable, angle: 90 deg}
  motor: {rod: thread, force: external}
  screw: {rod: thread, torque: 2 N m}
outputs:
  tip: {solid: finger, point: [100 mm, 5 mm, 7 mm], in: world, reach: 1 mm}
  end: {rod: cable, at: 100 mm}
)";

/// The shapes that rods have, and what acts on them.
inline constexpr const char* rods_scene = R"(# Rods of every kind.
analysis: static
modes: 4
frames: {hand: {pose: {translate: [0, 1 cm, 0]}}}
solids: {finger: {mesh: finger.vtk, material: {young: 600 kPa, poisson: 0.45}, mass: 75 g}}
rods:
  spine:
    path: [[0, 0, 0], [100 mm, 0, 0]]
    strains: [torsion, bending_y, bending_z, elongation, shear_y, shear_z]
    order: {torsion: 1, bending_y: 2, bending_z: 3, elongation: 4, shear_y: 5, shear_z: 0}
    rest:
      at: [0, 50 mm]
      torsion: 0.5 1/m
      bending_y: [1, 2]
      bending_z: [0 1/m, 2 1/cm]
      elongation: [0, 0.1]
      shear_y: 0.01
      shear_z: [0.02, -0.03]
    start: path
    base: [turn_z, x]
    parts:
      - {to: 20 mm, section: {circle: {radius: [2 mm, 1 mm]}}, material: {young: 1 MPa, poisson: 0.4, density: 1100}}
      - to: 40 mm
        section: {tube: {outer: [5 mm, 4 mm], inner: 3 mm}}
        material: {young: 2 MPa, poisson: 0.4, density: 1200, viscosity: 300 Pa s, damping: 10 ms}
      - {to: 60 mm, section: {ellipse: {y: 2 mm, z: 1 mm}}, material: {young: 3 MPa, poisson: 0.4, density: 1}}
      - {to: 80 mm, section: {rectangle: {y: 4 mm, z: [2 mm, 1 mm]}}, material: {young: 4 MPa, poisson: 0, density: 1}}
      - to: 100 mm
        section: {stiffness: {matrix: [1, 2, 3, 4e3, 5e3, 6e3], line_density: 2 g/m, radius: 1 mm}}
  tube:
    path: [[0, 0, 0], [0, 100 mm, 0]]
    order: 2
    rest: straight
    start: rest
    base: free
    section: {tube: {outer: 5 mm, inner: 4 mm}}
    material: {young: 1 MPa, poisson: 0.4, density: 1100, viscosity: 2, damping: 1 s}
  blade:
    path: [[0, 0, 0], [0, 0, 100 mm]]
    rest: {bending_z: 20 1/m}
    base: clamped
    section: {rectangle: {y: 4 mm, z: 2 mm}}
    material: {young: 1 MPa, poisson: 0.4, density: 1100}
  oval:
    path: [[0, 0, 0], [0, 0, -100 mm]]
    rest: path
    section: {ellipse: {y: [2 mm, 1 mm], z: 1 mm}}
    material: {young: 1 MPa, poisson: 0.4, density: 1100}
  given:
    path: [[0, 0, 0], [0, 0, 1]]
    section:
      stiffness:
        matrix:
          - [1, 0, 0, 0, 0, 0]
          - [0, 2, 1, 0, 0, 0]
          - [0, 1, 3, 0, 0, 10]
          - [0, 0, 0, 4e3, 0, 0]
          - [0, 0, 0, 0, 5e3, 0]
          - [0, 0, 10, 0, 0, 6e3]
        line_density: 0.1 kg/m
        radius: 5 mm
    material: {damping: 20 ms}
couplings:
  - slide: {rod: tube, solid: finger, channel: [[1 mm, 2 mm, 3 mm], [4 mm, 5 mm, 6 mm]], anchor_tip: pose}
  - tie: {rod: spine, at: 50 mm, frame: hand, along: [z, x], about: [y]}
  - tie: {rod: tube, solid: finger, along: [], about: [x, y, z], reach: 1 mm}
  - tie: {rod: tube, at: 10 mm, other: blade, other_at: 20 mm}
  - tie: {rod: oval}
actuators:
  lift: {rod: blade, axis: z, displacement: 1 mm}
  roll: {rod: blade, axis: y, angle: 10 deg}
  wire:
    rod: spine
    tendon: {from: 10 mm, to: 90 mm, distance: [10 mm, 5 mm], angle: [0 deg, 360 deg]}
    tension: {times: [0, 1], values: [0, 2 N]}
  reel: {rod: spine, tendon: {distance: 10 mm}, displacement: 5 mm}
  hook: {rod: spine, tendon: {distance: 10 mm, angle: 90 deg}, force: external}
loads:
  weight: {rod: spine, force: [0, 0, -1 N]}
  wind:
    rod: spine
    from: 10 mm
    to: 50 mm
    force: [0, 2 N/m, 0]
    moment: [1 N, 0, 0]
    factor: {times: [0, 1], values: [0, 3]}
  screw: {rod: tube, at: 50 mm, moment: [20 mN m, 0, 0], follower: true, factor: external}
  push: {rod: tube, force: [1, 0, 0], follower: false, factor: -2.5}
outputs:
  tip: {rod: spine, at: 100 mm, quantity: position}
  root: {rod: spine, at: 0, quantity: moment}
)";

/// The alternatives that these two leave out, for the test of the schema.
inline constexpr const char* other_scene = R"(
newton: 1
rods:
  cable:
    path: [[0, 0, 0], [0, 0, 1]]
    section: {circle: {radius: 1 mm}}
    material: {young: 5e9, poisson: 0.3, density: 0}
actuators:
  push: {rod: cable, force: {times: [0, 1], values: [0, 1]}}
  turn: {rod: cable, torque: {times: [0, 1], values: [0, 1]}}
  bend: {rod: cable, angle: {times: [0, 1], values: [0, 1]}}
)";

inline constexpr const char* bodies_scene = R"(# Rigid bodies, obstacles and their contact.
frames:
  hand: {motion: {times: [0, 1], translate: [[0, 0, 0], [0, 0, 50 mm]]}}
bodies:
  cube: {box: {size: [20 mm, 30 mm, 40 mm]}, pose: {rotate: [0, 0, 45 deg], translate: [0, 0, 10 mm]}, mass: 30 g}
  ball: {sphere: {radius: 10 mm}, density: 1200, velocity: [0, 0, -1 m/s], spin: [0, 180 deg/s, 0]}
  drum: {cylinder: {radius: 10 mm, length: 50 mm}, mass: 1 kg}
  pill: {capsule: {radius: 5 mm, length: 30 mm}, mass: 1 kg}
  part: {mesh: {file: part.stl, scale: 0.001, hull: true}, density: 1200}
  cup: {mesh: {file: cup.stl, thickness: 1 mm}, mass: 20 g}
obstacles:
  floor: {plane: {point: [0, 0, -1 mm], normal: [0, 0, 2]}}
  step: {box: {size: [1, 1, 1]}, pose: {rotate: [0, 0, 90 deg], translate: [1, 0, 0]}, frame: hand}
  knob: {sphere: {radius: 10 mm}}
  post: {cylinder: {radius: 10 mm, length: 50 mm}}
  rail: {capsule: {radius: 5 mm, length: 30 mm}}
  terrain: {mesh: {file: terrain.obj, scale: 2, hull: true}}
  tin: {mesh: {file: terrain.obj, thickness: 1 mm}}
contact:
  friction: 0.4
  restitution: 0.1
  pairs:
    - {between: [cube, floor], friction: 0.08, restitution: 0.3}
    - {between: [ball, drum], off: true}
outputs:
  where: {body: cube}
  weight: {body: cube, quantity: force}
  press: {between: [cube, floor]}
couplings:
  - glue: {solid: finger, body: cube, box: [[0, 0, 0], [1 mm, 1 mm, 1 mm]], in: world}
  - glue: {solid: finger, body: cube, sphere: {center: [0, 0, 10 mm], radius: 5 mm}}
  - glue: {solid: finger, body: cube, plane: {point: [0, 0, 0], normal: [1, 0, 0], within: 0.1 mm}}
  - glue: {solid: finger, body: cube, nodes: [0, 3, 17]}
  - glue: {solid: finger, body: cube, group: base}
  - glue: {solid: finger, body: cube, surface: true}
  - tie: {rod: stem, body: ball}
solids: {finger: {mesh: finger.vtk, material: {young: 600 kPa, poisson: 0.45}, mass: 75 g}}
rods:
  stem: {path: [[0, 0, 0], [100 mm, 0, 0]], section: {circle: {radius: 1 mm}}, material: {young: 1 MPa, poisson: 0.4, density: 1000}}
)";

inline constexpr const char* solids_scene = R"(# Solids of every law, held and loaded by every kind of region.
frames:
  grip: {motion: {times: [0, 1], translate: [[0, 0, 0], [5 mm, 0, 0]]}}
solids:
  finger:
    mesh: finger.vtu
    material: {law: ogden, mu: [63 kPa, 0.12 kPa, -1 kPa], alpha: [1.3, 5, -2], bulk: 2 MPa, viscosity: 30 Pa s, density: 1100}
    mass_matrix: consistent
    parts:
      - {box: [[0, 0, 0], [1 mm, 1 mm, 1 mm]], in: world, material: {law: neo_hookean, young: 5 MPa, poisson: 0.4, density: 1300}}
      - {sphere: {center: [0, 0, 10 mm], radius: 5 mm}, material: {law: mooney_rivlin, c10: 80 kPa, c01: 20 kPa, bulk: 5 MPa}}
      - {plane: {point: [0, 0, 0], normal: [1, 0, 0], within: 0.1 mm}, material: {law: mooney_rivlin, c10: 80 kPa, c01: 20 kPa, poisson: 0.45}}
      - {nodes: [0, 3, 17], material: {law: ogden, mu: [1 MPa], alpha: [2], poisson: 0.45, viscosity: 1 Pa s}}
      - {group: base, material: {law: saint_venant_kirchhoff, young: 5 MPa, poisson: 0.4}}
      - {surface: true, material: {young: 5 MPa, poisson: 0.4}}
    fixed:
      - {box: [[0, 0, 0], [1 mm, 1 mm, 1 mm]], in: world, axes: [x, z], frame: grip}
      - {sphere: {center: [0, 0, 10 mm], radius: 5 mm}}
      - {plane: {point: [0, 0, 0], normal: [1, 0, 0], within: 0.1 mm}}
      - {nodes: [0, 3, 17]}
      - {group: base}
      - {surface: true}
    springs:
      - {box: [[0, 0, 0], [1 mm, 1 mm, 1 mm]], in: world, stiffness: [1 N/m, 0, 20 N/m]}
      - {sphere: {center: [0, 0, 10 mm], radius: 5 mm}, stiffness: [1 N/m, 0, 20 N/m]}
      - {plane: {point: [0, 0, 0], normal: [1, 0, 0], within: 0.1 mm}, stiffness: [1 N/m, 0, 20 N/m]}
      - {nodes: [0, 3, 17], stiffness: [1 N/m, 0, 20 N/m]}
      - {group: base, stiffness: [1 N/m, 0, 20 N/m]}
      - {surface: true, stiffness: [1 N/m, 0, 20 N/m]}
  rubber:
    mesh: block.msh
    material: {law: mooney_rivlin, c10: 80 kPa, c01: 20 kPa, poisson: 0.45}
    density: 1000
    fixed: {group: "7"}
  ball: {mesh: b.vtk, order: 2, density: 1, material: {young: 1 MPa, poisson: 0.3}, fixed: {sphere: {center: [0, 0, 0], radius: 1 mm}, axes: [x], frame: grip}}
  plate: {mesh: b.vtk, density: 1, material: {young: 1 MPa, poisson: 0.3}, fixed: {plane: {point: [0, 0, 0], normal: [1, 0, 0], within: 1 mm}}}
  pin: {mesh: b.vtk, density: 1, material: {young: 1 MPa, poisson: 0.3}, fixed: {nodes: [1, 2, 3]}}
  skin: {mesh: b.vtk, density: 1, material: {young: 1 MPa, poisson: 0.3}, fixed: {surface: true}}
loads:
  load0: {solid: finger, box: [[0, 0, 0], [1 mm, 1 mm, 1 mm]], in: world, force: [0, 0, -1 N], factor: external}
  load1: {solid: finger, sphere: {center: [0, 0, 10 mm], radius: 5 mm}, pressure: -20 kPa}
  load2: {solid: finger, plane: {point: [0, 0, 0], normal: [1, 0, 0], within: 0.1 mm}, force: [1 N, 0, 0], pressure: 5 kPa}
  load3: {solid: finger, nodes: [0, 3, 17], force: [0, 1 N, 0], factor: {times: [0, 1], values: [0, 2]}}
  load4: {solid: finger, group: base, pressure: 1 Pa}
  load5: {solid: finger, surface: true, pressure: 1 Pa}
outputs:
  held0: {solid: finger, quantity: reaction, region: {box: [[0, 0, 0], [1 mm, 1 mm, 1 mm]], in: world}}
  held1: {solid: finger, quantity: reaction, region: {sphere: {center: [0, 0, 10 mm], radius: 5 mm}}}
  held2: {solid: finger, quantity: reaction, region: {plane: {point: [0, 0, 0], normal: [1, 0, 0], within: 0.1 mm}}}
  held3: {solid: finger, quantity: reaction, region: {nodes: [0, 3, 17]}}
  held4: {solid: finger, quantity: reaction, region: {group: base}}
  held5: {solid: finger, quantity: reaction, region: {surface: true}}
  all: {solid: finger, quantity: reaction}
  moved: {solid: finger, point: [0, 0, 0], quantity: displacement}
  bent: {solid: finger, point: [0, 0, 0], quantity: strain}
)";

/// What is to be found: commands that bring outputs to their targets.
inline constexpr const char* inverse_scene = R"(# A finger, told where to go.
analysis: quasi_static
solids: {finger: {mesh: finger.vtk, material: {young: 600 kPa, poisson: 0.45}, mass: 75 g}}
rods:
  cable:
    path: [[0, 0, 0], [100 mm, 0, 0]]
    section: {circle: {radius: 0.5 mm}}
    material: {young: 5 GPa, poisson: 0.5, density: 1100}
couplings:
  - slide: {rod: cable, solid: finger, points: 15}
actuators:
  pull:
    rod: cable
    force: inverse
    limits: {force: [0.5 N, 20 N], displacement: {least: -1 mm, most: 30 mm}, speed: 50 mm/s, force_rate: 20 N/s}
    preferred: 1 N
  turn: {rod: cable, angle: inverse, limits: {torque: {most: 2 mN m}, angle: [-90 deg, 90 deg], turning_speed: 90 deg/s}}
  other: {rod: cable, force: inverse, limits: {force: {least: 0 N, most: 5 N}}}
  twist: {rod: cable, torque: inverse, limits: {torque: {least: 0, most: 1 N m}, angle: {least: 0, most: 1 rad}}}
  wire: {rod: cable, tendon: {distance: 1 mm}, tension: inverse, limits: {tension: {least: 0, most: 3 N}}}
outputs:
  tip: {solid: finger, point: [100 mm, 5 mm, 7 mm]}
  nail: {solid: finger, point: [100 mm, 5 mm, 7 mm], quantity: orientation}
  bend: {rod: cable, at: 50 mm, quantity: strain}
targets:
  tip: {at: {times: [0, 1], values: [[0.1, 0, 0], [90 mm, 0, 3 cm]]}, weights: [1, 1, 0], tolerance: 1 mm}
  nail: {at: [0, 0, 20 deg], tolerance: 1 deg}
  bend: {at: external, strain: bending_z}
snap: stop
)";

}  // namespace sinew::io
