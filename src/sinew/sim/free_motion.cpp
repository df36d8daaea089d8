#include "sinew/sim/free_motion.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <utility>

#include "sinew/sim/clock.hpp"
#include "sinew/sim/solid_loads.hpp"
#include "sinew/sim/solid_matrix.hpp"

namespace sinew {

namespace {

/// Loads of one volume, each with its factor at the end of the step.
template <class Visit>
void each_load(const StepContext& context, int number, const Visit& visit) {
  for (std::size_t i = 0; i < context.model.loads.size(); ++i) {
    const SolidLoadModel* load = std::get_if<SolidLoadModel>(&context.model.loads[i].on);
    if (load && load->solid == number) visit(*load, context.command.loads[i]);
  }
}

/// What the turning of contacts' normals adds to A of a solid. (Of two solids that touch, what each feels of the
/// other's motion is left out.)
void add_contact_stiffness(const SolidModel& model, int number, const State& iterate, const std::vector<Touch>& touches,
                           double* values) {
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const Eigen::Index size = touches[i].stiffness.rows();
    if (size == 0) continue;
    const auto add = [&](const ContactSide& side, Eigen::Index first) {
      if (side.on != Collider{Collider::Kind::solid, number}) return;
      const auto corners = static_cast<std::size_t>(side.local.corners());
      const auto n = static_cast<Eigen::Index>(3 * corners);
      add_over_nodes(model, {side.nodes.data(), corners}, touches[i].stiffness.block(first, first, n, n), values);
    };
    const ContactState& contact = iterate.contacts[i];
    add(contact.a, 0);
    add(contact.b, 3 * contact.a.local.corners());
  }
}

bool is_on(const State& iterate, const SolidRow& row) { return row.point < 0 || iterate.points[row.point].on; }

}  // namespace

void solid_forces(const StepContext& context, const State& iterate, const std::vector<Touch>& touches, int number,
                  SolidForces& forces) {
  const solid::Body& body = context.model.solids[number].body;
  const solid::StepStart start = context.start_of(number);
  solid::deform(body, start, iterate.solids[number].x, forces.deformation);
  solid::residual(body, start, iterate.solids[number].x, forces.deformation, context.gravity, forces.nodal);
  forces.scale = forces.nodal.scale;
  Eigen::Matrix3Xd& r = forces.nodal.sum;
  const SolidModel& model = context.model.solids[number];
  const Eigen::Matrix3Xd& x = iterate.solids[number].x;
  const auto count = [&forces](const Eigen::Matrix3Xd& acting) {
    forces.scale = std::max(forces.scale, acting.colwise().norm().maxCoeff());
  };
  if (model.springs.size() > 0) {
    const Eigen::Matrix3Xd acting = model.springs.cwiseProduct(spring_stretch(model, context.moved(model.frame), x));
    r += acting;
    count(acting);
  }
  for (const Grip& grip : context.command.grips) {
    if (grip.solid != number) continue;
    const Vec3 acting = grip.stiffness * (x.col(grip.node) - grip.to);
    r.col(grip.node) += acting;
    forces.scale = std::max(forces.scale, acting.norm());
  }
  each_load(context, number, [&](const SolidLoadModel& load, double factor) {
    const Eigen::Matrix3Xd acting = factor * load_forces(load, x);
    r -= acting;
    count(acting);
  });
  for (const SolidRow& row : context.model.solid_rows) {
    if (row.solid != number || !is_on(iterate, row)) continue;
    const std::span<const int> nodes = body.cells[row.where.element].nodes();
    for (std::size_t c = 0; c < nodes.size(); ++c)
      r.col(nodes[c]) -= row.where.weights[static_cast<Eigen::Index>(c)] * iterate.lambda.segment<3>(row.row);  // H^T
  }
  for (std::size_t i = 0; i < touches.size(); ++i) {
    const Vec3& force = touches[i].force;
    each_side(iterate.contacts[i], touches[i],
              [&](const ContactSide& side, const std::array<double, 3>& weights, const Vec3&, double sign) {
                if (side.on != Collider{Collider::Kind::solid, number}) return;
                for (int k = 0; k < side.local.corners(); ++k) r.col(side.nodes[k]) -= sign * weights[k] * force;
                forces.scale = std::max(forces.scale, force.norm());
              });
  }
  solid::at_unknowns(body, r, forces.r);
  forces.reaction.resize(model.held());
  Eigen::Index held = 0;
  solid::each_held(body, [&](int axis, int node) { forces.reaction[held++] = std::exchange(r(axis, node), 0.0); });
  forces.largest = std::sqrt(r.colwise().squaredNorm().maxCoeff());
}

