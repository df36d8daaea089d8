#include "sinew/sim/unbalanced.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "sinew/error/digits.hpp"
#include "sinew/sim/contact_places.hpp"

namespace sinew {

namespace {

std::string near(const Vec3& p) {
  return "near (" + three_digits(p.x()) + ", " + three_digits(p.y()) + ", " + three_digits(p.z()) + ") m";
}

std::string name_of_contact(const Model& model, int pair, const Vec3& where) {
  return name_of_pair(model, pair) + " " + near(where);
}

/// Whose an unknown z is.
std::string owner_of_unknown(const Model& model, int unknown) {
  const auto within = [unknown](int first, int count) { return unknown >= first && unknown < first + count; };
  for (const BodyModel& body : model.bodies) {
    if (within(body.unknown, 6)) return "bodies." + body.name;
  }
  for (const RodModel& rod : model.rods) {
    if (within(rod.unknown, rod.rod.base_coordinates())) return "the base of rods." + rod.name;
  }
  for (const GeometricCableModel& cable : model.cables) {
    if (within(cable.unknown, cable.cable.coordinates())) return "rods." + cable.name;
  }
  for (const PointModel& point : model.points) {
    if (point.unknown != unknown) continue;
    const std::string rod = point.line.rod >= 0 ? " of rods." + model.rods[point.line.rod].name : "";
    return "a sliding point" + rod + " (couplings." + std::to_string(point.coupling) + ")";
  }
  for (const TieModel& tie : model.ties) {
    if (tie.unknown >= 0 && within(tie.unknown, tie.directors ? 12 : 3))
      return "couplings." + std::to_string(tie.coupling);
  }
  return "unknown " + std::to_string(unknown);
}

struct Largest {
  double value = 0.0;
  std::string of;
};

/// [N] The largest unbalanced force, and whose it is.
Largest largest_force(const Model& model, const Linearization& here) {
  Largest most;
  const auto take = [&most](double value, const auto& name) {
    if (value > most.value) most = {value, name()};
  };
  for (std::size_t i = 0; i < here.forces().size(); ++i) {
    const SolidForces& own = here.forces()[i];
    take(own.largest, [&] {
      Eigen::Index node = 0;
      own.nodal.sum.colwise().squaredNorm().maxCoeff(&node);
      return "solids." + model.solids[i].name + ", node " + std::to_string(node) + ", at rest " +
             near(model.solids[i].body.rest.col(node));
    });
  }
  for (std::size_t i = 0; i < model.rods.size(); ++i) {
    const RodParts& own = here.reduced().rods[i];
    take(own.largest, [&] {
      const rod::Section& section = model.rods[i].rod.sections[own.largest_at];
      return "rods." + model.rods[i].name + " from " + three_digits(1e3 * section.begin) + " to " +
             three_digits(1e3 * section.end) + " mm";
    });
  }
  if (model.unknowns > 0) {
    Eigen::Index unknown = 0;
    const double largest = (here.reduced().problem.r.array() / model.arms.array()).abs().maxCoeff(&unknown);
    take(largest, [&] { return owner_of_unknown(model, static_cast<int>(unknown)); });
  }
  return most;
}

}  // namespace

std::string most_unbalanced(const StepContext& context, const Linearization& here, const State& iterate, double allowed,
                            const std::vector<int>& turns) {
  const Model& model = context.model;
  const double tolerance = model.scene.newton.tolerance;
  const auto& touches = here.contacts().touches;
  const auto name = [&](int contact) {
    return name_of_contact(model, iterate.contacts[contact].pair, touches[contact].point_b);
  };
  const ContactForces::Worst contact = here.worst_contact();
  const double force = here.largest() / std::max(allowed, 1e-300), row = here.violation() / (tolerance * model.size),
               law = contact.error / (tolerance * model.size);
  const auto often = std::max_element(turns.begin(), turns.end());
  const int restless = often == turns.end() || turns.size() != iterate.contacts.size() || *often < 4
                           ? -1
                           : static_cast<int>(often - turns.begin());
  std::string text;
  if (std::isinf(contact.error) && contact.contact >= 0) {
    text = "the contact of " + name(contact.contact) + " is met in the last iteration";
  } else if (law > std::max(force, row) && contact.contact >= 0) {
    text = "the contact of " + name(contact.contact) + ": its law is missed by " + three_digits(1e3 * contact.error) +
           " mm";
  } else if (law > std::max(force, row) && contact.rubbing >= 0) {
    const PointModel& point = model.points[contact.rubbing];
    text = "friction in couplings." + std::to_string(point.coupling) + ": its law is missed by " +
           three_digits(1e3 * contact.error) + " mm";
  } else if (row > force) {
    Eigen::Index which = 0;
    here.reduced().as_told().cwiseAbs().maxCoeff(&which);
    text =
        name_of_rows(model, {static_cast<int>(which)}) + ": missed by " + three_digits(1e3 * here.violation()) + " mm";
  } else if (const Largest most = largest_force(model, here); !most.of.empty()) {
    text = most.of + ": " + three_digits(most.value) + " N are not balanced, " +
           three_digits(most.value / std::max(here.scale(), 1e-300)) + " of the largest force";
  }
  if (restless >= 0)
    text += (text.empty() ? "" : "; ") + std::string("the contact of ") + name(restless) + " came and went " +
            std::to_string(*often) + " times";
  return text;
}

std::string too_many_contacts(const Model& model, const State& state) {
  std::map<int, int> contacts;  // of each pair
  for (const ContactState& contact : state.contacts) ++contacts[contact.pair];
  const auto fewer = [](const auto& a, const auto& b) { return a.second < b.second; };
  const auto most = std::max_element(contacts.begin(), contacts.end(), fewer);
  if (most == contacts.end()) return "contacts are too much work";
  return std::to_string(state.contacts.size()) + " contacts are too much work, " + std::to_string(most->second) +
         " of them of " + name_of_pair(model, most->first) +
         "; give simpler shapes (`hull: true`), or begin where they do not overlap";
}

std::string hardest_contact(const Model& model, const State& state) {
  const ContactState* hardest = nullptr;
  for (const ContactState& own : state.contacts) {
    if (!hardest || own.force.dot(own.normal) > hardest->force.dot(hardest->normal)) hardest = &own;
  }
  return hardest ? name_of_contact(model, hardest->pair, hardest->point) : "";
}

}  // namespace sinew
