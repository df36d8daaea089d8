#include "sinew/sim/contact_forces.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "sinew/sim/places.hpp"
#include "sinew/threads/interruption.hpp"

namespace sinew {

namespace {

using Kind = Collider::Kind;
constexpr double kNoCompliance = 1e-12;  ///< of the scene's size over what its bodies bear: rounding

}  // namespace

void ContactForces::add_rows(const StepContext& context, const State& iterate, const ContactRoom& room,
                             const Reduced& reduced) {
  const Model& model = context.model;
  on_bodies_.clear();
  on_rods_.clear();
  on_solids_.resize(model.solids.size());
  rows_of_.assign(model.solids.size(), {});
  std::vector<std::vector<Eigen::Triplet<double>>> entries(model.solids.size());
  touching_ = room.playing;
  for (int contact = 0; contact < static_cast<int>(touching_.size()); ++contact) {
    const Touch& touch = room.touches[touching_[contact]];
    each_side(iterate.contacts[touching_[contact]], touch,
              [&](const ContactSide& side, const std::array<double, 3>& weights, const Vec3& at, double sign) {
                const Eigen::Matrix3d rows = sign * touch.frame.transpose();
                switch (side.on.kind) {
                  case Kind::obstacle:
                    break;
                  case Kind::body: {
                    OnBody own{contact, model.bodies[side.on.number].unknown, Eigen::Matrix3Xd(3, 6)};
                    own.J << rows, -rows * lie::hat(at - iterate.bodies[side.on.number].p);
                    on_bodies_.push_back(own);
                    break;
                  }
                  case Kind::solid: {
                    const solid::Body& body = model.solids[side.on.number].body;
                    std::vector<int>& known = rows_of_[side.on.number];
                    if (known.empty() || known.back() != 3 * contact + 2) {
                      for (int r = 0; r < 3; ++r) known.push_back(3 * contact + r);
                    }
                    const auto first = static_cast<int>(known.size()) - 3;
                    for (int k = 0; k < side.local.corners(); ++k) {
                      for (int axis = 0; axis < 3; ++axis) {
                        const int unknown = body.unknown(axis, side.nodes[k]);
                        if (unknown < 0) continue;
                        for (int r = 0; r < 3; ++r)
                          entries[side.on.number].emplace_back(first + r, unknown, rows(r, axis) * weights[k]);
                      }
                    }
                    break;
                  }
                  case Kind::rod: {
                    const RodModel& rod = model.rods[side.on.number];
                    const rod::Configuration& shape = reduced.rods[side.on.number].shape;
                    const int nb = rod.rod.base_coordinates();
                    const double s = abscissa_of(side, weights);
                    const rod::Branch section = rod::branch(shape, s);
                    const Vec3 offset = section.R.transpose() * (at - section.p);
                    const Eigen::Matrix3Xd J = rows * rod::position_jacobian(shape, s, offset);
                    if (nb > 0) on_bodies_.push_back({contact, rod.unknown, J.leftCols(nb)});
                    on_rods_.push_back({contact, side.on.number, J.rightCols(rod.rod.strain_coordinates())});
                    break;
                  }
                }
              });
  }
  rubbing_.clear();
  for (const int k : model.rubbing) {
    const PointModel& point = model.points[k];
    Rubbing& own = rubbing_.emplace_back();
    own.point = k;
    own.row = point.row;
    if (!iterate.points[k].on) continue;
    own.friction = point.friction;
    own.tangent = rod::curve_point(reduced.rods[point.line.rod].shape, iterate.points[k].s).derivative.normalized();
    on_bodies_.push_back({contacts() - 1, point.unknown, Eigen::Matrix3Xd(Vec3::UnitY())});
  }
  for (std::size_t s = 0; s < model.solids.size(); ++s) {
    on_solids_[s].resize(static_cast<Eigen::Index>(rows_of_[s].size()), model.solids[s].body.unknowns);
    on_solids_[s].setFromTriplets(entries[s].begin(), entries[s].end());
  }
}

/// How the rows move with a reduced solution: bodies, rods, and volumes pushed by their coupling rows are another part.
void ContactForces::motion(const solve::CoupledSolution& solution, Eigen::Ref<Eigen::VectorXd> u) const {
  bodies_motion(solution, u);
  for (const OnRod& own : on_rods_) u.segment<3>(3 * own.contact) += own.J * solution.dq[own.rod];
}

void ContactForces::bodies_motion(const solve::CoupledSolution& solution, Eigen::Ref<Eigen::VectorXd> u) const {
  for (const OnBody& own : on_bodies_)
    u.segment<3>(3 * own.contact) += own.J.lazyProduct(solution.dz.segment(own.unknown, own.J.cols()));
}

void ContactForces::prepare(const StepContext& context, const State& iterate, const ContactRoom& room,
                            const Reduced& reduced, std::vector<FreeMotion>& free, solve::CoupledFactor& factor) {
  add_rows(context, iterate, room, reduced);
  unanswered_ = -1;
  coulomb_.begin();
  const int n = 3 * contacts();
  problem_.D.setZero(n, n);
  problem_.mu.setOnes(n / 3);
  for (std::size_t i = 0; i < touching_.size(); ++i)
    problem_.mu[static_cast<Eigen::Index>(i)] = context.model.pairs[iterate.contacts[touching_[i]].pair].friction;
  for (std::size_t s = 0; s < free.size(); ++s) {
    if (rows_of_[s].empty()) continue;
    free[s].set_contact_rows(on_solids_[s]);
    const Eigen::MatrixXd own = free[s].contact_compliance();
    for (std::size_t i = 0; i < rows_of_[s].size(); ++i) {
      for (std::size_t j = 0; j < rows_of_[s].size(); ++j)
        problem_.D(rows_of_[s][i], rows_of_[s][j]) += own(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
    }
  }
  moved_.resize(context.model.rods.size());
  for (std::size_t i = 0; i < moved_.size(); ++i) {
    const auto on_it = [i](const OnRod& own) { return own.rod == static_cast<int>(i); };
    const bool touched = std::any_of(on_rods_.begin(), on_rods_.end(), on_it);
    moved_[i].setZero(touched ? context.model.rods[i].rod.strain_coordinates() : 0, n);
  }
  for (int row = 0; row < n; ++row) {
    threads::Interruption::check();
    if (row >= 3 * static_cast<int>(touching_.size()) && row % 3 != 1) continue;
    lambda_ = Eigen::VectorXd::Unit(n, row);
    respond(context, free, factor, lambda_);
    bodies_motion(answer_, problem_.D.col(row));
    for (std::size_t i = 0; i < moved_.size(); ++i) {
      if (moved_[i].rows() > 0) moved_[i].col(row) = answer_.dq[i];
    }
    for (std::size_t s = 0; s < free.size(); ++s) {
      if (rows_of_[s].empty()) continue;
      own_ = free[s].coupled_motion(context.model.solids[s], context.model, answer_.dlambda);
      for (std::size_t i = 0; i < rows_of_[s].size(); ++i)
        problem_.D(rows_of_[s][i], row) += own_[static_cast<Eigen::Index>(i)];
    }
  }
  // Rods' part of all columns together, which is most of the work where there are rods.
  for (const OnRod& own : on_rods_) problem_.D.middleRows<3>(3 * own.contact).noalias() += own.J * moved_[own.rod];
  problem_.D = (0.5 * (problem_.D + problem_.D.transpose())).eval();
  for (std::size_t i = touching_.size(); i < static_cast<std::size_t>(contacts()); ++i) {
    const auto k = static_cast<Eigen::Index>(3 * i);
    double& own = problem_.D(k + 1, k + 1);
    if (!(own > 0.0)) own = 1.0;  // a point beyond the tip
    problem_.D(k, k) = problem_.D(k + 2, k + 2) = own;
  }
  answered_.assign(touching_.size(), true);
  const double compliance = context.model.size / context.model.bearing;
  for (std::size_t i = 0; i < touching_.size(); ++i) {
    const auto k = static_cast<Eigen::Index>(3 * i);
    answered_[i] = std::abs(problem_.D(k, k)) > kNoCompliance * compliance;
    if (answered_[i]) continue;
    for (Eigen::Index row = k; row < k + 3; ++row)
      if (std::abs(problem_.D(row, row)) <= kNoCompliance * compliance) problem_.D(row, row) = compliance;
  }
}

namespace {

bool sticks(const Touch& touch, double friction) {
  const Vec3 force = touch.frame.transpose() * touch.force;
  return force.tail<2>().norm() < (1.0 - 1e-6) * friction * force[0];
}

/// What is closed without a force holds one way.
bool is_open(const Model& model, const Touch& touch) { return touch.u[0] > 1e-6 * model.size; }

bool bends_on_obstacle(const ContactState& own) {
  const auto bends = [](const ContactSide& side) { return side.on.kind == Kind::rod || side.on.kind == Kind::solid; };
  const auto stands = [](const ContactSide& side) { return side.on.kind == Kind::obstacle; };
  return (bends(own.a) && stands(own.b)) || (bends(own.b) && stands(own.a));
}

}  // namespace

int ContactForces::held(const ContactRoom& room) const {
  std::vector<Eigen::Index> rows;
  for (std::size_t i = 0; i < touching_.size(); ++i) {
    const Touch& touch = room.touches[static_cast<std::size_t>(touching_[i])];
    if (!(touch.force.dot(touch.nearest.normal) > 0.0)) continue;
    const auto k = static_cast<Eigen::Index>(3 * i);
    rows.push_back(k);
    if (sticks(touch, problem_.mu[static_cast<Eigen::Index>(i)])) rows.insert(rows.end(), {k + 1, k + 2});
  }
  if (rows.empty()) return 0;
  const Eigen::MatrixXd D = problem_.D(rows, rows);
  const Eigen::VectorXd own = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(D, Eigen::EigenvaluesOnly).eigenvalues();
  return static_cast<int>((own.array() < -1e-12 * own.cwiseAbs().maxCoeff()).count());
}

bool ContactForces::conserve(const StepContext& context, const State& iterate, const ContactRoom& room, double scale) {
  constexpr double kPresses = 1e-8;
  if (!context.model.rubbing.empty()) return false;
  return std::all_of(room.playing.begin(), room.playing.end(), [&](int number) {
    const ContactState& own = iterate.contacts[number];
    const Touch& touch = room.touches[static_cast<std::size_t>(number)];
    const double force = touch.force.dot(touch.nearest.normal);
    if (force == 0.0) return is_open(context.model, touch);
    return force > kPresses * scale && context.model.pairs[own.pair].friction == 0.0 && bends_on_obstacle(own);
  });
}

bool ContactForces::stick_on_obstacles(const StepContext& context, const State& iterate, const ContactRoom& room) {
  if (!context.model.rubbing.empty()) return false;
  return std::all_of(room.playing.begin(), room.playing.end(), [&](int number) {
    const ContactState& own = iterate.contacts[number];
    const Touch& touch = room.touches[static_cast<std::size_t>(number)];
    if (!(touch.force.dot(touch.nearest.normal) > 0.0)) return is_open(context.model, touch);
    const double friction = context.model.pairs[own.pair].friction;
    return bends_on_obstacle(own) && (friction == 0.0 || sticks(touch, friction));
  });
}

/// What forces at the contacts add to a right side of the reduced problem.
void ContactForces::push(const StepContext& context, const Eigen::VectorXd& lambda, const std::vector<FreeMotion>& free,
                         solve::RightSide& side) {
  const auto pushed = [&lambda](int contact) { return !lambda.segment<3>(3 * contact).isZero(0.0); };
  for (const OnBody& own : on_bodies_) {
    if (pushed(own.contact))
      side.r.segment(own.unknown, own.J.cols()) -= own.J.transpose() * lambda.segment<3>(3 * own.contact);
  }
  for (const OnRod& own : on_rods_) {
    if (pushed(own.contact)) side.chains[own.rod].noalias() -= own.J.transpose() * lambda.segment<3>(3 * own.contact);
  }
  for (std::size_t s = 0; s < free.size(); ++s) {
    if (!rows_of_[s].empty())
      free[s].push_contacts(context.model.solids[s], context.model, lambda(rows_of_[s]), side.c);
  }
}

void ContactForces::respond(const StepContext& context, std::vector<FreeMotion>& free, solve::CoupledFactor& factor,
                            const Eigen::VectorXd& lambda) {
  clear(context.model, side_);
  push(context, lambda, free, side_);
  factor.solve(side_, answer_);
}

ContactForces::At ContactForces::at(const StepContext& context, const State& iterate, const ContactRoom& room,
                                    int contact) const {
  const auto i = static_cast<std::size_t>(contact);
  if (i < touching_.size()) {
    const Touch& touch = room.touches[touching_[i]];
    return {touch.frame.transpose() * touch.force, touch.u - Vec3(room.least[touching_[i]], 0.0, 0.0)};
  }
  const Rubbing& own = rubbing_[i - touching_.size()];
  const PointState& point = iterate.points[own.point];
  return {Vec3(own.limit(iterate.lambda), point.friction, 0.0),
          Vec3(0.0, point.s - context.start.points[own.point].s, 0.0)};
}

void ContactForces::solve(const StepContext& context, const State& iterate, const ContactRoom& room,
                          std::vector<FreeMotion>& free, solve::CoupledFactor& factor, solve::CoupledSolution& solution,
                          ContactChange& change, const Eigen::VectorXd* beyond) {
  constexpr int kMostTurns = 50;
  const Eigen::Index n = 3 * Eigen::Index{contacts()};
  problem_.b.resize(n);
  old_.resize(n);
  for (int i = 0; i < contacts(); ++i) {
    const At own = at(context, iterate, room, i);
    problem_.b.segment<3>(3 * i) = own.u;
    old_.segment<3>(3 * i) = own.force;
  }
  rows_.resize(n);
  motion_of(context, free, solution, true, rows_);
  moved_rows_ = rows_;
  problem_.b += rows_ - problem_.D * old_;
  if (beyond) problem_.b += *beyond;
  // What nothing answers stays as it is; where it closes all the same, no force would stop it.
  unanswered_ = -1;
  const double little = context.model.scene.newton.tolerance * context.model.size;
  for (std::size_t i = 0; i < touching_.size(); ++i) {
    if (answered_[i]) continue;
    double& b = problem_.b[static_cast<Eigen::Index>(3 * i)];
    const double closes = room.gaps[touching_[i]] - (b + room.least[touching_[i]]);
    if (b < -little && closes > little) unanswered_ = touching_[i];
    b = std::max(b, 0.0);
  }
  if (unanswered_ >= 0) {
    solution.ok = false;
    return;
  }
  if (!beyond) lambda_ = old_;
  rows_ = iterate.lambda + solution.dlambda;
  for (int turn = 0; turn < kMostTurns; ++turn) {
    // What presses a rod against its channel depends on its friction elsewhere: along the rod each turn settles one
    // point more, and all of them soon.
    double changed = 0.0, largest = 0.0;
    for (std::size_t i = 0; i < rubbing_.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(3 * (touching_.size() + i));
      const double limit = rubbing_[i].limit(rows_);
      changed = std::max(changed, std::abs(limit + problem_.b[k] / problem_.D(k, k)));
      largest = std::max(largest, limit);
      problem_.b[k] = -problem_.D(k, k) * limit;
      problem_.b[k + 2] = 0.0;
    }
    if (turn > 0 && changed <= kCoulombTolerance * largest) break;
    const solve::CoulombReport found = coulomb_.solve(problem_, kCoulombTolerance, lambda_);
    report_.sweeps += found.sweeps;
    report_.newton += found.newton;
    report_.work += found.work;
    report_.cut += found.cut ? 1 : 0;
    report_.unsolved += found.solved ? 0 : 1;
    report_.left = found.residual;
    respond(context, free, factor, lambda_ - old_);
    rows_ = iterate.lambda + solution.dlambda + answer_.dlambda;
    if (rubbing_.empty()) break;
  }
  moved_rows_ += problem_.D * (lambda_ - old_);
  change.contacts.clear();
  for (const Touch& touch : room.touches) change.contacts.push_back({touch.force, Vec3::Zero(), touch.nearest.normal});
  change.frictions.assign(rubbing_.size(), 0.0);
  add(room, free, lambda_ - old_, solution, change);
}

/// What `more` of forces, which `answer_` is the response to, adds.
void ContactForces::add(const ContactRoom& room, std::vector<FreeMotion>& free, const Eigen::VectorXd& more,
                        solve::CoupledSolution& solution, ContactChange& change) {
  solution += answer_;
  solution.ok = solution.ok && answer_.ok;
  for (std::size_t s = 0; s < free.size(); ++s) {
    if (!rows_of_[s].empty()) free[s].add_contact_forces(more(rows_of_[s]));
  }
  for (std::size_t i = 0; i < touching_.size(); ++i)
    change.contacts[touching_[i]].more +=
        room.touches[touching_[i]].frame * more.segment<3>(static_cast<Eigen::Index>(3 * i));
  for (std::size_t i = 0; i < rubbing_.size(); ++i)
    change.frictions[i] += more[static_cast<Eigen::Index>(3 * (touching_.size() + i) + 1)];
}

void ContactForces::change(const StepContext& context, const ContactRoom& room, std::vector<FreeMotion>& free,
                           solve::CoupledFactor& factor, const Eigen::VectorXd& moved, const Eigen::VectorXd& lambda,
                           solve::CoupledSolution& solution, ContactChange& change) {
  problem_.b += moved;
  const Eigen::VectorXd more = lambda - lambda_;
  lambda_ = lambda;
  report_.left = solve::residual(problem_, lambda_);
  respond(context, free, factor, more);
  add(room, free, more, solution, change);
}

void ContactForces::motion_of(const StepContext& context, std::vector<FreeMotion>& free,
                              const solve::CoupledSolution& solution, bool pushed, Eigen::Ref<Eigen::VectorXd> u) {
  u.setZero();
  motion(solution, u);
  for (std::size_t s = 0; s < free.size(); ++s) {
    if (rows_of_[s].empty()) continue;
    const SolidModel& model = context.model.solids[s];
    own_ = pushed ? free[s].contact_motion(model, context.model, solution.dlambda)
                  : free[s].coupled_motion(model, context.model, solution.dlambda);
    for (std::size_t i = 0; i < rows_of_[s].size(); ++i) u[rows_of_[s][i]] += own_[static_cast<Eigen::Index>(i)];
  }
}

const solve::CoupledSolution& ContactForces::response_to(const StepContext& context, std::vector<FreeMotion>& free,
                                                         solve::CoupledFactor& factor, const Eigen::VectorXd& forces) {
  respond(context, free, factor, forces);
  return answer_;
}

void ContactForces::watched_motion(const StepContext& context, const std::vector<FreeMotion>& free,
                                   const Eigen::VectorXd& forces, Eigen::Ref<Eigen::VectorXd> motion) const {
  for (std::size_t s = 0; s < free.size(); ++s) {
    if (!rows_of_[s].empty()) free[s].add_watched_motion(context.model.solids[s], forces(rows_of_[s]), motion);
  }
}

ContactForces::Worst ContactForces::worst(const StepContext& context, const State& iterate,
                                          const ContactRoom& room) const {
  if (!wanted(context.model, room)) return {};
  if (problem_.D.rows() != 3 * contacts() || touching_ != room.playing) {  // of open ones no compliance is asked for
    if (!context.model.rubbing.empty()) return {INFINITY};
    const auto loaded = std::find_if(room.playing.begin(), room.playing.end(), [&](int i) {
      return !iterate.contacts[i].force.isZero(0.0) || room.touches[i].u[0] < room.least[i];
    });
    return loaded == room.playing.end() ? Worst{} : Worst{INFINITY, *loaded};
  }
  Worst worst;
  for (int i = 0; i < contacts(); ++i) {
    const auto [force, u] = at(context, iterate, room, i);
    const auto [normal, tangent] = solve::own_compliance(problem_, i);
    const double radius = problem_.mu[i] * std::max(0.0, force[0]) * tangent;
    const Eigen::Vector2d t = tangent * force.tail<2>(), aim = t - u.tail<2>();
    const double length = aim.norm();
    const Eigen::Vector2d on = length > radius ? Eigen::Vector2d(aim * (radius / length)) : aim;
    const double error = std::max(std::abs(std::min(normal * force[0], u[0])), (t - on).norm());
    if (error <= worst.error) continue;  // (NaN stays)
    const int touching = static_cast<int>(touching_.size());
    worst = i < touching ? Worst{error, touching_[static_cast<std::size_t>(i)]}
                         : Worst{error, -1, rubbing_[static_cast<std::size_t>(i - touching)].point};
  }
  return worst;
}

}  // namespace sinew