bool FreeMotion::factor(const StepContext& context, const State& iterate, const std::vector<Touch>& touches, int number,
                        const SolidForces& forces, solid::Tangent kind, threads::Crew& crew, StageTimes& times,
                        solve::VolumePart& volume) {
  const SolidModel& model = context.model.solids[number];
  if (!factor_) plan(model);
  Clock clock(times.assembly);
  factor_->clear();
  double* const values = factor_->values();
  for (std::size_t k = 0; k < model.rows.size(); ++k) {
    const bool on = is_on(iterate, context.model.solid_rows[model.rows[k]]);
    const int* first = model.border.outerIndexPtr() + 3 * k;
    for (int at = first[0]; at < first[3]; ++at) factor_->border_values()[at] = on ? model.border.valuePtr()[at] : 0.0;
  }
  for (int at = model.border.outerIndexPtr()[3 * model.rows.size()]; at < model.border.nonZeros(); ++at)
    factor_->border_values()[at] = model.border.valuePtr()[at];
  assemble(model, context.start_of(number), iterate.solids[number].x, forces.deformation, kind, values);
  for (const Grip& grip : context.command.grips) {
    if (grip.solid == number) add_grip(model, grip, values);
  }
  if (kind == solid::Tangent::exact) {
    each_load(context, number, [&](const SolidLoadModel& load, double factor) {
      add_pressure_tangent(load, factor, iterate.solids[number].x, values);
    });
    add_contact_stiffness(model, number, iterate, touches, values);
  }
  clock.next(times.factor);
  push_ = -forces.r;
  const linalg::HalfSolve right{push_, pushed_, &moved_};
  if (!factor_->factor(crew, &right)) return false;
  clock.next(times.compliance);
  const std::vector<int>& place = model.fronts->border;
  const auto rows = static_cast<int>(3 * model.rows.size());
  volume.at.clear();
  for (int k = 0; k < rows; ++k) volume.at.push_back(row_of(model, context.model, k));
  factor_->kept_compliance(runs_, volume.W);
  watched_.resize(rows, static_cast<Eigen::Index>(3 * model.watched.size()));
  for (Eigen::Index k = 0; k < watched_.cols(); ++k) {
    factor_->kept_column(place[rows + k], column_);
    for (int j = 0; j < rows; ++j) watched_(j, k) = column_[place[j]];
  }
  rim_.clear();
  N_.resize(0, 0);
  Y_.resize(0, 0);
  Z_.resize(0, 0);
  if (kind == solid::Tangent::exact) add_rim(context, iterate, number, volume.W);
  volume.symmetric = Z_.size() == 0;
  return Z_.allFinite();
}

void FreeMotion::plan(const SolidModel& model) {
  const std::vector<int>& place = model.fronts->border;
  runs_.clear();
  for (int i = 0; i < static_cast<int>(3 * model.rows.size()); ++i) {
    if (i % 3 > 0 && place[i] == place[i - 1] + 1) {
      ++runs_.back().length;
    } else {
      runs_.push_back({place[i], i, 1});
    }
  }
  factor_.emplace(model.fronts);  // last: memory may run out
}

int FreeMotion::row_of(const SolidModel& model, const Model& whole, int border_row) {
  return whole.solid_rows[model.rows[border_row / 3]].row + border_row % 3;
}

