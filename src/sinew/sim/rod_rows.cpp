#include "sinew/sim/rod_rows.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <numeric>

#include "sinew/sim/motors.hpp"

namespace sinew {

namespace {

/// What a generalised force of a strain is divided by to compare it with forces: the lever arm of its coordinate.
double lever(const rod::Rod& rod, const rod::Section& section, const rod::Mode& mode) {
  return section.length() * (mode.strain < 3 ? rod.length() : 1.0);
}

/// Stable, in place, for lists that are short or nearly sorted.
template <class T, class Earlier>
void sort_few(std::vector<T>& list, const Earlier& earlier) {
  for (auto at = list.begin(); at != list.end(); ++at)
    std::rotate(std::upper_bound(list.begin(), at, *at, earlier), at, at + 1);
}

}  // namespace

Eigen::VectorXd strain_levers(const rod::Rod& rod) {
  Eigen::VectorXd levers(rod.strain_coordinates());
  for (int i = 0; i < rod.count(); ++i) {
    const rod::Section& section = rod.sections[i];
    for (std::size_t c = 0; c < section.modes.size(); ++c)
      levers[rod.first[i] + static_cast<int>(c)] = lever(rod, section, section.modes[c]);
  }
  return levers;
}

RodRows::RodRows(const StepContext& context, const State& iterate, int number, Reduced& reduced)
    : context_(context), iterate_(iterate), number_(number), reduced_(reduced), own_(reduced.rods[number]) {
  rod::reconfigure(context.model.rods[number].rod, base_of(context, iterate, number), iterate.rods[number].q,
                   own_.shape);
  own_.loads.clear();
  own_.attachments.clear();
  own_.border.clear();
  own_.slides.clear();
}

void RodRows::slide(const rod::CurvePoint& point, double s, const Vec3& force, int unknown) {
  rod::PointLoad load{s, Vec3::Zero(), force};
  load.at = point;
  if (const std::optional<rod::Slide> own = rod::slide_at(own_.shape, point, force)) {
    add_slide(*own, unknown);
  } else {
    load.slide = static_cast<int>(own_.slides.size());
    own_.slides.push_back(unknown);
  }
  own_.loads.push_back(load);
}

void RodRows::add_slide(const rod::Slide& slide, int unknown) {
  problem().B.add(unknown, unknown, slide.second);
  own_.attachments.push_back(slide.attachment);
  own_.border.push_back(unknown);
}

void RodRows::attach(int border, const rod::CurvePoint& point, const Vec3& offset, const Vec3& f) {
  linalg::Attachment& attachment = own_.attachments.emplace_back();
  attachment.link = point.section;
  attachment.g << (point.position + point.R * offset - own_.shape.origin).cross(f), f;
  attachment.b.noalias() = point.twists.transpose().lazyProduct(attachment.g);
  own_.border.push_back(border);
}

void RodRows::attach_centre(int first, const rod::CurvePoint& point) {
  const Vec3 r = point.position - own_.shape.origin;
  own_.attachments.resize(own_.attachments.size() + 3);
  linalg::Attachment* const rows = own_.attachments.data() + own_.attachments.size() - 3;
  for (int i = 0; i < 3; ++i) {
    rows[i].link = point.section;
    rows[i].g << r.cross(Vec3::Unit(i)), Vec3::Unit(i);
    rows[i].b.resize(point.twists.cols());
    own_.border.push_back(first + i);
  }
  for (Eigen::Index c = 0; c < point.twists.cols(); ++c) {
    const Vec3 motion = rod::moved(point.twists.col(c), r);
    for (int i = 0; i < 3; ++i) rows[i].b[c] = motion[i];
  }
}

void RodRows::add_forces() {
  for (std::size_t i = 0; i < context_.model.loads.size(); ++i) {
    const RodLoadModel* const on_rod = std::get_if<RodLoadModel>(&context_.model.loads[i].on);
    if (!on_rod || on_rod->rod != number_) continue;
    const RodLoadModel& own = *on_rod;
    const double factor = context_.command.loads[i];
    double acting = 0.0;
    for (const RodLoadModel::At& at : own.at) {
      const rod::Mat3 R = own.follower ? rod::branch(own_.shape, at.s).R : rod::Mat3(rod::Mat3::Identity());
      rod::PointLoad point{at.s, Vec3::Zero(), R * (-factor * at.weight * own.force)};
      point.moment = R * (-factor * at.weight * own.moment);
      point.follower = own.follower;
      point.spread = !own.concentrated();
      load(point);
      acting += point.force.norm() + point.moment.norm() / own_.shape.rod->length();
    }
    reduced_.scale = std::max(reduced_.scale, acting);
  }
}

void RodRows::add_tendons(solve::ChainPart& part) {
  rod::Equations& equations = own_.equations;
  const rod::Rod& rod = *own_.shape.rod;
  const Eigen::VectorXd& q = iterate_.rods[number_].q;
  for (std::size_t i = 0; i < context_.model.actuators.size(); ++i) {
    const ActuatorModel& actuator = context_.model.actuators[i];
    if (actuator.line.rod != number_ || !actuator.tendon) continue;
    const rod::TendonLength length = rod::tendon_length(rod, *actuator.tendon, q);
    const double tension = motor_force(context_.model, context_.command, iterate_, static_cast<int>(i));
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
    if (actuator.told_force()) continue;
    const double off = actuator.tendon_length - context_.command.actuators[i] - length.value;
    problem().c[actuator.row] = off;
    reduced_.violation = std::max(reduced_.violation, std::abs(off));
    part.whole.conservativeResize(rod.strain_coordinates(), part.whole.cols() + 1);
    part.whole.rightCols<1>() = length.gradient;
    part.whole_at.push_back(row(actuator.row));
  }
}

void RodRows::measure() {
  const rod::Rod& rod = *own_.shape.rod;
  const int nb = rod.base_coordinates();
  const Eigen::VectorXd& q = iterate_.rods[number_].q;
  own_.largest = 0.0;
  for (int i = 0; i < rod.count(); ++i) {
    const rod::Section& section = rod.sections[i];
    linalg::Vector<Eigen::Dynamic> elastic;
    elastic.noalias() = section.stiffness.lazyProduct(rod.of_section(q, i));
    for (std::size_t c = 0; c < section.modes.size(); ++c) {
      const auto at = static_cast<Eigen::Index>(c);
      const double arm = lever(rod, section, section.modes[c]);
      if (const double left = std::abs(own_.equations.r[nb + rod.first[i] + at]) / arm; !(left <= own_.largest)) {
        own_.largest = left;
        own_.largest_at = i;
      }
      reduced_.scale = std::max(reduced_.scale, std::abs(elastic[at]) / arm);
    }
  }
  reduced_.largest = std::max(reduced_.largest, own_.largest);
}

void RodRows::finish() {
  const rod::Rod& rod = *own_.shape.rod;
  const RodModel& model = context_.model.rods[number_];
  const int nb = rod.base_coordinates();
  add_forces();
  for (const ActuatorModel& actuator : context_.model.actuators) {
    if (actuator.line.rod != number_ || !actuator.tendon) continue;
    for (const double end : {actuator.tendon->from, actuator.tendon->to}) load({end, Vec3::Zero(), Vec3::Zero()});
  }
  sort_few(own_.loads, [](const rod::PointLoad& a, const rod::PointLoad& b) { return a.s < b.s; });
  const RodState& start = context_.start.rods[number_];
  rod::station_inertia(rod, start.masses, start.velocity, context_.rate, context_.gravity, own_.shape.origin,
                       own_.inertia);
  rod::Equations& equations = own_.equations;
  solve::ChainPart& part = problem().chains[number_];
  std::swap(part.chain, equations.chain);  // their memory back
  std::swap(reduced_.internal[number_], equations.internal);
  rod::make_equations(own_.shape, rod::conservative(own_.loads), static_cast<int>(own_.slides.size()), equations);
  rod::add_loads(own_.shape, own_.loads, {own_.inertia, context_.gravity, !context_.at_start}, equations);
  double weight = 0.0;
  for (const rod::Station& station : rod.stations) weight += station.spread(0, 0) * context_.gravity.norm();
  reduced_.scale = std::max(reduced_.scale, equations.acting + weight);
  rod::add_elasticity(rod, iterate_.rods[number_].q, start.q, context_.rate, equations);
  for (std::size_t i = 0; i < own_.slides.size(); ++i) add_slide(equations.slides[i], own_.slides[i]);

  part.base = own_.shape.base;
  part.first_base = model.unknown;
  part.whole_at.clear();
  part.whole.resize(rod.strain_coordinates(), 0);
  add_tendons(part);
  measure();
  own_.order.resize(own_.attachments.size());
  std::iota(own_.order.begin(), own_.order.end(), 0);
  std::sort(own_.order.begin(), own_.order.end(), [this](int a, int b) {
    const int one = own_.attachments[a].link, other = own_.attachments[b].link;
    return one < other || (one == other && a < b);
  });
  part.attachments.resize(own_.order.size());
  part.at.resize(own_.order.size());
  for (std::size_t i = 0; i < own_.order.size(); ++i) {
    part.attachments[i] = own_.attachments[own_.order[i]];
    part.at[i] = own_.border[own_.order[i]];
  }
  part.r = equations.r.tail(rod.strain_coordinates());
  std::swap(part.chain, equations.chain);
  problem().r.segment(model.unknown, nb) += equations.r.head(nb);
  problem().B.add(model.unknown, model.unknown, equations.base);
  std::swap(reduced_.internal[number_], equations.internal);
}

}  // namespace sinew
