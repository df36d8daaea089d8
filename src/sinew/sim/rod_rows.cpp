#include "sinew/sim/rod_rows.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace sinew {

namespace {

/// What a generalised force of a strain is divided by to compare it with forces: the lever arm of its coordinate.
double lever(const rod::Rod& rod, const rod::Section& section, const rod::Mode& mode) {
  return section.length() * (mode.strain < 3 ? rod.length() : 1.0);
}

}  // namespace

RodRows::RodRows(const StepContext& context, const State& iterate, int number, Reduced& reduced)
    : context_(context),
      iterate_(iterate),
      number_(number),
      reduced_(reduced),
      shape_(
          rod::configure(context.model.rods[number].rod, base_of(context, iterate, number), iterate.rods[number].q)) {}

void RodRows::slide(double s, const Vec3& force, int unknown) {
  rod::PointLoad own{s, Vec3::Zero(), force};
  own.slide = static_cast<int>(slides_.size());
  loads_.push_back(own);
  slides_.push_back(unknown);
}

void RodRows::attach(int border, const rod::CurvePoint& point, const Vec3& offset, const Vec3& f) {
  linalg::Attachment own;
  own.link = point.section;
  own.g << (point.position + point.R * offset - shape_.origin).cross(f), f;
  own.b = point.twists.transpose() * own.g;
  attachments_.emplace_back(std::move(own), border);
}

void RodRows::add_masses() {
  // Inertia of the mass points by backward Euler on their positions, and their weight.
  const rod::Rod& rod = *shape_.rod;
  const RodState& start = context_.start.rods[number_];
  const double rate = context_.rate;
  double acting = 0.0;  // inertia and weight each by themselves: in free fall they cancel
  const Eigen::Matrix3Xd positions = rod::mass_positions(shape_);
  for (std::size_t i = 0; i < rod.masses.size(); ++i) {
    const rod::MassPoint& mass = rod.masses[i];
    const auto column = static_cast<Eigen::Index>(i);
    const Vec3 acceleration =
        ((positions.col(column) - start.masses.col(column)) * rate - start.velocity.col(column)) * rate;
    rod::PointLoad own{mass.s, mass.offset, mass.mass * (acceleration - context_.gravity), mass.mass * rate * rate};
    own.bends = !context_.first_guess;
    own.spread = true;
    load(own);
    acting += mass.mass * (acceleration.norm() + context_.gravity.norm());
  }
  reduced_.scale = std::max(reduced_.scale, acting);
}

void RodRows::add_forces() {
  for (std::size_t i = 0; i < context_.model.loads.size(); ++i) {
    const RodLoadModel* const on_rod = std::get_if<RodLoadModel>(&context_.model.loads[i].on);
    if (!on_rod || on_rod->rod != number_) continue;
    const RodLoadModel& own = *on_rod;
    const double factor = context_.command.loads[i];
    double acting = 0.0;
    for (const RodLoadModel::At& at : own.at) {
      const rod::Mat3 R = own.follower ? rod::branch(shape_, at.s).R : rod::Mat3(rod::Mat3::Identity());
      rod::PointLoad point{at.s, Vec3::Zero(), R * (-factor * at.weight * own.force)};
      point.moment = R * (-factor * at.weight * own.moment);
      point.follower = own.follower;
      point.spread = !own.concentrated();
      load(point);
      acting += point.force.norm() + point.moment.norm() / shape_.rod->length();
    }
    reduced_.scale = std::max(reduced_.scale, acting);
  }
}

