// Sections whose exponentials are crossed together, one in each lane of registers (rod/crossings).
#pragma once

#include <array>

#include "sinew/rod/beyond.hpp"

namespace sinew::rod {

/// A group of neighbouring sections while a walk from tip to base passes them: of constant strain, with no other
/// coordinates than rates of rotation, and loads that have a potential. It collects what a section meets, in rounds of
/// one exponential each, and adds what all of them do to the sections' coordinates when the walk leaves the group.
class Together {
 public:
  Together(const Configuration& shape, const Inertia& inertia, Equations& equations);

  /// Section i is next, and stations before `stations` are still to be met. Those of a new group meet their inertia
  /// now.
  void begin(int i, std::size_t stations);
  /// Loads beyond an exponential of section i; false where it must be crossed by itself.
  bool cross(int i, double length, const Beyond& beyond);
  /// Adds a station to what lies beyond; false where it must be met by itself.
  bool meet(std::size_t station, Beyond& beyond);
  /// Section i is done.
  void end(int i);

 private:
  static constexpr int kRounds = 4, kStations = 8;

  bool possible(int first, int end) const;
  void meet_stations(std::size_t stations);
  void cross_rounds();
  void write(int section, int lane);

  const Configuration& shape_;
  const Rod& rod_;
  const Inertia& inertia_;
  Equations& equations_;
  const RodKernels& kernels_ = rod_kernels();
  bool turns_;                          ///< the rod's sections could be crossed together
  bool on_ = false;                     ///< those of the group are
  int first_ = -1;                      ///< section of the group
  int round_ = 0;                       ///< next of the section
  int rounds_ = 0;                      ///< in use
  std::size_t first_station_ = 0;       ///< of the group
  std::array<int, kLanes> stations_{};  ///< of each section that are still to be met
  SectionLanes sections_;
  CrossedLanes crossed_;
  std::array<CrossingLanes, kRounds> crossings_;
  std::array<StationLanes, kStations> at_;  ///< the first, second .. station of each section
};

}  // namespace sinew::rod
