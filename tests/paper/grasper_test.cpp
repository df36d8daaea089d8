// The grasper of the paper's Fig. 5: its meshes, layout and stiffness. The cube that fits this layout has edges of 40
// mm; one of 20 mm would pass between the two fingers side by side, of which one does not reach it.
#include <gtest/gtest.h>

#include "support/grasps.hpp"

namespace sinew {
namespace {

using test::Grasp;
using test::mm;

Grasp grasp(std::vector<std::string> changes) {
  for (const char* finger : {"one", "two", "three"})
    changes.push_back("solids." + std::string(finger) + ".mesh=" + SINEW_SHARED_MESHES + "/finger.vtk");
  return test::grasp("tests/paper/grasper.yaml", changes);
}

/// The hand comes down by 45 mm, so that fingertips end 14 to 16 mm above the floor, beside the cube.
TEST(PaperGrasper, LiftsTheCubeAndHoldsIt) {
  const Grasp found = grasp({});
  EXPECT_NEAR(found.at(3.0).y() - found.at(2.0).y(), 50 * mm, 0.1 * mm);
  EXPECT_LT(found.slip(3.0), 1 * mm);
  EXPECT_GT(found.deepest, -0.1 * mm);
}

/// With hardly any friction the tips, inclined as they are, still cage it.
TEST(PaperGrasper, CagesTheCubeWithLittleFriction) {
  const Grasp found = grasp({"contact.friction=0.02", "time.duration=4 s", "newton={limit: 30}"});
  EXPECT_NEAR(found.at(3.0).y() - found.at(2.0).y(), 50 * mm, 0.1 * mm);
  EXPECT_LT(found.slip(3.0), 1 * mm);
}

TEST(PaperGrasper, StifferCablesChangeTheGrasp) {
  const Grasp soft = grasp({"time.duration=2 s", "newton={limit: 30}"}),
              stiff = grasp({"time.duration=2 s", "newton={limit: 30}", "rods.one_cable.material.young=50 GPa",
                             "rods.two_cable.material.young=50 GPa", "rods.three_cable.material.young=50 GPa"});
  EXPECT_GT(stiff.pull, 1.05 * soft.pull);
  EXPECT_GT((stiff.cube.back() - soft.cube.back()).norm(), 0.2 * mm);
}

}  // namespace
}  // namespace sinew