void RodRows::add_tendons(rod::Equations& equations, solve::ChainPart& part) {
  const rod::Rod& rod = *shape_.rod;
  const Eigen::VectorXd& q = iterate_.rods[number_].q;
  for (std::size_t i = 0; i < context_.model.actuators.size(); ++i) {
    const ActuatorModel& actuator = context_.model.actuators[i];
    if (actuator.line.rod != number_ || !actuator.tendon) continue;
    const rod::TendonLength length = rod::tendon_length(rod, *actuator.tendon, q);
    const double tension = actuator.row < 0 ? context_.command.actuators[i] : iterate_.lambda[actuator.row];
    equations.r.tail(rod.strain_coordinates()) += tension * length.gradient;
    equations.chain.D += tension * length.hessian;
    for (rod::Balance& at : equations.internal) {
      const int section = rod.section_at(at.s);
      const auto wrench = [&](int of) -> rod::Vec6 {
        return tension * rod::tendon_wrench(rod, *actuator.tendon, q, of, at.s);
      };
      if (at.s < actuator.tendon->to) at.beyond -= wrench(section);
      if (at.s > actuator.tendon->from) at.before -= wrench(at.s > rod.sections[section].begin ? section : section - 1);
    }
    reduced_.scale = std::max(reduced_.scale, std::abs(tension));
    if (actuator.row < 0) continue;
    const double off = actuator.tendon_length - context_.command.actuators[i] - length.value;
    problem().c[actuator.row] = off;
    reduced_.violation = std::max(reduced_.violation, std::abs(off));
    part.whole.conservativeResize(rod.strain_coordinates(), part.whole.cols() + 1);
    part.whole.rightCols<1>() = length.gradient;
    part.whole_at.push_back(row(actuator.row));
  }
}

void RodRows::measure(const rod::Equations& equations) {
  const rod::Rod& rod = *shape_.rod;
  const int nb = rod.base_coordinates();
  const Eigen::VectorXd& q = iterate_.rods[number_].q;
  for (int i = 0; i < rod.count(); ++i) {
    const rod::Section& section = rod.sections[i];
    const Eigen::VectorXd elastic = section.stiffness * rod.of_section(q, i);
    for (std::size_t c = 0; c < section.modes.size(); ++c) {
      const auto at = static_cast<Eigen::Index>(c);
      const double arm = lever(rod, section, section.modes[c]);
      reduced_.largest = std::max(reduced_.largest, std::abs(equations.r[nb + rod.first[i] + at]) / arm);
      reduced_.scale = std::max(reduced_.scale, std::abs(elastic[at]) / arm);
    }
  }
}

void RodRows::finish() {
  const rod::Rod& rod = *shape_.rod;
  const RodModel& model = context_.model.rods[number_];
  const int nb = rod.base_coordinates();
  const auto earlier = [](const rod::PointLoad& a, const rod::PointLoad& b) { return a.s < b.s; };
  add_forces();
  for (const ActuatorModel& actuator : context_.model.actuators) {
    if (actuator.line.rod != number_ || !actuator.tendon) continue;
    for (const double end : {actuator.tendon->from, actuator.tendon->to}) load({end, Vec3::Zero(), Vec3::Zero()});
  }
  std::stable_sort(loads_.begin(), loads_.end(), earlier);
  const auto sorted = static_cast<std::ptrdiff_t>(loads_.size());
  loads_.reserve(loads_.size() + rod.masses.size());
  add_masses();  // most of them, and sorted already
  std::inplace_merge(loads_.begin(), loads_.begin() + sorted, loads_.end(), earlier);
  rod::Equations equations = rod::make_equations(shape_, rod::conservative(loads_), static_cast<int>(slides_.size()));
  rod::add_loads(shape_, loads_, equations);
  rod::add_elasticity(rod, iterate_.rods[number_].q, context_.start.rods[number_].q, context_.rate, equations);
  for (std::size_t i = 0; i < slides_.size(); ++i) {
    problem().B.add(slides_[i], slides_[i], equations.slides[i].second);
    attachments_.emplace_back(equations.slides[i].attachment, slides_[i]);
  }
  std::stable_sort(attachments_.begin(), attachments_.end(),
                   [](const auto& a, const auto& b) { return a.first.link < b.first.link; });

  solve::ChainPart& part = problem().chains[number_];
  part.attachments.clear();
  part.at.clear();
  part.whole_at.clear();
  part.base = shape_.base;
  part.first_base = model.unknown;
  part.whole.resize(rod.strain_coordinates(), 0);
  add_tendons(equations, part);
  measure(equations);
  for (auto& [attachment, border] : attachments_) {
    part.attachments.push_back(std::move(attachment));
    part.at.push_back(border);
  }
  part.r = equations.r.tail(rod.strain_coordinates());
  part.chain = std::move(equations.chain);
  problem().r.segment(model.unknown, nb) += equations.r.head(nb);
  problem().B.add(model.unknown, model.unknown, equations.base);
  reduced_.internal[number_] = std::move(equations.internal);
}

}  // namespace sinew
