// A scene that uses every key of the format, and what differs between its alternatives.
#pragma once

namespace sinew::io {

inline constexpr const char* full_scene = R"(# A finger with one cable.
title: A finger pulled by one cable
time: {step: 10 ms, duration: 2 s}
gravity: [0, -9.81, 0]
newton: {iterations: converged, limit: 20, tolerance: 1e-10}
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
  - slide: {rod: thread, solid: block, points: [0, 30 mm], anchor_tip: none}
actuators:
  pull: {rod: cable, motion: translation, displacement: {times: [0, 1], values: [0, 20 mm]}}
  twist: {rod: cable, angle: 90 deg}
  motor: {rod: thread, force: external}
  screw: {rod: thread, torque: 2 N m}
outputs:
  tip: {solid: finger, point: [100 mm, 5 mm, 7 mm], in: world, reach: 1 mm}
  end: {rod: cable, at: 100 mm}
)";

/// The alternatives that `full_scene` leaves out, for the test of the schema.
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

}  // namespace sinew::io
