#include "sinew/sim/contact_correction.hpp"

#include <Eigen/Geometry>

#include "sinew/sim/rod_rows.hpp"

namespace sinew {

namespace {

using Kind = Collider::Kind;

void add_on_rod(const RodModel& rod, int number, const Eigen::MatrixXd& J, const Vec3& force, ContactsBeyond& beyond) {
  const int base = rod.rod.base_coordinates();
  if (base > 0) beyond.z.segment(rod.unknown, base) += J.leftCols(base).transpose() * force;
  beyond.rods[static_cast<std::size_t>(number)] += J.rightCols(rod.rod.strain_coordinates()).transpose() * force;
}

/// What forces of contacts leave unbalanced.
class Unbalanced {
 public:
  Unbalanced(const Model& model, ContactsBeyond& beyond) : model_(model), beyond_(beyond) {}

  /// J^T f times `factor`, on these `shapes` of rods.
  void add(const ContactsAt& at, double factor, const std::vector<rod::Configuration>& shapes) {
    for (std::size_t i = 0; i < at.forces.size(); ++i) {
      if (at.forces[i].isZero(0.0)) continue;
      const Touch& touch = at.room.touches[i];
      each_side(at.state.contacts[i], touch,
                [&](const ContactSide& side, const std::array<double, 3>& weights, const Vec3& point, double sign) {
                  const Vec3 force = factor * sign * at.forces[i];
                  const auto number = static_cast<std::size_t>(side.on.number);
                  switch (side.on.kind) {
                    case Kind::obstacle:
                      break;
                    case Kind::body: {
                      auto z = beyond_.z.segment<6>(model_.bodies[number].unknown);
                      z.head<3>() += force;
                      z.tail<3>() += (point - at.state.bodies[number].p).cross(force);
                      break;
                    }
                    case Kind::solid:
                      for (int k = 0; k < side.local.corners(); ++k)
                        beyond_.nodes[number].col(side.nodes[k]) += weights[static_cast<std::size_t>(k)] * force;
                      break;
                    case Kind::rod:
                      add_rod(at, shapes, touch, side, abscissa_of(side, weights), point, sign, force);
                      break;
                  }
                });
    }
  }

 private:
  /// A force on the material point of a rod that has it `at`, as add_touches has it (sim/reduced): what presses acts
  /// through the axis.
  void add_rod(const ContactsAt& at, const std::vector<rod::Configuration>& shapes, const Touch& touch,
               const ContactSide& side, double s, const Vec3& point, double sign, const Vec3& force) {
    const auto number = static_cast<std::size_t>(side.on.number);
    const rod::Branch section = rod::branch(at.room.now[number], s);
    const Vec3 &n = touch.nearest.normal, normal = n * n.dot(force),
               surface = section.R.transpose() * (point - section.p),
               out = section.R.transpose() * (sign * -n * side.local.radius);
    const Vec3 axis = side.local.corners() == 1 ? Vec3(Vec3::Zero()) : Vec3(surface - out);
    const auto add_at = [&](const Vec3& offset, const Vec3& own) {
      add_on_rod(model_.rods[number], side.on.number, rod::position_jacobian(shapes[number], s, offset), own, beyond_);
    };
    add_at(axis, normal);
    add_at(surface, force - normal);
  }

