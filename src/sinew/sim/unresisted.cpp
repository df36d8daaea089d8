#include "sinew/sim/unresisted.hpp"

#include <algorithm>

namespace sinew {

namespace {

std::string motion_name(int axis, bool turns) { return std::string(turns ? "turn_" : "") + "xyz"[axis]; }

}  // namespace

std::vector<Unresisted> unresisted_motions(const Model& model, const std::vector<int>& unknowns) {
  std::vector<Unresisted> found;
  const auto look_at = [&](Collider object, std::string where, int first, int count, const auto& name_of_motion) {
    std::string motions;
    for (int k = 0; k < count; ++k) {
      if (std::find(unknowns.begin(), unknowns.end(), first + k) == unknowns.end()) continue;
      motions += (motions.empty() ? "" : ", ") + name_of_motion(k);
    }
    if (!motions.empty()) found.push_back({object, std::move(where), std::move(motions)});
  };
  for (int i = 0; i < static_cast<int>(model.rods.size()); ++i) {
    const RodModel& rod = model.rods[i];
    look_at({Collider::Kind::rod, i}, "rods." + rod.name, rod.unknown, rod.rod.base_coordinates(),
            [&rod](int k) { return motion_name(rod.rod.base[k].axis, rod.rod.base[k].turns); });
  }
  for (int i = 0; i < static_cast<int>(model.bodies.size()); ++i)
    look_at({Collider::Kind::body, i}, "bodies." + model.bodies[i].name, model.bodies[i].unknown, 6,
            [](int k) { return motion_name(k % 3, k >= 3); });
  return found;
}

std::string in_words(const std::vector<Unresisted>& motions) {
  std::string text;
  for (std::size_t i = 0; i < motions.size(); ++i)
    text += (i == 0                    ? ""
             : i + 1 == motions.size() ? " and "
                                       : ", ") +
            motions[i].where + " (" + motions[i].motions + ")";
  return text;
}

}  // namespace sinew
