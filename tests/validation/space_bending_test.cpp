// Rods that bend and twist in space: the 45 degree bend and the Princeton beam.
#include "validation/shooting.hpp"

namespace sinew::test {
namespace {

/// Simo and Vu-Quoc, Comput. Meth. Appl. Mech. Engng 58, 1986: an arc of 45 degrees and radius 100, clamped, unit
/// square section, E = 1e7, G = E / 2, under a dead force at its tip across its plane. Tip positions with 8 of their
/// elements. Torsion constant here: the exact 0.1406 of a unit square (authors take it from 0.141 to 1/6, the polar
/// moment, and differ by 1 to 2 %); shear factor 5/6.
struct Bend {
  double force;
  Vec3 tip;
};
const Bend kBends[] = {{300, {58.84, 22.33, 40.08}}, {450, {52.32, 18.62, 48.39}}};

Vec3 bent_tip(double force, int sections, int order) {
  Scene scene = straight_rod(1.0, sections, Rectangle{1.0, 1.0}, kAll, order, 6);
  Rod& rod = scene.rods[0].second;
  rod.material = {1e7, 0.0, 0.0};
  rod.path.clear();
  for (int i = 0; i <= 200; ++i) {
    const double angle = pi / 4 * i / 200;
    rod.path.emplace_back(100 * std::sin(angle), 100 * (1 - std::cos(angle)), 0.0);
  }
  add_load(scene, Vec3(0, 0, force));
  return solve(scene).tip();
}

TEST(Bend45, tip_is_where_simo_and_vu_quoc_put_it) {
  for (const Bend& bend : kBends) {
    const Vec3 tip = bent_tip(bend.force, 32, 0);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(tip[i], bend.tip[i], 0.02 * bend.tip[i]) << bend.force << " axis " << i;
  }
}

TEST(Bend45, does_not_depend_on_how_the_rod_is_cut) {
  const Vec3 fine = bent_tip(300, 4, 2);
  EXPECT_LT((bent_tip(300, 32, 0) - fine).norm(), 2e-4 * 100);
  EXPECT_LT((bent_tip(300, 2, 3) - fine).norm(), 1e-5 * 100);
}

/// Princeton beam: a cantilever of rectangular section turned by beta about its axis, under a dead weight at its tip.
/// ANSYS beam values quoted by Obrezkov et al. 2022; displacements along the section's long (y) and short (z) side.
///
/// Torsion constant: with Saint-Venant's, 0.2100 (I_y + I_z), all values are met to 0.9 %. With the factor 0.198 that
/// is quoted beside them, y at 45 to 75 degrees comes out 1.6 to 2.4 % too large, here and by shooting alike: ANSYS
/// cannot have used it (0.2175 would fit to 0.1 %).
struct Princeton {
  double beta, y, z;
};
const Princeton kPrinceton[] = {{0, 0.010714, 0.0},       {15, 0.010613, 0.042082}, {30, 0.010112, 0.079395},
                                {45, 0.008837, 0.108988}, {60, 0.006605, 0.129888}, {75, 0.003539, 0.142194},
                                {90, 0.0, 0.146246}};

class PrincetonBeam : public testing::TestWithParam<Princeton> {};

constexpr double kLength = 0.508, kLong = 0.0123777, kShort = 0.0032024;

Scene princeton(const CrossSection& section, const Vec3& force, int sections, int order) {
  Scene scene = straight_rod(kLength, sections, section, kAll, order, 4);
  scene.rods[0].second.material = {71.7e9, 0.31, 0.0};
  add_load(scene, force);
  return scene;
}

Vec3 weight(double beta) { return 8.896 * Vec3(0, std::cos(beta * pi / 180), std::sin(beta * pi / 180)); }

TEST_P(PrincetonBeam, tip_moves_as_ansys_says_with_saint_venants_torsion) {
  const Princeton& row = GetParam();
  for (const auto& [sections, order] : {std::pair(40, 0), std::pair(4, 1)}) {
    const Vec3 tip = solve(princeton(Rectangle{kLong, kShort}, weight(row.beta), sections, order)).tip();
    EXPECT_NEAR(tip.y(), row.y, 0.01 * row.y + 1e-9);
    EXPECT_NEAR(tip.z(), row.z, 0.01 * row.z + 1e-9);
  }
}

TEST_P(PrincetonBeam, with_the_quoted_torsion_factor_it_is_within_three_percent_and_equals_shooting) {
  const double E = 71.7e9, G = E / (2 * 1.31), A = kLong * kShort;
  const double Iy = A * kShort * kShort / 12, Iz = A * kLong * kLong / 12;
  const Stiffness stiffness = {G * 0.198 * (Iy + Iz), E * Iy, E * Iz, E * A, 5.0 / 6 * G * A, 5.0 / 6 * G * A};
  const Princeton& row = GetParam();
  const Vec3 tip = solve(princeton(given(stiffness), weight(row.beta), 4, 2)).tip();
  EXPECT_NEAR(tip.y(), row.y, 0.03 * row.y + 1e-9);
  EXPECT_NEAR(tip.z(), row.z, 0.01 * row.z + 1e-9);
  EXPECT_LT((tip - shoot_cantilever(kLength, weight(row.beta), stiffness, true).p).norm(), 1e-8 * kLength);
}

INSTANTIATE_TEST_SUITE_P(AllAngles, PrincetonBeam, testing::ValuesIn(kPrinceton));

}  // namespace
}  // namespace sinew::test