  const Model& model_;
  ContactsBeyond& beyond_;
};

/// A_c dx of solids, and of the part that A has of rods beside forces on fixed points: taken away.
void take_curvature(const Model& model, const ContactsAt& here, const std::vector<char>& exact,
                    const std::vector<Eigen::Matrix3Xd>& dx, const solve::CoupledSolution& reduced,
                    ContactsBeyond& beyond) {
  for (std::size_t i = 0; i < here.forces.size(); ++i) {
    const Touch& touch = here.room.touches[i];
    const ContactState& contact = here.state.contacts[i];
    const auto of_solid = [&](const ContactSide& side, Eigen::Index first) {
      if (side.on.kind != Kind::solid) return;
      const auto number = static_cast<std::size_t>(side.on.number);
      if (!exact[number]) return;
      for (Eigen::Index k = 0; k < side.local.corners(); ++k) {
        for (Eigen::Index l = 0; l < side.local.corners(); ++l)
          beyond.nodes[number].col(side.nodes[static_cast<std::size_t>(k)]) -=
              touch.stiffness.block<3, 3>(first + 3 * k, first + 3 * l) *
              dx[number].col(side.nodes[static_cast<std::size_t>(l)]);
      }
    };
    if (touch.stiffness.rows() > 0) {
      of_solid(contact.a, 0);
      of_solid(contact.b, 3 * Eigen::Index{contact.a.local.corners()});
    }
    if (touch.of_rod.isZero(0.0)) continue;
    const bool on_a = contact.a.on.kind == Kind::rod;
    const ContactSide& side = on_a ? contact.a : contact.b;
    const auto number = static_cast<std::size_t>(side.on.number);
    const RodModel& rod = model.rods[number];
    const rod::Configuration& shape = here.room.now[number];
    const double s = abscissa_of(side, on_a ? touch.nearest.a : touch.nearest.b);
    const Vec3 point = on_a ? touch.point_a : touch.point_b, out = (on_a ? -1.0 : 1.0) * touch.nearest.normal,
               axis = side.local.corners() == 1 ? rod::position(shape, s) : Vec3(point - side.local.radius * out);
    rod::Matrix6X motion = rod::twists_at(shape, s);
    for (Eigen::Index k = 0; k < motion.cols(); ++k)
      motion.col(k).tail<3>() = rod::moved(motion.col(k), axis - shape.origin);
    const int base = rod.rod.base_coordinates(), strains = rod.rod.strain_coordinates();
    rod::Vec6 moved = motion.rightCols(strains) * reduced.dq[number];
    if (base > 0) moved += motion.leftCols(base) * reduced.dz.segment(rod.unknown, base);
    const rod::Vec6 acts = touch.of_rod * moved;
    if (base > 0) beyond.z.segment(rod.unknown, base) -= motion.leftCols(base).transpose() * acts;
    beyond.rods[number] -= motion.rightCols(strains).transpose() * acts;
  }
}

}  // namespace

void contacts_beyond_tangent(const Model& model, const ContactsAt& here, const std::vector<Vec3>& more,
                             const ContactsAt& there, const std::vector<char>& exact,
                             const std::vector<Eigen::Matrix3Xd>& dx, const solve::CoupledSolution& reduced,
                             ContactsBeyond& beyond) {
  clear(model, beyond);
  Unbalanced unbalanced(model, beyond);
  unbalanced.add(there, -1.0, there.room.now);
  // (What a force on a fixed point of a rod does as the rod bends is in A, of those of the iterate.)
  unbalanced.add(here, 1.0, there.room.now);
  unbalanced.add({here.state, here.room, more}, 1.0, here.room.now);
  take_curvature(model, here, exact, dx, reduced, beyond);
}

void clear(const Model& model, ContactsBeyond& beyond) {
  beyond.z.setZero(model.unknowns);
  beyond.nodes.resize(model.solids.size());
  for (std::size_t i = 0; i < beyond.nodes.size(); ++i) beyond.nodes[i].setZero(3, model.solids[i].body.rest.cols());
  beyond.rods.resize(model.rods.size());
  for (std::size_t i = 0; i < beyond.rods.size(); ++i) beyond.rods[i].setZero(model.rods[i].rod.strain_coordinates());
}

namespace {

/// Calls of_solid(body, E on its nodes) of each solid; then of_rest(values, their units) of each rod, of z, and of e.
template <class Beyond, class OfSolid, class OfRest>
void each_part(const Model& model, double force, Beyond& beyond, const OfSolid& of_solid, const OfRest& of_rest) {
  for (std::size_t i = 0; i < beyond.nodes.size(); ++i) of_solid(model.solids[i].body, beyond.nodes[i]);
  for (std::size_t i = 0; i < beyond.rods.size(); ++i)
    of_rest(beyond.rods[i], force * strain_levers(model.rods[i].rod));
  of_rest(beyond.z, force * model.arms);
  of_rest(beyond.u, Eigen::VectorXd::Constant(beyond.u.size(), model.size));
}

}  // namespace

void without_units(const Model& model, double force, const ContactsBeyond& beyond, Eigen::VectorXd& x) {
  Eigen::Index size = 0, at = 0;
  each_part(
      model, force, beyond, [&](const solid::Body& body, const Eigen::Matrix3Xd&) { size += body.unknowns; },
      [&](const Eigen::VectorXd& values, const Eigen::VectorXd&) { size += values.size(); });
  x.resize(size);
  Eigen::VectorXd unknowns;
  each_part(
      model, force, beyond,
      [&](const solid::Body& body, const Eigen::Matrix3Xd& nodes) {
        solid::at_unknowns(body, nodes, unknowns);
        x.segment(at, unknowns.size()) = unknowns / force;
        at += unknowns.size();
      },
      [&](const Eigen::VectorXd& values, const Eigen::VectorXd& units) {
        x.segment(at, values.size()) = values.cwiseQuotient(units);
        at += values.size();
      });
}

void with_units(const Model& model, double force, const Eigen::VectorXd& x, ContactsBeyond& beyond) {
  Eigen::Index at = 0;
  each_part(
      model, force, beyond,
      [&](const solid::Body& body, Eigen::Matrix3Xd& nodes) {
        solid::from_unknowns(body, force * x.segment(at, body.unknowns), nodes);
        at += body.unknowns;
      },
      [&](Eigen::VectorXd& values, const Eigen::VectorXd& units) {
        values = x.segment(at, values.size()).cwiseProduct(units);
        at += values.size();
      });
}

Vec3 contact_beyond_rows(const Touch& here, const Touch& there, const Vec3& moved) {
  const auto back = Eigen::Quaterniond::FromTwoVectors(there.nearest.normal, here.nearest.normal);
  const Vec3 u =
      there.u[0] * here.nearest.normal + back * Vec3(there.frame.col(1) * there.u[1] + there.frame.col(2) * there.u[2]);
  return here.frame.transpose() * u - here.u - moved;
}

}  // namespace sinew
