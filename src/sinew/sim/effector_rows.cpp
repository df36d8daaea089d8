#include "sinew/sim/effector_rows.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/lie/rotation.hpp"
#include "sinew/sim/places.hpp"

namespace sinew {

namespace {

/// Rotation vectors change by this with the turn omega of what they tell: d exp(f) exp(f)^-1 = [V(f) df]x.
rod::Mat3 of_turn(const Vec3& f) { return lie::RotationMap::tangent(f).matrix().inverse(); }

}  // namespace

void EffectorRows::look(const StepContext& context, const State& iterate, Linearization& here, const Goal& goal,
                        const Eigen::VectorXd& errors) {
  const Model& model = context.model;
  iterate_ = &iterate;
  own_.resize(model.effectors.size());
  points_.resize(static_cast<Eigen::Index>(3 * model.watched.size()));
  for (std::size_t k = 0; k < own_.size(); ++k) {
    const EffectorModel& effector = model.effectors[k];
    const OutputModel& output = model.outputs[effector.output];
    Own& own = own_[k];
    own.first = effector.first;
    own.watched = effector.watched;
    own.unknown = own.rod = own.nearest = -1;
    own.apart = false;
    own.pair = output.pair;
    const bool strain = output.quantity == Quantity::strain;
    if (output.solid < 0) own.over_points.setZero(effector.size, 0);
    if ((output.body < 0 && output.rod < 0) || strain) own.over_z.setZero(effector.size, 0);
    if (output.rod < 0) own.over_strains.setZero(effector.size, 0);
    if (output.pair >= 0) {
      own.apart = goal.at[effector.first] > 0.0;
      for (const ContactState& contact : iterate.contacts)
        own.apart &= contact.pair != output.pair || contact.force.isZero();
      continue;
    }
    const bool turns = output.quantity == Quantity::orientation;
    const rod::Mat3 turning = turns ? of_turn(errors.segment<3>(effector.first)) : rod::Mat3(rod::Mat3::Identity());
    if (output.solid >= 0) {
      own.over_points.setIdentity(3, 3);
      if (turns) {
        // F = R U: omega = R (tr U - U)^-1 w, with w the axial vector of R^T dF - dF^T R.
        rod::Mat3 F;
        for (int i = 0; i < 3; ++i) F.col(i) = solid_point(model, iterate, output.solid, output.axes[i]);
        const rod::Mat3 R = output_axes(model, iterate, output), U = R.transpose() * F;
        const rod::Mat3 map = turning * R * (U.trace() * rod::Mat3::Identity() - U).inverse();
        own.over_points.resize(3, 9);
        for (int i = 0; i < 3; ++i)
          own.over_points.middleCols<3>(3 * i) = map * lie::hat(Vec3::Unit(i)) * R.transpose();
      }
    } else if (output.body >= 0) {
      own.unknown = model.bodies[output.body].unknown;
      own.over_z.setZero(3, 6);
      own.over_z.middleCols<3>(turns ? 3 : 0) = turning;
    } else if (output.rod >= 0) {
      const RodModel& rod = model.rods[output.rod];
      const rod::Configuration& shape = here.reduced().rods[output.rod].shape;
      const int nb = rod.rod.base_coordinates();
      own.rod = output.rod;
      own.unknown = rod.unknown;
      if (strain) {
        own.over_strains.setZero(1, rod.rod.strain_coordinates());
        const Eigen::VectorXd none = Eigen::VectorXd::Zero(nb + rod.rod.strain_coordinates());
        const double at_rest = rod::strain(rod.rod, none, output.abscissa)[effector.strain];
        for (Eigen::Index i = 0; i < own.over_strains.cols(); ++i)  // linear in q
          own.over_strains(0, i) =
              rod::strain(rod.rod, Eigen::VectorXd::Unit(none.size(), nb + i), output.abscissa)[effector.strain] -
              at_rest;
        continue;
      }
      const Eigen::Matrix3Xd J = turns ? Eigen::Matrix3Xd(turning * rod::twists_at(shape, output.abscissa).topRows<3>())
                                       : rod::position_jacobian(shape, output.abscissa);
      own.over_z = J.leftCols(nb);
      own.over_strains = J.rightCols(rod.rod.strain_coordinates());
    }
  }
}

void EffectorRows::change_by(const solve::CoupledSolution& solution, Eigen::Ref<Eigen::VectorXd> change) const {
  change.setZero();
  for (const Own& own : own_) {
    auto part = change.segment(own.first, own.over_z.rows());
    if (own.watched >= 0) part += own.over_points.lazyProduct(points_.segment(3 * own.watched, own.over_points.cols()));
    if (own.over_z.cols() > 0) part += own.over_z.lazyProduct(solution.dz.segment(own.unknown, own.over_z.cols()));
    if (own.over_strains.cols() > 0) part += own.over_strains.lazyProduct(solution.dq[own.rod]);
  }
}

void EffectorRows::motion(Linearization& here, const solve::CoupledSolution& solution, bool pushed,
                          Eigen::Ref<Eigen::VectorXd> change) {
  here.watched_motion(solution.dlambda, pushed, points_);
  change_by(solution, change);
}

void EffectorRows::force_on(const Model& model, int component, std::vector<Eigen::VectorXd>& solids,
                            solve::RightSide& side) const {
  for (std::size_t i = 0; i < solids.size(); ++i) solids[i].setZero(model.solids[i].body.unknowns);
  clear(model, side);
  for (const Own& own : own_) {
    const Eigen::Index row = component - own.first;
    if (row < 0 || row >= own.over_z.rows()) continue;
    if (own.watched >= 0) {
      const int number = model.watched[own.watched].solid;
      const SolidModel& solid = model.solids[number];
      const auto place = std::find(solid.watched.begin(), solid.watched.end(), own.watched) - solid.watched.begin();
      const auto first = static_cast<Eigen::Index>(3 * (solid.rows.size() + static_cast<std::size_t>(place)));
      solids[number] +=
          solid.border.middleRows(first, own.over_points.cols()).transpose() * own.over_points.row(row).transpose();
    }
    if (own.over_z.cols() > 0) side.r.segment(own.unknown, own.over_z.cols()) -= own.over_z.row(row).transpose();
    if (own.over_strains.cols() > 0) side.chains[own.rod] -= own.over_strains.row(row).transpose();
  }
}

void EffectorRows::choose_gaps(Linearization& here, const Eigen::MatrixXd& B) {
  const ContactForces& contacts = here.contact_forces();
  for (Own& own : own_) {
    double least = INFINITY;
    for (std::size_t c = 0; own.apart && c < contacts.touching().size(); ++c) {
      const int number = contacts.touching()[c];
      if (iterate_->contacts[number].pair != own.pair) continue;
      const double gap = here.contacts().touches[number].u[0];
      const double way = gap / std::max(B.row(static_cast<Eigen::Index>(3 * c)).norm(), 1e-300);
      if (!(way < least)) continue;
      least = way;
      own.nearest = static_cast<int>(c);
    }
  }
}

void EffectorRows::force_errors(Linearization& here, const Goal& goal, Eigen::Ref<Eigen::VectorXd> errors) const {
  for (const Own& own : own_) {
    if (own.pair >= 0) errors[own.first] = -goal.at[own.first];
  }
  if (!here.touched()) return;
  const ContactForces& contacts = here.contact_forces();
  add_forces(here, contacts.found(), errors);
  Eigen::VectorXd gaps = contacts.problem().D * contacts.found() + contacts.problem().b;
  for (std::size_t c = 0; c < contacts.touching().size(); ++c)
    gaps[static_cast<Eigen::Index>(3 * c)] += here.contacts().least[contacts.touching()[c]];
  add_gaps(gaps, errors);
}

void EffectorRows::pressed(Linearization& here, const Eigen::VectorXd& forces, const Eigen::VectorXd& u,
                           const solve::CoupledSolution& response, Eigen::Ref<Eigen::VectorXd> change) {
  here.watched_motion(response.dlambda, false, points_);
  here.pressed_motion(forces, points_);
  change_by(response, change);
  add_forces(here, forces, change);
  add_gaps(u, change);
}

void EffectorRows::add_forces(const Linearization& here, const Eigen::VectorXd& forces,
                              Eigen::Ref<Eigen::VectorXd> change) const {
  const std::vector<int>& touching = here.contact_forces().touching();
  for (const Own& own : own_) {
    for (std::size_t c = 0; own.pair >= 0 && c < touching.size(); ++c) {
      if (iterate_->contacts[touching[c]].pair == own.pair)
        change[own.first] += forces[static_cast<Eigen::Index>(3 * c)];
    }
  }
}

void EffectorRows::add_gaps(const Eigen::VectorXd& u, Eigen::Ref<Eigen::VectorXd> change) const {
  for (const Own& own : own_) {
    if (own.nearest >= 0) change[own.first] -= kPerGap * u[3 * own.nearest];
  }
}

}  // namespace sinew
