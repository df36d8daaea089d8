#include <fmt/format.h>
#include <fmt/ranges.h>

#include <set>

#include "sinew/io/nearest.hpp"
#include "sinew/io/scene_fields.hpp"

namespace sinew::io {
namespace {

template <class T>
std::vector<std::string> names(const Named<T>& objects) {
  std::vector<std::string> all;
  for (const auto& object : objects) all.push_back(object.first);
  return all;
}

/// `at` holds the name of an object listed under `group`; `what` is "rod".
void require(const std::vector<std::string>& known, const At& at, const std::string& what) {
  const std::string& name = at.node().text;
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  const std::string near = nearest(name, known);
  std::string remedy = near.empty() ? "" : fmt::format("did you mean `{}`? ", near);
  remedy += known.empty() ? fmt::format("the scene has no {}s; describe it under `{}s:`", what, what)
                          : fmt::format("the {}s are {}", what, fmt::join(known, ", "));
  at.refuse(fmt::format("is not a {} of this scene", what), remedy);
}

template <class A, class B>
void require_apart(const Named<A>& first, const Named<B>& second, const At& at, const std::string& rule) {
  std::set<std::string> taken;
  for (const auto& object : first) taken.insert(object.first);
  for (const auto& object : second) {
    if (taken.contains(object.first)) at.refuse_key(object.first, rule, "rename one of the two");
  }
}

template <class T>
void require_frames(const Named<T>& objects, const std::vector<std::string>& frames, const At& group) {
  for (const auto& [name, object] : objects) {
    if (object.frame) require(frames, group.child(name).child("frame"), "frame");
  }
}

}  // namespace

void check_names(const Scene& scene, const At& root) {
  const std::vector<std::string> frames = names(scene.frames), solids = names(scene.solids), rods = names(scene.rods);
  if (solids.empty() && rods.empty()) {
    root.refuse("needs at least one solid or rod", "describe one under `solids:` or `rods:`");
  }
  if (!solids.empty()) require_frames(scene.solids, frames, root.child("solids"));
  if (!rods.empty()) {
    require_frames(scene.rods, frames, root.child("rods"));
    require_apart(scene.solids, scene.rods, root.child("rods"),
                  "is the name of a solid, and results are named after it");
  }
  for (std::size_t i = 0; i < scene.couplings.size(); ++i) {
    const At slide = root.child("couplings").item(i).child("slide");
    require(rods, slide.child("rod"), "rod");
    require(solids, slide.child("solid"), "solid");
  }
  for (const auto& [name, actuator] : scene.actuators) {
    require(rods, root.child("actuators").child(name).child("rod"), "rod");
  }
  for (const auto& [name, output] : scene.outputs) {
    const At at = root.child("outputs").child(name);
    if (output.solid) require(solids, at.child("solid"), "solid");
    if (output.rod) require(rods, at.child("rod"), "rod");
  }
  if (!scene.outputs.empty()) {
    require_apart(scene.actuators, scene.outputs, root.child("outputs"),
                  "is the name of an actuator, and both name columns of signals.csv");
  }
}

}  // namespace sinew::io
