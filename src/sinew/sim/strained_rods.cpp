#include "sinew/sim/strained_rods.hpp"

#include <algorithm>

#include "sinew/error/digits.hpp"

namespace sinew {

namespace {

constexpr int kElongation = 3;
constexpr double kLeast = 0.2, kMost = 6.0;

double ratio(const rod::Rod& rod, const Eigen::VectorXd& q, double s) {
  const double strain = rod::strain(rod, q, s)[kElongation], rest = strain - rod::deviation(rod, q, s)[kElongation];
  return (1.0 + strain) / (1.0 + rest);
}

}  // namespace

Stretch stretch_of(const rod::Rod& rod, const Eigen::VectorXd& q) {
  Stretch own;
  const auto look = [&](double s) {
    const double here = ratio(rod, q, s);
    own.least = std::min(own.least, here);
    own.most = std::max(own.most, here);
  };
  for (const rod::Section& section : rod.sections) {
    int degree = -1;  // of the elongation; none where it is not free
    for (const rod::Mode& mode : section.modes)
      if (mode.strain == kElongation) degree = std::max(degree, mode.degree);
    if (degree < 0) continue;
    const double length = section.length();
    look(section.begin + 0.5 * length);
    if (degree == 0) continue;
    look(section.begin + 1e-9 * length);  // (at the end itself, the next section begins)
    look(section.end - 1e-9 * length);
  }
  return own;
}

std::vector<Warning> assess_strained_rods(const Model& model, const State& state) {
  std::vector<Warning> warnings;
  for (std::size_t i = 0; i < model.rods.size(); ++i) {
    const Stretch own = stretch_of(model.rods[i].rod, state.rods[i].q);
    const std::string where = "rods." + model.rods[i].name;
    if (own.least < kLeast) {
      warnings.push_back({.code = "rod_crushed",
                          .where = where,
                          .message = own.least > 0.0
                                         ? "it is squashed to " + three_digits(100.0 * own.least) +
                                               " % of its length somewhere, and no real rod is"
                                         : std::string("it is squashed until it is inside out, which no real rod is"),
                          .remedy = "push it less, or give it the stiffness that it really has",
                          .value = 1.0 - own.least,
                          .limit = 1.0 - kLeast});
    }
    if (own.most > kMost) {
      warnings.push_back({.code = "rod_overstretched",
                          .where = where,
                          .message = "it is stretched to " + three_digits(own.most) +
                                     " times its length somewhere, and a real rod breaks before",
                          .remedy = "pull it less, or give it the stiffness that it really has",
                          .value = own.most - 1.0,
                          .limit = kMost - 1.0});
    }
  }
  return warnings;
}

}  // namespace sinew
