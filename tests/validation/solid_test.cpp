// Solids against published benchmarks and closed forms.
#include <iostream>

#include "sinew/io/mesh_file.hpp"
#include "sinew/io/scene_file.hpp"
#include "sinew/sim/linearization.hpp"
#include "sinew/sim/solid_loads.hpp"
#include "sinew/sim/step_ends.hpp"
#include "validation/solids.hpp"

namespace sinew::test {
namespace {

using solid::Kind;

std::string name_of(const testing::TestParamInfo<Kind>& info) {
  return info.param == Kind::tet4 ? "tet4" : info.param == Kind::tet10 ? "tet10" : "hex8";
}

class Locking : public testing::TestWithParam<Kind> {};
INSTANTIATE_TEST_SUITE_P(Solid, Locking, testing::Values(Kind::tet10, Kind::hex8), name_of);

/// Cook's membrane (Cook, J. Struct. Div. ASCE 100, 1974), linear plane stress; converged value 23.91 quoted by several
/// codes. At 1e-4 of the load, so that it is linear.
TEST_P(Locking, cooks_membrane) {
  const int n = GetParam() == Kind::hex8 ? 40 : 12;
  const solid::Mesh mesh = mapped_block(GetParam(), n, n, 1, [](const Vec3& x) {
    return Vec3(48 * x.x(), 44 * x.x() + x.y() * (44 - 28 * x.x()), x.z());
  });
  Scene scene = solid_scene(solid::saint_venant_kirchhoff(1.0, 1.0 / 3.0));
  hold(scene, plane(Vec3::Zero(), Vec3::UnitX()), {true, true, false});
  hold(scene, plane(Vec3::Zero(), Vec3::UnitZ()), {false, false, true});
  load_solid(scene, plane(Vec3(48, 0, 0), Vec3::UnitX()), Vec3(0, 1e-4, 0));
  const double u = 1e4 * solve(scene, mesh).moved(Vec3(48, 52, 0.5)).y();
  std::cout << "Cook's membrane: " << u << "\n";
  EXPECT_NEAR(u, 23.91, 0.02 * 23.91);
}

/// x^power at the ends of n parts of [0, 1], linear between, so that nodes in the middle of edges stay there.
double graded(double x, int n, double power) {
  const int i = std::min(n - 1, static_cast<int>(x * n + 1e-9));
  const double a = std::pow(static_cast<double>(i) / n, power), b = std::pow((i + 1.0) / n, power);
  return a + (b - a) * (x * n - i);
}

/// NAFEMS LE10, thick elliptic plate under pressure: stress at the inner end of the major axis, on top.
TEST(Solid, NafemsThickPlate) {
  const solid::Mesh mesh = mapped_block(Kind::tet10, 5, 8, 6, [](const Vec3& x) {
    const double r = graded(x.x(), 5, 2.0), a = 0.5 * pi * graded(x.y(), 8, 1.5);
    return Vec3((2 + 1.25 * r) * std::cos(a), (1 + 1.75 * r) * std::sin(a), 0.6 * x.z());
  });
  Scene scene = solid_scene(solid::saint_venant_kirchhoff(210e9, 0.3));
  const auto outer = [](const Vec3& x) { return std::abs(std::hypot(x.x() / 3.25, x.y() / 2.75) - 1) < 1e-3; };
  hold(scene, plane(Vec3::Zero(), Vec3::UnitY()), {false, true, false});
  hold(scene, plane(Vec3::Zero(), Vec3::UnitX()), {true, false, false});
  hold(scene, nodes_where(mesh, outer), {true, true, false});
  hold(scene, nodes_where(mesh, [&](const Vec3& x) { return outer(x) && std::abs(x.z() - 0.3) < 1e-6; }),
       {false, false, true});
  load_solid(scene, plane(Vec3(0, 0, 0.6), Vec3::UnitZ()), Vec3::Zero(), 1e6);
  const double stress = solve(scene, mesh).stress(Vec3(2, 0, 0.6))(1, 1);
  std::cout << "LE10: sigma_yy = " << stress * 1e-6 << " MPa\n";
  EXPECT_NEAR(stress, -5.38e6, 0.03 * 5.38e6);
}

/// A slender block is an elastica (Mattiasson, Int. J. Num. Meth. Eng. 17, 1981, table 1).
TEST_P(Locking, slender_block_is_the_elastica) {
  constexpr double L = 1.0, h = 0.01, E = 1e9, EI = E * h * h * h * h / 12;
  const double rows[][3] = {{1, 0.30172, 0.05643}, {2, 0.49346, 0.16064}, {5, 0.71379, 0.38763}};
  const int n = GetParam() == Kind::hex8 ? 1000 : 60;
  const solid::Mesh mesh =
      mapped_block(GetParam(), n, 1, 1, [](const Vec3& x) { return Vec3(L * x.x(), h * x.y(), h * x.z()); });
  for (const auto& [alpha, w, u] : rows) {
    Scene scene = solid_scene(solid::saint_venant_kirchhoff(E, 0.0));
    hold(scene, plane(Vec3::Zero(), Vec3::UnitX()));
    load_solid(scene, plane(Vec3(L, 0, 0), Vec3::UnitX()), Vec3(0, alpha * EI / (L * L), 0));
    const Vec3 tip = solve(scene, mesh).moved(Vec3(L, 0.5 * h, 0.5 * h));
    EXPECT_NEAR(tip.y(), w * L, 0.01 * w * L) << alpha;
    EXPECT_NEAR(-tip.x(), u * L, 0.01 * u * L) << alpha;
  }
}

/// Lame's thick-walled cylinder in plane strain, nearly incompressible as well.
TEST_P(Locking, thick_walled_cylinder_under_pressure) {
  constexpr double a = 1.0, b = 2.0, E = 1e6, p = 1.0;
  const int n = GetParam() == Kind::hex8 ? 32 : 10;
  const solid::Mesh mesh = mapped_block(GetParam(), n, n, 1, [](const Vec3& x) {
    const double r = a + (b - a) * x.x(), angle = 0.5 * pi * x.y();
    return Vec3(r * std::cos(angle), r * std::sin(angle), 0.1 * x.z());
  });
  for (const double nu : {0.3, 0.4999}) {
    Scene scene = solid_scene(solid::neo_hookean(E, nu));
    hold(scene, plane(Vec3::Zero(), Vec3::UnitY()), {false, true, false});
    hold(scene, plane(Vec3::Zero(), Vec3::UnitX()), {true, false, false});
    hold(scene, plane(Vec3::Zero(), Vec3::UnitZ()), {false, false, true});
    hold(scene, plane(Vec3(0, 0, 0.1), Vec3::UnitZ()), {false, false, true});
    load_solid(scene, nodes_where(mesh, [](const Vec3& x) { return std::hypot(x.x(), x.y()) < a + 1e-3; }),
               Vec3::Zero(), p);
    const SolvedSolid solved = solve(scene, mesh);
    const auto exact = [&](double r) {
      return (1 + nu) / E * p * a * a / (b * b - a * a) * ((1 - 2 * nu) * r + b * b / r);
    };
    EXPECT_NEAR(solved.moved(Vec3(a, 0, 0.05)).x(), exact(a), 0.01 * exact(a)) << nu;
    EXPECT_NEAR(solved.moved(Vec3(0, b, 0.05)).y(), exact(b), 0.01 * exact(b)) << nu;
  }
}

double bent_block(Kind kind, int n, double poisson) {
  const Vec3 size(50 * mm, 10 * mm, 10 * mm);
  const solid::Mesh mesh = mapped_block(kind, 5 * n, n, n, [&](const Vec3& x) { return Vec3(x.cwiseProduct(size)); });
  Scene scene = solid_scene(solid::neo_hookean(1e6, poisson));
  hold(scene, plane(Vec3::Zero(), Vec3::UnitX()));
  load_solid(scene, plane(size, Vec3::UnitX()), Vec3(0, 0.005, 0));
  return solve(scene, mesh).moved(Vec3(50 * mm, 5 * mm, 5 * mm)).y();
}

TEST_P(Locking, nearly_incompressible_block_bends_as_the_fine_one) {
  static const double fine = bent_block(Kind::tet10, 3, 0.4999);
  const double coarse = bent_block(GetParam(), GetParam() == Kind::hex8 ? 5 : 2, 0.4999);
  std::cout << "bent at 0.4999: " << coarse / fine << " of the fine reference\n";
  EXPECT_NEAR(coarse, fine, 0.03 * fine);
}

TEST(Solid, linear_tetrahedra_lock_and_say_so) {
  EXPECT_LT(bent_block(Kind::tet4, 3, 0.4999), 0.6 * bent_block(Kind::tet10, 2, 0.4999));
  Scene scene = solid_scene(solid::corotational(1e6, 0.495));
  hold(scene, plane(Vec3::Zero(), Vec3::UnitX()));
  const Model model = build(scene, [](const auto&) { return block_mesh(2, 1, 1, Vec3::Ones()); });
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_NE(to_string(model.warnings[0]).find("10-node tetrahedra"), std::string::npos) << to_string(model.warnings[0]);
}

const solid::OgdenTerm kRubber[] = {{6.3e5, 1.3}, {1.2e3, 5.0}, {-1e4, -2.0}};
const std::pair<const char*, solid::Law> kLaws[] = {
    {"corotational", solid::corotational(1e6, 0.45)},
    {"saint_venant_kirchhoff", solid::saint_venant_kirchhoff(1e6, 0.4)},
    {"neo_hookean", solid::neo_hookean(1e6, 0.45)},
    {"mooney_rivlin", solid::mooney_rivlin(1.2e5, 0.5e5, solid::Poisson{0.45})},
    {"ogden", solid::ogden(kRubber, solid::Bulk{2e6})}};

/// Newton from a bent block to one bent 5 % more, law by law.
TEST_P(Locking, newton_converges_quadratically_for_every_law) {
  const Vec3 size(40 * mm, 10 * mm, 10 * mm);
  const solid::Mesh mesh = mapped_block(GetParam(), 4, 1, 1, [&](const Vec3& x) { return Vec3(x.cwiseProduct(size)); });
  for (const auto& [name, law] : kLaws) {
    Scene scene = solid_scene(law);
    hold(scene, plane(Vec3::Zero(), Vec3::UnitX()));
    load_solid(scene, plane(size, Vec3::UnitX()), Vec3(0, 0.3, 0));
    const SolvedSolid bent = solve(scene, mesh);
    Command command = command_at(bent.model, 1.0);
    command.loads[0] *= 1.05;
    const StepContext context = make_context(bent.model, bent.end(), command, 1.0);
    Linearization here;
    Increment increment;
    State iterate = bent.end();
    StageTimes times;
    std::vector<double> residuals;
    std::vector<Eigen::Matrix3Xd> positions;
    for (int i = 0; i < 7; ++i) {
      here.evaluate(context, iterate, times);
      residuals.push_back(here.largest() / here.scale());
      positions.push_back(iterate.solids[0].x);
      std::string failed;
      ASSERT_TRUE(here.factor(solid::Tangent::exact, Linearization::Wanted::any, failed));
      EXPECT_FALSE(here.rotated());
      here.solve(increment);
      advance_by(context, increment, 1.0, iterate);
    }
    std::cout << name << ":";
    for (const double r : residuals) std::cout << " " << r;
    std::cout << "\n";
    // Distances from the end: each the square of the one before it.
    std::vector<double> off;
    for (const Eigen::Matrix3Xd& x : positions) off.push_back((x - positions.back()).norm() / size.norm());
    double best = 0.0;
    for (std::size_t k = 1; k + 1 < off.size() && off[k + 1] > 1e-13; ++k)
      best = std::max(best, std::log(off[k + 1] / off[k]) / std::log(off[k] / off[k - 1]));
    std::cout << "  order " << best << "\n";
    EXPECT_GT(best, 1.7) << name;
    EXPECT_LT(residuals.back(), 1e-11) << name;
  }
}

/// Reactions balance loads; work becomes strain energy.
TEST_P(Locking, reactions_and_energies_balance) {
  const Vec3 size(40 * mm, 10 * mm, 10 * mm);
  const solid::Mesh mesh = mapped_block(GetParam(), 6, 2, 2, [&](const Vec3& x) { return Vec3(x.cwiseProduct(size)); });
  Scene scene = solid_scene(solid::neo_hookean(1e6, 0.45), 40);
  scene.gravity = Vec3(0, 0, -9.81);
  hold(scene, plane(Vec3::Zero(), Vec3::UnitX()));
  load_solid(scene, plane(size, Vec3::UnitX()), Vec3(0.1, 0.2, 0));
  load_solid(scene, plane(size, Vec3::UnitY()), Vec3::Zero(), 500.0);
  Output reaction;
  reaction.solid = "solid";
  reaction.quantity = Quantity::reaction;
  scene.outputs.emplace_back("held", reaction);
  const SolvedSolid solved = solve(scene, mesh);
  const std::vector<double> values = signal_values(solved.model, solved.end());
  Vec3 acting = Vec3(0, 0, -9.81) * solved.model.solids[0].body.masses.sum();
  for (const LoadModel& load : solved.model.loads)
    acting += load_forces(std::get<SolidLoadModel>(load.on), solved.end().solids[0].x).rowwise().sum();
  EXPECT_LT((Vec3(values[0], values[1], values[2]) + acting).norm(), 1e-8);
  EXPECT_GT(acting.norm(), 0.1);
  const EnergyBalance now = energy_balance(solved.model, solved.end()),
                      start = energy_balance(solved.model, solved.trace.states[1]);
  const double work = solved.end().energies.work - solved.trace.states[1].energies.work;
  EXPECT_NEAR(work, now.total() - start.total(), 2e-3 * work);
  EXPECT_GT(work, 1e-4);
}

/// The example's finger with its cable: the equilibrium is where the damped motion ends.
TEST(Solid, finger_pulled_by_its_cable_rests_where_its_damped_motion_ends) {
  const auto run = [](const std::vector<std::string>& changes) {
    const std::filesystem::path file = std::filesystem::path(SINEW_SOURCE_DIR) / "examples/finger.yaml";
    const Trace trace = run_all(build(io::read_scene(file, changes).scene, io::read_mesh));
    EXPECT_EQ(trace.end, RunEnd::done) << to_string(trace.failure.status) << " " << trace.failure.detail;
    return trace.states.back().solids[0].x;
  };
  const Eigen::Matrix3Xd at_rest = run({"analysis=static"});
  const Eigen::Matrix3Xd settled =
      run({"time.step=20 ms", "time.duration=3 s", "solids.finger.rayleigh.stiffness=30 ms"});
  const Eigen::Matrix3Xd followed = run({"analysis=quasi_static", "time.step=0.2 s"});
  const auto apart = [&](const Eigen::Matrix3Xd& x) { return (at_rest - x).colwise().norm().maxCoeff(); };
  std::cout << "finger: from static to the end of its motion " << apart(settled) << " m, to quasi-static "
            << apart(followed) << " m\n";
  EXPECT_LT(apart(settled), 1e-6);
  EXPECT_LT(apart(followed), 1e-6);
}

/// Pressure on the top of a cantilever stays on it as it bends, and has no potential. Against the elastica under a load
/// q per length that stays perpendicular to it: from the tip to the root, in the axes of the cross-section,
///     N' = kappa V,   V' = q - kappa N,   kappa' = V / EI.
TEST(Solid, follower_pressure_on_an_open_surface_bends_as_the_elastica) {
  constexpr double L = 0.2, h = 0.005, E = 1e6, EI = E * h * h * h * h / 12, p = 10.0, q = p * h;
  const solid::Mesh mesh =
      mapped_block(Kind::tet10, 24, 1, 1, [](const Vec3& x) { return Vec3(L * x.x(), h * x.y(), h * x.z()); });
  Scene scene = solid_scene(solid::saint_venant_kirchhoff(E, 0.0));
  hold(scene, plane(Vec3::Zero(), Vec3::UnitX()));
  load_solid(scene, plane(Vec3(0, h, 0), Vec3::UnitY()), Vec3::Zero(), p);
  const SolvedSolid solved = solve(scene, mesh);
  EXPECT_LT(solved.trace.states.size(), 40u);
  for (const StepReport& report : solved.trace.reports) EXPECT_LT(report.newton, 8);

  constexpr int kParts = 20000;
  const double ds = L / kParts;
  double N = 0.0, V = 0.0, kappa = 0.0, angle = 0.0;
  Eigen::Vector2d root(0, 0);  // from the tip, in the axes of the tip
  for (int i = 0; i < kParts; ++i) {
    const double middle = angle + 0.5 * ds * kappa, dN = kappa * V, dV = q - kappa * N;
    root += ds * Eigen::Vector2d(std::cos(middle), std::sin(middle));
    angle += ds * (kappa + 0.5 * ds * V / EI);
    kappa += ds * V / EI;
    N += ds * dN;
    V += ds * dV;
  }
  const Eigen::Vector2d tip = Eigen::Rotation2Dd(-angle) * root;  // from the root, in its axes
  const Vec3 moved = solved.moved(Vec3(L, 0.5 * h, 0.5 * h));
  std::cout << "tip at " << L + moved.x() << " " << moved.y() << ", elastica " << tip.x() << " " << tip.y() << "\n";
  EXPECT_GT(angle, 1.0);
  EXPECT_NEAR(L + moved.x(), tip.x(), 0.01 * L);
  EXPECT_NEAR(moved.y(), tip.y(), 0.01 * L);
}

}  // namespace
}  // namespace sinew::test
