// A finger with one cable, the scene that the tests of the program change. The line numbers stand in the tests.
#pragma once

#include <stdexcept>
#include <string>

#include "run_program.hpp"

namespace sinew::test {

inline const std::string finger_scene = R"(title: Finger
time: {step: 10 ms, duration: 200 ms}
gravity: [0, 0, -9.81]
solids:
  finger:
    mesh: meshes/finger.vtk
    scale: 0.001
    material: {law: corotational, young: 600 kPa, poisson: 0.45}
    density: 1070 kg/m^3
    rayleigh: {mass: 0.1, stiffness: 0.02}
    fixed: {box: [[-1 mm, -8 mm, -8 mm], [1 mm, 8 mm, 8 mm]]}
rods:
  cable:
    path: [[0 mm, 0 mm, 2 mm], [90 mm, 0 mm, 2 mm]]
    sections: 6
    strains: [torsion, bending_y, bending_z]
    section: {circle: {radius: 0.5 mm}}
    material: {young: 5 GPa, poisson: 0.4, density: 1100 kg/m^3}
couplings:
  - slide: {rod: cable, solid: finger, points: [29 mm, 57 mm, 90 mm], anchor_tip: position}
actuators:
  pull: {rod: cable, motion: translation, displacement: {times: [0 s, 1 s], values: [0 mm, 10 mm]}}
outputs:
  tip: {solid: finger, point: [95 mm, 0 mm, 0 mm]}
)";

inline std::string finger_mesh() { return read_file(examples() / "meshes" / "finger.vtk"); }

/// `text` with the one place that holds `from` replaced.
inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t place = text.find(from);
  if (place == std::string::npos) throw std::logic_error("nothing to replace: " + from);
  if (text.find(from, place + 1) != std::string::npos) throw std::logic_error("found twice: " + from);
  return text.replace(place, from.size(), to);
}

}  // namespace sinew::test
