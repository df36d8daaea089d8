// A peg that a frame draws into a clamped rod, which folds around it within a section: it went through the fold within
// a step, `converged`, because pieces of the rod were looked at on the way by their chords alone; where both are thin,
// because its axis was looked at at three places a piece.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "support/faults.hpp"

namespace sinew::test {
namespace {

using Eigen::Vector3d;

/// How often a line, from `p` on along `d` in both directions, passes through a triangle: 0 or 1.
int crossings(const Vector3d& p, const Vector3d& d, const std::array<Vector3d, 3>& corners) {
  std::array<double, 3> side{};
  for (std::size_t i = 0; i < 3; ++i) side[i] = d.dot((corners[i] - p).cross(corners[(i + 1) % 3] - p));
  const auto [least, most] = std::minmax_element(side.begin(), side.end());
  return *least > 0.0 || *most < 0.0 ? 1 : 0;
}

/// From how many steps on the axis of the rod is on the other side of the axis of the peg.
int passes(const RecordedRun& run, const Vector3d& place, double turn, double speed) {
  constexpr int kPoints = 73;
  const Vector3d along(std::sin(turn), 0.0, std::cos(turn));
  std::array<std::vector<Vector3d>, kPoints> path;  // of points of the rod, as the peg sees them
  std::vector<double> times;
  for (const io::RecordedStep& step : run.steps) times.push_back(step.time);
  for (std::size_t i = 0; i < kPoints; ++i) {
    const std::string name = "p" + std::to_string(i) + ".";
    const std::vector<double> x = run.signal(name + "x"), y = run.signal(name + "y"), z = run.signal(name + "z");
    for (std::size_t k = 0; k < times.size(); ++k) path[i].emplace_back(x[k], y[k] - speed * times[k], z[k]);
  }
  int found = 0;
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    int odd = 0;
    for (std::size_t i = 0; i + 1 < kPoints; ++i) {
      odd += crossings(place, along, {path[i][k], path[i + 1][k], path[i][k + 1]});
      odd += crossings(place, along, {path[i + 1][k], path[i + 1][k + 1], path[i][k + 1]});
    }
    found += odd % 2;
  }
  return found;
}

struct Draw {
  std::string name, x, way, duration;  ///< x: where the peg is along the rod, way: how far it goes [m]; [s]
  std::vector<std::string> changes;
};
void PrintTo(const Draw& draw, std::ostream* out) { *out << draw.name; }

class RodFolds : public testing::TestWithParam<Draw> {};

TEST_P(RodFolds, AroundAPeg) {
  const Draw& draw = GetParam();
  std::vector<std::string> changes = {"obstacles.peg.pose.translate=[" + draw.x + ", 0.004930444741970592, 0]",
                                      "time.duration=" + draw.duration,
                                      "frames.hand.motion.times=[0, " + draw.duration + "]",
                                      "frames.hand.motion.translate=[[0, 0, 0], [0, -" + draw.way + ", 0]]"};
  changes.insert(changes.end(), draw.changes.begin(), draw.changes.end());
  const RecordedRun run = fault("rod_folds_around_peg", changes);
  ASSERT_GT(run.steps.size(), 10u) << run.why();
  const Vector3d place(std::stod(draw.x), 0.004930444741970592, 0.0);
  EXPECT_EQ(passes(run, place, 0.15103367689780445, -std::stod(draw.way) / std::stod(draw.duration)), 0);
}

INSTANTIATE_TEST_SUITE_P(
    , RodFolds,
    testing::Values(Draw{"AsItWasFound", "0.04313238183313821", "0.07130528953754296", "0.016", {}},
                    Draw{"Farther",
                         "0.051064367463463725",
                         "0.11960514202941686",
                         "0.02",
                         {"time.step=1 ms", "contact.friction=0.8", "rods.r.material.young=50700110.02207728"}},
                    Draw{"NearTheClamp",
                         "0.024762006014260745",
                         "0.08213525318336659",
                         "0.02",
                         {"rods.r.material.young=14340890.818841947"}},
                    Draw{"Smooth",
                         "0.04381515977220941",
                         "0.09950632695061931",
                         "0.02",
                         {"contact.friction=0", "rods.r.material.young=18564059.95858992"}},
                    Draw{"Rough",
                         "0.04652897039854823",
                         "0.09748116485092391",
                         "0.02",
                         {"time.step=1 ms", "contact.friction=0.8", "rods.r.material.young=37737323.07810287"}},
                    Draw{"Thin",
                         "0.048038145430113005",
                         "0.0753088199972436",
                         "0.02",
                         {"contact.friction=0.8", "rods.r.material.young=9280766.45221372",
                          "rods.r.section.circle.radius=0.0003567845505854688",
                          "obstacles.peg.cylinder.radius=0.00035733493506854273"}},
                    Draw{"ThinAndStiff",
                         "0.032443147992484565",
                         "0.1146661084472422",
                         "0.02",
                         {"time.step=1 ms", "contact.friction=0", "rods.r.material.young=354267820.4927019",
                          "rods.r.section.circle.radius=0.0003727276999686727",
                          "obstacles.peg.cylinder.radius=0.0002797019407000977"}}),
    [](const auto& one) { return one.param.name; });

}  // namespace
}  // namespace sinew::test