/// The antisymmetric part of the pressures' tangents.
void FreeMotion::add_rim(const StepContext& context, const State& iterate, int number, Eigen::MatrixXd& W) {
  const SolidModel& model = context.model.solids[number];
  each_load(context, number, [&](const SolidLoadModel& load, double factor) {
    if (load.conservative() || factor == 0.0) return;
    const auto before = static_cast<Eigen::Index>(rim_.size()), more = static_cast<Eigen::Index>(load.rim.size());
    rim_.insert(rim_.end(), load.rim.begin(), load.rim.end());
    N_.conservativeResizeLike(Eigen::MatrixXd::Zero(before + more, before + more));
    N_.bottomRightCorner(more, more) = pressure_skew(model, load, factor, iterate.solids[number].x);
  });
  if (rim_.empty()) return;
  Y_.resize(model.body.unknowns, N_.cols());
  Eigen::MatrixXd HY(factor_->borders(), N_.cols());
  for (Eigen::Index i = 0; i < N_.cols(); ++i) {
    factor_->half_solve(Eigen::VectorXd::Unit(model.body.unknowns, rim_[static_cast<std::size_t>(i)]), half_, rows_);
    Y_.col(i) = half_;
    HY.col(i) = rows_;
  }
  const Eigen::MatrixXd C = Y_.transpose() * factor_->signs().asDiagonal() * Y_;
  // N (1 + C N)^-1 = (1 + N C)^-1 N
  Z_ = (Eigen::MatrixXd::Identity(N_.rows(), N_.cols()) + N_ * C).partialPivLu().solve(N_);
  const auto kept = HY.topRows(W.rows());
  W = Eigen::MatrixXd(W.selfadjointView<Eigen::Lower>()) - kept * Z_ * kept.transpose();
  watched_ -= (HY.bottomRows(watched_.cols()) * Z_ * kept.transpose()).transpose();
}

const Eigen::VectorXd& FreeMotion::with_rim(const Eigen::VectorXd& y) {
  if (Y_.size() == 0) return y;
  turned_ = y - Y_ * (Z_ * (Y_.transpose() * factor_->signs().cwiseProduct(y)));
  return turned_;
}

void FreeMotion::push_own(const SolidModel& model, const Model& whole, Eigen::VectorXd& c) {
  y_ = pushed_;
  rows_ = moved_;
  take_push(model, whole, c);
}

void FreeMotion::push(const SolidModel& model, const Model& whole, const Eigen::VectorXd& force, Eigen::VectorXd& c) {
  factor_->half_solve(force, y_, rows_);
  take_push(model, whole, c);
}

void FreeMotion::take_push(const SolidModel& model, const Model& whole, Eigen::VectorXd& c) {
  if (Y_.size() > 0) factor_->border_times(with_rim(y_), rows_);
  for (std::size_t k = 0; k < model.rows.size(); ++k)
    c.segment<3>(whole.solid_rows[model.rows[k]].row) += rows_.segment<3>(static_cast<Eigen::Index>(3 * k));
  free_ = rows_;
}

void FreeMotion::gather(const SolidModel& model, const Model& whole, const Eigen::VectorXd& dlambda) {
  rows_.setZero();
  for (std::size_t k = 0; k < model.rows.size(); ++k)
    rows_.segment<3>(static_cast<Eigen::Index>(3 * k)) = dlambda.segment<3>(whole.solid_rows[model.rows[k]].row);
}

void FreeMotion::watched_motion(const SolidModel& model, const Model& whole, const Eigen::VectorXd& dlambda,
                                bool pushed, Eigen::Ref<Eigen::VectorXd> motion) {
  if (model.watched.empty()) return;
  gather(model, whole, dlambda);
  for (std::size_t k = 0; k < model.watched.size(); ++k) {
    const auto first = static_cast<Eigen::Index>(3 * k), own = static_cast<Eigen::Index>(3 * model.rows.size()) + first;
    auto moved = motion.segment<3>(3 * model.watched[k]);
    moved.noalias() = watched_.middleCols<3>(first).transpose().lazyProduct(rows_.head(watched_.rows()));
    if (pushed) moved += free_.segment<3>(own);
  }
}

void FreeMotion::set_contact_rows(const linalg::SparseFactor::Rows& rows) {
  reach_ = factor_->reach({rows.innerIndexPtr(), static_cast<std::size_t>(rows.nonZeros())});
  contacts_.resize(static_cast<Eigen::Index>(reach_.size()), rows.rows());
  coupled_.resize(factor_->borders(), rows.rows());
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    x_ = rows.row(i).transpose();
    factor_->half_solve(x_, half_, rows_);
    coupled_.col(i) = rows_;
    contacts_.col(i) = half_(reach_);
  }
}

