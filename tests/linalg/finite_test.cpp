#include "sinew/linalg/finite.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace sinew::linalg {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

TEST(Finite, finds_every_number_that_is_none) {
  for (int n = 0; n <= 20; ++n) {
    Eigen::VectorXd v = Eigen::VectorXd::Random(n) * std::numeric_limits<double>::max();
    EXPECT_TRUE(finite(v)) << n;
    for (int i = 0; i < n; ++i) {
      for (const double bad : {std::nan(""), kInfinity, -kInfinity}) {
        Eigen::VectorXd w = v;
        w[i] = bad;
        EXPECT_FALSE(finite(w)) << n << " " << i << " " << bad;
      }
    }
    if (n > 1) {
      v[0] = kInfinity;
      v[1] = -kInfinity;
      EXPECT_FALSE(finite(v)) << n;
    }
  }
}

}  // namespace
}  // namespace sinew::linalg
