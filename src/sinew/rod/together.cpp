#include "sinew/rod/together.hpp"

#include <algorithm>
#include <cmath>

namespace sinew::rod {

Together::Together(const Configuration& shape, const Inertia& inertia, Equations& equations)
    : shape_(shape),
      rod_(*shape.rod),
      inertia_(inertia),
      equations_(equations),
      turns_(equations.chain.symmetric() &&
             std::none_of(rod_.sections.begin(), rod_.sections.end(), [](const Section& s) { return s.stretches(); })) {
}

bool Together::possible(int first, int end) const {
  for (int i = first; i < end; ++i) {
    if (!(rod_.sections[i].length() < longest_exponential(shape_.strains[i]))) return false;
  }
  return true;
}

void Together::begin(int i, std::size_t stations) {
  round_ = 0;
  if (!turns_ || i / kLanes * kLanes == first_) return;
  first_ = i / kLanes * kLanes;
  first_station_ = stations;
  on_ = possible(first_, i + 1);
  if (!on_) return;
  crossed_ = {};
  rounds_ = 0;
  sections_.count = i + 1 - first_;
  for (int lane = 0; lane < kLanes; ++lane) {
    const int own = std::min(first_ + lane, i);  // (what is behind the last one only must be numbers)
    const Coefficients& strain = shape_.strains[own];
    const Vec3 p = shape_.p[own] - shape_.origin;
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) sections_.R[c][r][lane] = shape_.R[own](r, c);
      sections_.p[c][lane] = p[c];
      sections_.rotation[c][lane] = strain(c, 0);
      sections_.translation[c][lane] = strain(3 + c, 0);
    }
  }
  meet_stations(stations);
}

/// From the last one on, the stations of every section by their numbers.
void Together::meet_stations(std::size_t stations) {
  stations_.fill(0);
  int most = 0;
  std::size_t first = stations;
  while (first > 0 && rod_.stations[first - 1].section >= first_) {
    int& count = stations_[rod_.stations[--first].section - first_];
    most = std::max(most, ++count);
  }
  if (most > kStations) return;  // each by itself
  first_station_ = first;
  for (int k = 0; k < most; ++k) at_[k] = {};
  std::array<int, kLanes> number{};
  for (std::size_t s = first; s < stations; ++s) {
    const Station& station = rod_.stations[s];
    const int lane = station.section - first_;
    StationLanes& at = at_[number[lane]++];
    at.length[lane] = station.weights(0, 0);
    at.mass[lane] = station.spread(0, 0);
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) {
        at.weight[c][r][lane] = inertia_.stations[s].weight(r, c);
        at.pull[c][r][lane] = inertia_.stations[s].pull(r, c);
      }
    }
  }
  const double gravity[3] = {inertia_.gravity.x(), inertia_.gravity.y(), inertia_.gravity.z()};
  Eight acting = {};
  for (int k = 0; k < most; ++k) kernels_.meet(sections_, gravity, inertia_.bends, at_[k], crossed_, acting);
  for (int lane = 0; lane < sections_.count; ++lane) equations_.acting += acting[lane];
}

bool Together::cross(int i, double length, const Beyond& beyond) {
  if (!on_ || beyond.sprung() || !(std::abs(length) < longest_exponential(shape_.strains[i]))) return false;
  if (round_ == kRounds) cross_rounds();
  if (round_ == rounds_) crossings_[rounds_++] = {};
  crossings_[round_].length[i - first_] = length;
  beyond.put(i - first_, crossings_[round_++].beyond);
  return true;
}

bool Together::meet(std::size_t station, Beyond& beyond) {
  if (!on_ || station < first_station_) return false;
  const int lane = rod_.stations[station].section - first_;
  beyond.add(at_[--stations_[lane]].loads, lane);
  return true;
}

void Together::cross_rounds() {
  for (int k = 0; k < rounds_; ++k) kernels_.cross(sections_, crossings_[k], crossed_);
  round_ = rounds_ = 0;
}

void Together::end(int i) {
  if (!on_ || i != first_) return;
  cross_rounds();
  for (int lane = 0; lane < sections_.count; ++lane) write(first_ + lane, lane);
}

void Together::write(int section, int lane) {
  const std::vector<Mode>& modes = rod_.sections[section].modes;
  linalg::Chain& chain = equations_.chain;
  for (std::size_t b = 0; b < modes.size(); ++b) {
    const int at = rod_.first[section] + static_cast<int>(b), strain = modes[b].strain;
    equations_.r[rod_.base_coordinates() + at] += crossed_.gradient[strain][lane];
    for (int k = 0; k < 6; ++k) chain.V(k, at) += crossed_.KT[strain][k][lane];
    for (std::size_t a = 0; a < modes.size(); ++a)
      chain.D(static_cast<Eigen::Index>(a), at) += crossed_.tangent[strain][modes[a].strain][lane];
  }
}

}  // namespace sinew::rod
