#include "sinew/sim/places.hpp"

#include <algorithm>

#include "sinew/error/digits.hpp"
#include "sinew/solid/corotational.hpp"

namespace sinew {

Placement moved(const Model& model, const State& state, int frame) {
  return frame < 0 ? Placement{} : frame_displacement(model.scene.frames[frame].second, state.time);
}

Placement rod_base(const Model& model, const State& state, int rod) {
  return compose(moved(model, state, model.rods[rod].frame), model.rods[rod].base);
}

Placement cable_base(const Model& model, const State& state, int cable) {
  return compose(moved(model, state, model.cables[cable].frame), model.cables[cable].base);
}

rod::Configuration rod_shape(const Model& model, const State& state, int rod) {
  return rod::configure(model.rods[rod].rod, {rod_base(model, state, rod), state.rods[rod].turned}, state.rods[rod].q);
}

Vec3 solid_point(const Model& model, const State& state, int solid, const solid::EmbeddedPoint& where) {
  return solid::position(where, model.solids[solid].body.cells, state.solids[solid].x);
}

Vec3 output_position(const Model& model, const State& state, const OutputModel& output) {
  if (output.solid >= 0) return solid_point(model, state, output.solid, output.where);
  if (output.body >= 0) return state.bodies[output.body].p;
  return rod::position(rod_shape(model, state, output.rod), output.abscissa);
}

rod::Mat3 output_axes(const Model& model, const State& state, const OutputModel& output) {
  if (output.body >= 0) return state.bodies[output.body].R;
  if (output.rod >= 0) return rod::branch(rod_shape(model, state, output.rod), output.abscissa).R;
  rod::Mat3 F;
  for (int i = 0; i < 3; ++i) F.col(i) = solid_point(model, state, output.solid, output.axes[i]);
  return solid::polar_rotation(F);
}

Pressing pressing_of(const State& state, int pair) {
  Pressing own;
  for (const ContactState& contact : state.contacts) {
    if (contact.pair != pair) continue;
    own.force += contact.force.dot(contact.normal);
    own.gap = std::min(own.gap, contact.gap);
  }
  return own;
}

bool is_pressed(const State& state, const Collider& object) {
  return std::any_of(state.contacts.begin(), state.contacts.end(), [&object](const ContactState& contact) {
    return !contact.force.isZero(0.0) && (contact.a.on == object || contact.b.on == object);
  });
}

int count_folded(const Model& model, const State& state) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < model.solids.size(); ++i)
    count += solid::folded_cells(model.solids[i].body, state.solids[i].x).size();
  return static_cast<int>(count);
}

std::string describe_folded(const Model& model, const State& state) {
  for (std::size_t i = 0; i < model.solids.size(); ++i) {
    const solid::Body& body = model.solids[i].body;
    const std::vector<int> folded = solid::folded_cells(body, state.solids[i].x);
    if (folded.empty()) continue;
    const Vec3 at = body.at_nodes(folded.front(), body.rest).rowwise().mean();
    return std::to_string(count_folded(model, state)) + " elements are flat or inside out, one of them cell " +
           std::to_string(folded.front()) + " of solids." + model.solids[i].name + ", at rest near (" +
           three_digits(at.x()) + ", " + three_digits(at.y()) + ", " + three_digits(at.z()) + ") m";
  }
  return "";
}

Vec3 output_turn(const Model& model, const State& state, const OutputModel& output) {
  return lie::log(output_axes(model, state, output) * output.upright.transpose());
}

}  // namespace sinew