Eigen::MatrixXd FreeMotion::contact_compliance() const {
  const Eigen::VectorXd signs = factor_->signs()(reach_);
  if ((signs.array() < 0.0).any()) return contacts_.transpose() * (signs.asDiagonal() * contacts_);
  Eigen::MatrixXd D = Eigen::MatrixXd::Zero(contacts_.cols(), contacts_.cols());
  D.selfadjointView<Eigen::Lower>().rankUpdate(contacts_.transpose());
  return D.selfadjointView<Eigen::Lower>();
}

Eigen::VectorXd FreeMotion::coupled_motion(const SolidModel& model, const Model& whole,
                                           const Eigen::VectorXd& dlambda) {
  rows_.resize(factor_->borders());
  gather(model, whole, dlambda);
  return coupled_.transpose() * rows_;
}

Eigen::VectorXd FreeMotion::contact_motion(const SolidModel& model, const Model& whole,
                                           const Eigen::VectorXd& dlambda) {
  const Eigen::VectorXd coupled = coupled_motion(model, whole, dlambda);
  return coupled + contacts_.transpose() * factor_->signs().cwiseProduct(y_)(reach_);
}

void FreeMotion::push_contacts(const SolidModel& model, const Model& whole, const Eigen::VectorXd& forces,
                               Eigen::VectorXd& c) const {
  const Eigen::VectorXd moved = coupled_ * forces;
  for (std::size_t k = 0; k < model.rows.size(); ++k)
    c.segment<3>(whole.solid_rows[model.rows[k]].row) += moved.segment<3>(static_cast<Eigen::Index>(3 * k));
}

void FreeMotion::add_watched_motion(const SolidModel& model, const Eigen::VectorXd& forces,
                                    Eigen::Ref<Eigen::VectorXd> motion) const {
  for (std::size_t k = 0; k < model.watched.size(); ++k)
    motion.segment<3>(3 * model.watched[k]) +=
        coupled_.middleRows<3>(static_cast<Eigen::Index>(3 * (model.rows.size() + k))) * forces;
}

void FreeMotion::add_contact_forces(const Eigen::VectorXd& forces) {
  y_(reach_) += contacts_ * forces;
  free_ += coupled_ * forces;
}

void FreeMotion::correct(const SolidModel& model, const Model& whole, const Eigen::VectorXd& dlambda,
                         Eigen::Matrix3Xd& dx) {
  gather(model, whole, dlambda);
  if (Y_.size() == 0) {
    factor_->back_solve(y_, rows_, x_);
  } else {
    factor_->add_border_transposed(rows_, y_);
    factor_->back_solve(with_rim(y_), x_);
  }
  solid::from_unknowns(model.body, x_, dx);
}

double FreeMotion::leave(const SolidModel& model, const Model& whole, const solve::VolumePart& volume,
                         const Eigen::VectorXd& dlambda, const Eigen::Matrix3Xd& dx, Eigen::VectorXd& force,
                         Eigen::VectorXd& c) {
  gather(model, whole, dlambda);
  solid::at_unknowns(model.body, dx, x_);
  const Eigen::Index rows = volume.W.rows();
  const auto acting = rows_.head(rows);
  half_.resize(rows);
  if (volume.symmetric) {
    half_.noalias() = volume.W.selfadjointView<Eigen::Lower>() * acting;
  } else {
    half_.noalias() = volume.W.lazyProduct(acting);
  }
  free_.head(rows) += half_;
  for (int k = 0; k < rows; ++k) {
    double motion = 0.0;
    for (int at = model.border.outerIndexPtr()[k]; at < model.border.outerIndexPtr()[k + 1]; ++at) {
      const double weight = factor_->border_values()[at];
      const int unknown = model.border.innerIndexPtr()[at];
      motion += weight * x_[unknown];
      force[unknown] += weight * rows_[k];
    }
    c[row_of(model, whole, k)] += motion - free_[k];
  }
  factor_->subtract_product(x_, force);
  if (!rim_.empty()) force(rim_) -= N_ * Eigen::VectorXd(x_(rim_));
  return force.size() > 0 ? force.lpNorm<Eigen::Infinity>() : 0.0;
}

}  // namespace sinew
