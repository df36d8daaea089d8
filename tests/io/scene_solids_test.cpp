#include <gtest/gtest.h>

#include "broken_scene.hpp"
#include "full_scene.hpp"
#include "sinew/io/scene_file.hpp"

namespace sinew::io {
namespace {

Scene scene_of_solids() { return parse_scene(solids_scene, "scene.yaml", "").scene; }

TEST(SceneSolids, ReadsLawsAndParts) {
  const Solid finger = scene_of_solids().solids[0].second;
  const auto& ogden = std::get<solid::Ogden>(finger.material.law);
  ASSERT_EQ(ogden.count, 3);
  EXPECT_EQ(ogden.terms[2].mu, -1e3);
  EXPECT_EQ(ogden.terms[1].alpha, 5);
  EXPECT_NEAR(solid::bulk_modulus(ogden.moduli), 2e6, 1e-6);
  EXPECT_EQ(finger.material.viscosity, 30);
  EXPECT_EQ(finger.material.density, 1100);
  EXPECT_EQ(finger.mass_matrix, solid::MassMatrix::consistent);
  ASSERT_EQ(finger.parts.size(), 6u);
  EXPECT_EQ(std::get<solid::NeoHookean>(finger.parts[0].material.law).young, 5e6);
  EXPECT_NEAR(solid::bulk_modulus(std::get<solid::MooneyRivlin>(finger.parts[1].material.law).moduli), 5e6, 1e-6);
  EXPECT_NEAR(solid::bulk_modulus(std::get<solid::MooneyRivlin>(finger.parts[2].material.law).moduli),
              2e5 * 2 * 1.45 / (3 * 0.1), 1e-6);
  EXPECT_TRUE(std::holds_alternative<solid::SaintVenantKirchhoff>(finger.parts[4].material.law));
  EXPECT_TRUE(std::holds_alternative<solid::Corotational>(finger.parts[5].material.law));
}

TEST(SceneSolids, ReadsTheOrderOfElements) {
  EXPECT_EQ(scene_of_solids().solids[0].second.order, 1);
  EXPECT_EQ(scene_of_solids().solids[2].second.order, 2);
}

TEST(SceneSolids, ReadsRegions) {
  const Solid finger = scene_of_solids().solids[0].second;
  ASSERT_EQ(finger.fixed.size(), 6u);
  EXPECT_EQ(std::get<Box>(finger.fixed[0].region).in, In::world);
  EXPECT_EQ(finger.fixed[0].axes, (std::array<bool, 3>{true, false, true}));
  EXPECT_EQ(finger.fixed[0].frame, "grip");
  EXPECT_EQ(std::get<Sphere>(finger.fixed[1].region).radius, 0.005);
  EXPECT_EQ(std::get<Plane>(finger.fixed[2].region).within, 1e-4);
  EXPECT_EQ(std::get<NodeNumbers>(finger.fixed[3].region).numbers, (std::vector<int>{0, 3, 17}));
  EXPECT_EQ(std::get<GroupName>(finger.fixed[4].region).name, "base");
  EXPECT_TRUE(std::holds_alternative<WholeSurface>(finger.fixed[5].region));
  EXPECT_EQ(finger.fixed[5].axes, (std::array<bool, 3>{true, true, true}));
  EXPECT_EQ(finger.springs[5].stiffness, Vec3(1, 0, 20));
  const Scene scene = scene_of_solids();
  EXPECT_EQ(std::get<SolidLoad>(scene.loads[1].second).pressure, -20e3);
  EXPECT_EQ(std::get<SolidLoad>(scene.loads[3].second).force, Vec3(0, 1, 0));
  EXPECT_TRUE(std::holds_alternative<NodeNumbers>(*scene.outputs[3].second.region));
  EXPECT_FALSE(scene.outputs[6].second.region);
  EXPECT_EQ(scene.outputs[7].second.quantity, Quantity::displacement);
}

TEST(SceneSolids, AreRefusedWithLineFieldRuleAndRemedy) {
  const Broken cases[] = {
      {"bulk: 2 MPa, viscosity", "viscosity", 7, "solids.finger.material.bulk", "", "is missing", "one of bulk"},
      {"bulk: 2 MPa", "bulk: 2 MPa, poisson: 0.4", 7, "solids.finger.material.bulk", "", "cannot be given together",
       "give one of"},
      {"order: 2", "order: 0", 35, "solids.ball.order", "0", "must be at least 1", ""},
      {"order: 2", "order: 3", 35, "solids.ball.order", "3", "must be at most 2", ""},
      {"order: 2", "order: quadratic", 35, "solids.ball.order", "quadratic", "must be a whole number", ""},
      {"alpha: [1.3, 5, -2]", "alpha: [1.3, 5]", 7, "solids.finger.material.alpha", "[1.3, 5]",
       "as many as mu, 3, not 2", "a power for each"},
      {"alpha: [1.3, 5, -2]", "alpha: [1.3, 5, 0]", 7, "solids.finger.material.alpha", "[1.3, 5, 0]",
       "must not contain 0", "leave that term out"},
      {"law: ogden, mu", "law: ogdon, mu", 7, "solids.finger.material.law", "ogdon", "must be one of", "ogden"},
      {"law: ogden, mu", "law: ogden, young: 1 MPa, mu", 7, "solids.finger.material.young", "",
       "is not a parameter of ogden", "mu, alpha, and bulk or poisson"},
      {"c10: 80 kPa, c01: 20 kPa, bulk", "c10: 80 kPa, bulk", 11, "solids.finger.parts.1.material.c01", "",
       "is missing", "add it"},
      {"group: base}", "group: base, in: world}", 21, "solids.finger.fixed.4.in", "world",
       "has no meaning for a region", "leave it out"},
      {"surface: true}", "surface: false}", 22, "solids.finger.fixed.5.surface", "false", "can only be true",
       "leave it out"},
      {"stiffness: [1 N/m, 0, 20 N/m]", "stiffness: [1 N, 0, 20 N/m]", 24, "solids.finger.springs.0.stiffness.0", "1 N",
       "unit of a force", "N/m"},
      {"  load1: {solid: finger, sphere: {center: [0, 0, 10 mm], radius: 5 mm}, pressure: -20 kPa}",
       "  load1: {solid: finger, pressure: -20 kPa}", 41, "loads.load1.box", "", "is missing", "add one"},
      {"  all: {solid: finger, quantity: reaction}", "  all: {solid: finger, quantity: reaction, point: [0, 0, 0]}", 53,
       "outputs.all.point", "", "has no meaning for a reaction", "give a `region`"},
  };
  for (const Broken& broken : cases) expect_refused(solids_scene, broken);
}

}  // namespace
}  // namespace sinew::io
