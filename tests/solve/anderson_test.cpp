#include "sinew/solve/anderson.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

namespace sinew::solve {
namespace {

Eigen::MatrixXd random_matrix(int size, std::mt19937& draw) {
  std::normal_distribution<double> normal;
  return Eigen::MatrixXd::NullaryExpr(size, size, [&] { return normal(draw); });
}

double left(const Eigen::VectorXd& image, const Eigen::VectorXd& x) { return (image - x).norm(); }

// A linear G with k eigenvalues that are not zero, and others that are, has k + 1 distinct ones: it takes k + 2 images,
// whether it contracts or not. (Of rank 4 a difference is dropped on the way: what it knew, the eigenvalue 0, is done
// with after one image.)
TEST(Anderson, EndsOnLinearMapsThatDoNotContract) {
  std::mt19937 draw(3);
  for (int rank = 1; rank <= 4; ++rank) {
    const Eigen::MatrixXd basis = Eigen::HouseholderQR<Eigen::MatrixXd>(random_matrix(12, draw)).householderQ();
    Eigen::VectorXd eigenvalues = Eigen::VectorXd::Zero(12);
    for (int i = 0; i < rank; ++i) eigenvalues[i] = (i % 2 == 0 ? 1.0 : -1.0) * (1.5 + i);
    const Eigen::MatrixXd G = basis * eigenvalues.asDiagonal() * basis.transpose();
    const Eigen::VectorXd c = random_matrix(12, draw).col(0);
    const auto image = [&](const Eigen::VectorXd& x) -> Eigen::VectorXd { return G * x + c; };

    AndersonAcceleration acceleration(4);
    Eigen::VectorXd x = Eigen::VectorXd::Zero(12), plain = x;
    acceleration.begin();
    const double first = left(image(x), x);
    const double second = left(image(image(x)), image(x));
    for (int turn = 0; turn <= rank + 1; ++turn) {
      acceleration.next(image(x), x);
      plain = image(plain);
    }
    EXPECT_LT(left(image(x), x), 1e-9 * first) << rank;
    EXPECT_GT(left(image(plain), plain), second) << rank;
  }
}

TEST(Anderson, FirstIsThePlainIteration) {
  AndersonAcceleration acceleration(4);
  acceleration.begin();
  Eigen::VectorXd x = Eigen::Vector2d(1.0, 2.0);
  acceleration.next(Eigen::Vector2d(0.5, -1.0), x);
  EXPECT_EQ(x, Eigen::Vector2d(0.5, -1.0));
}

// With one iterate kept it is the secant method, on x = cos x here, and goes on when its oldest column is replaced.
TEST(Anderson, IsTheSecantMethodInOneDimension) {
  AndersonAcceleration acceleration(1);
  acceleration.begin();
  Eigen::VectorXd x = Eigen::VectorXd::Constant(1, 1.0);
  double before = 0.0, image_before = 0.0;
  for (int turn = 0; turn < 6; ++turn) {
    const double at = x[0], image = std::cos(at);
    acceleration.next(Eigen::VectorXd::Constant(1, image), x);
    if (turn > 0) {
      const double f = image - at, f_before = image_before - before;
      if (std::abs(f - f_before) > 1e-12) {
        EXPECT_NEAR(x[0], at - f * (at - before) / (f - f_before), 1e-12);
      }
    }
    before = at;
    image_before = image;
  }
  EXPECT_NEAR(x[0], 0.7390851332151607, 1e-13);
}

// Where all differences are the same, or there are none, they say nothing more than one of them does.
TEST(Anderson, DependentDifferencesDoNoHarm) {
  AndersonAcceleration acceleration(3);
  acceleration.begin();
  Eigen::VectorXd x = Eigen::Vector2d(0.0, 0.0);
  const auto image = [](const Eigen::VectorXd& at) -> Eigen::VectorXd {
    return Eigen::Vector2d(1.0 - 2.0 * at[0], 0.0);
  };
  for (int turn = 0; turn < 8; ++turn) {
    acceleration.next(image(x), x);
    ASSERT_TRUE(x.allFinite()) << turn;
  }
  EXPECT_NEAR(x[0], 1.0 / 3.0, 1e-12);
}

// What is begun again remembers nothing, nor another size.
TEST(Anderson, ForgetsWhenItBeginsAgain) {
  std::mt19937 draw(5);
  AndersonAcceleration used(3), fresh(3);
  used.begin();
  Eigen::VectorXd x = random_matrix(7, draw).col(0);
  for (int turn = 0; turn < 5; ++turn) used.next(random_matrix(7, draw).col(0), x);
  used.begin();
  fresh.begin();
  Eigen::VectorXd a = Eigen::VectorXd::Zero(3), b = a;
  for (int turn = 0; turn < 5; ++turn) {
    const Eigen::VectorXd image = random_matrix(3, draw).col(0);
    used.next(image, a);
    fresh.next(image, b);
    EXPECT_EQ(a, b);
  }
}

}  // namespace
}  // namespace sinew::solve
