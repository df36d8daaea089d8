// Loads at which straight rods lose their stability: Euler's columns, Greenhill's shafts.
//
// A tiny lateral force moves the rod by w; 1 / w falls to zero at the critical load and changes its sign there on the
// straight branch. Which branch a solver follows beyond does not matter: the load is found from below by secants.
#include "validation/rods.hpp"

namespace sinew::test {
namespace {

constexpr double L = 1.5, EI = 2.0;

/// The smallest load at which the response to a tiny force is without bound, from a first guess below it. `response`
/// must be computed at `load`.
template <class Response>
double critical_load(double guess, const Response& response) {
  double a = 0.8 * guess, b = 0.9 * guess, ya = 1.0 / response(a), yb = 1.0 / response(b);
  for (int i = 0; i < 6; ++i) {
    const double next = b - yb * (b - a) / (yb - ya);
    if (std::abs(next - b) < 1e-3 * b) return next;
    a = b;
    ya = yb;
    b = b + 0.7 * (next - b);  // stay below
    yb = 1.0 / response(b);
  }
  return b;
}

enum class Ends { cantilever, pinned };

/// Deflection at the tip of a cantilever, or at the middle of a column on pins, over that without axial load.
double column_response(Ends ends, double load, int sections, const std::vector<Strain>& strains) {
  const auto deflection = [&](double axial) {
    Scene scene = straight_rod(L, sections, given({1.5, EI, EI, 1e7, 1e7, 1e7}), strains, 0, 4);
    add_load(scene, Vec3(-axial, 0, 0));
    const double tiny = 1e-6 * EI / (L * L);
    add_load(scene, Vec3(0, tiny, 0), Vec3::Zero(), ends == Ends::pinned ? L / 2 : L);
    if (ends == Ends::pinned) {
      scene.rods[0].second.base = {BaseAxis::turn_y, BaseAxis::turn_z};
      add_tie(scene, {false, true, true});
    }
    const Solved solved = solve(scene);
    return solved.at(ends == Ends::pinned ? L / 2 : L).y();
  };
  return deflection(load) / deflection(0.0);
}

TEST(Euler, cantilever_buckles_at_a_quarter_of_pi_squared) {
  const double exact = pi * pi * EI / (4 * L * L);
  for (const auto& strains : {kBending, kAll}) {
    const double found =
        critical_load(0.9 * exact, [&](double load) { return column_response(Ends::cantilever, load, 20, strains); });
    EXPECT_NEAR(found, exact, 0.01 * exact);
  }
}

TEST(Euler, column_on_pins_buckles_at_pi_squared) {
  const double exact = pi * pi * EI / (L * L);
  for (const auto& strains : {kBending, kAll}) {
    const double found =
        critical_load(0.9 * exact, [&](double load) { return column_response(Ends::pinned, load, 24, strains); });
    EXPECT_NEAR(found, exact, 0.01 * exact);
  }
}

TEST(Euler, beyond_the_load_the_response_has_changed_its_sign_or_is_large) {
  for (const Ends ends : {Ends::cantilever, Ends::pinned}) {
    const double exact = (ends == Ends::cantilever ? 0.25 : 1.0) * pi * pi * EI / (L * L);
    const double below = column_response(ends, 0.99 * exact, 24, kBending);
    const double beyond = column_response(ends, 1.01 * exact, 24, kBending);
    EXPECT_GT(below, 50.0);
    EXPECT_LT(below, 200.0);
    EXPECT_TRUE(beyond < -50.0 || beyond > 1e4) << beyond;
  }
}

/// Greenhill, Proc. Inst. Mech. Eng. 34, 1883 (Timoshenko and Gere, Theory of Elastic Stability, 2.21): a shaft under
/// end moments of fixed axial direction. With U = y + i z and k = M / (E I) the moments across the axis say
///     i U'' + k U' = i (L - x) R / (E I) + C
/// (R the tip's reaction, C a moment of the base).
///
/// On two pins that leave all three turns free, and dead moments M and -M: R = C = 0, U' ~ exp(i k x), and U = 0 at
/// both ends asks for exp(i k L) = 1: M = 2 pi E I / L. The spin is held at the tip, where no reaction arises.
double shaft_on_pins(double moment, int sections) {
  const auto deflection = [&](double M) {
    Scene scene = straight_rod(L, sections, given({40 * EI, EI, EI, 1e7, 1e7, 1e7}), kAll, 0, 4);
    scene.rods[0].second.base = {BaseAxis::turn_x, BaseAxis::turn_y, BaseAxis::turn_z};
    add_tie(scene, {false, true, true}, {true, false, false});
    add_load(scene, Vec3::Zero(), Vec3(-M, 0, 0), 0.0);
    add_load(scene, Vec3::Zero(), Vec3(M, 0, 0));
    add_load(scene, Vec3(0, 1e-6 * EI / (L * L), 0), Vec3::Zero(), L / 2);
    return solve(scene).at(L / 2).y();
  };
  return deflection(moment) / deflection(0.0);
}

TEST(Greenhill, shaft_on_pins_buckles_at_two_pi) {
  const double exact = 2 * pi * EI / L;
  EXPECT_NEAR(critical_load(0.9 * exact, [](double M) { return shaft_on_pins(M, 24); }), exact, 0.01 * exact);
}

/// Clamped at both ends, the tip free to come nearer, twisted by its base: C and R are free, U' = 0 at both ends as
/// well, which asks for tan(k L / 2) = k L / 2: M = 8.9868 E I / L. The moment is G J angle / L.
double clamped_shaft(double moment, int sections) {
  constexpr double kTorsion = 40 * EI;
  const auto deflection = [&](double M) {
    Scene scene = straight_rod(L, sections, given({kTorsion, EI, EI, 1e7, 1e7, 1e7}), kAll, 0, 4);
    turn_base(scene, M * L / kTorsion);
    add_tie(scene, {false, true, true}, {true, true, true});
    add_load(scene, Vec3(0, 1e-6 * EI / (L * L), 0), Vec3::Zero(), L / 2);
    const Solved solved = solve(scene);
    EXPECT_NEAR(solved.end().actuators[0], M, 1e-3 * M + 1e-9);
    return solved.at(L / 2).y();
  };
  return deflection(moment) / deflection(0.0);
}

TEST(Greenhill, clamped_shaft_buckles_where_tan_x_is_x) {
  const double exact = 2 * 4.493409458 * EI / L;
  EXPECT_NEAR(critical_load(0.9 * exact, [](double M) { return clamped_shaft(M, 32); }), exact, 0.01 * exact);
}

/// A base that turns about y and z only, one axis carried by the other, is a universal joint: its reaction leans with
/// it, not with the axis. With the moment dead at the tip the same equations ask for tan(k L / 2) = - k L / 2: M
/// = 4.0575 E I / L, less than on true pins.
double shaft_on_joint(double moment, int sections) {
  const auto deflection = [&](double M) {
    Scene scene = straight_rod(L, sections, given({40 * EI, EI, EI, 1e7, 1e7, 1e7}), kAll, 0, 4);
    scene.rods[0].second.base = {BaseAxis::turn_y, BaseAxis::turn_z};
    add_tie(scene, {false, true, true});
    add_load(scene, Vec3::Zero(), Vec3(M, 0, 0));
    add_load(scene, Vec3(0, 1e-6 * EI / (L * L), 0), Vec3::Zero(), L / 2);
    return solve(scene).at(L / 2).y();
  };
  return deflection(moment) / deflection(0.0);
}

TEST(Greenhill, shaft_on_a_universal_joint_buckles_earlier) {
  const double exact = 2 * 2.028757838 * EI / L;
  EXPECT_NEAR(critical_load(0.9 * exact, [](double M) { return shaft_on_joint(M, 24); }), exact, 0.01 * exact);
}

}  // namespace
}  // namespace sinew::test
