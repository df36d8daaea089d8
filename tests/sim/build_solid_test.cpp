// Solids as they arrive in the model: materials, what holds them, springs, and what is refused.
#include <gmock/gmock.h>

#include "sim/rejected.hpp"
#include "sinew/lie/rotation.hpp"
#include "sinew/sim/solid_loads.hpp"
#include "sinew/sim/solid_matrix.hpp"
#include "support/difference.hpp"
#include "validation/solids.hpp"

namespace sinew::test {
namespace {

using solid::Kind;
using testing::HasSubstr;

const Plane kLeft = plane(Vec3::Zero(), Vec3::UnitX()), kRight = plane(Vec3(2, 0, 0), Vec3::UnitX());

solid::Mesh block(Kind kind = Kind::hex8) { return block_mesh(2, 1, 1, Vec3(2, 1, 1), kind); }

Model build_block(const Scene& scene, Kind kind = Kind::hex8) {
  return build(scene, [kind](const auto&) { return block(kind); });
}

Scene clamped() {
  Scene scene = solid_scene(solid::corotational(1e6, 0.3), 1);
  hold(scene, kLeft);
  return scene;
}

Solid& solid_of(Scene& scene) { return scene.solids[0].second; }

TEST(BuildSolid, parts_have_their_own_law_viscosity_and_density) {
  Scene scene = clamped();
  Solid& solid = solid_of(scene);
  solid.material.viscosity = 30.0;
  solid.rayleigh = {0.5, 0.01};
  SolidMaterial bone;
  bone.law = solid::neo_hookean(5e6, 0.4);
  bone.viscosity = 6.0;
  bone.density = 1300.0;
  solid.parts.push_back({Box{Vec3(1, 0, 0), Vec3(2, 1, 1)}, bone});
  const solid::Body body = build_block(scene).solids[0].body;
  EXPECT_THAT(body.material, testing::ElementsAre(0, 1));
  EXPECT_TRUE(std::holds_alternative<solid::NeoHookean>(body.of(1).law));
  EXPECT_EQ(body.damping_mass, 0.5);
  for (const auto& [cell, eta, density] : {std::tuple(0, 30.0, 1000.0), std::tuple(1, 6.0, 1300.0)}) {
    const solid::Lame moduli = solid::lame(body.of(cell).law), viscous = body.of(cell).viscosity;
    EXPECT_NEAR(viscous.mu, 0.01 * moduli.mu + eta, 1e-12 * viscous.mu);
    EXPECT_NEAR(viscous.lambda, 0.01 * moduli.lambda - 2.0 / 3.0 * eta, 1e-12 * viscous.lambda);
    EXPECT_EQ(body.of(cell).density, density);
  }
  EXPECT_NEAR(body.masses.sum(), 2300.0, 1e-9);
}

TEST(BuildSolid, mass_is_known_of_every_cell) {
  SolidMaterial own = solid_of(*std::make_unique<Scene>(clamped())).material;
  own.density = 1300.0;
  const Region half = Box{Vec3(1, 0, 0), Vec3(2, 1, 1)};
  Scene scene = clamped();
  Solid& solid = solid_of(scene);
  solid.parts.push_back({half, own});
  solid.density.reset();
  expect_rejected(scene, block(), "solids.solid.density", "is not known of 1 of the cells");
  solid.parts.push_back({kLeft, own});
  std::get<Plane>(solid.parts[1].region).within = 1.0;
  EXPECT_NEAR(build_block(scene).solids[0].body.masses.sum(), 2600.0, 1e-9);
  solid.parts.clear();
  solid.mass = 3.0;
  EXPECT_NEAR(build_block(scene).solids[0].body.masses.sum(), 3.0, 1e-12);
}

TEST(BuildSolid, refuses_numbers_that_no_scene_file_could_hold) {
  const double nan = std::nan("");
  const auto rejected = [](const std::string& path, const std::string& rule, const auto& change) {
    Scene scene = clamped();
    solid_of(scene).parts.push_back({WholeSurface{}, solid_of(scene).material});
    change(solid_of(scene));
    expect_rejected(scene, block(), "solids.solid." + path, rule);
  };
  for (const double bad : {-1.0, nan, double{INFINITY}}) {
    rejected("parts.0.material.density", "greater than 0", [=](Solid& s) { s.parts[0].material.density = bad; });
    rejected("material.density", "greater than 0", [=](Solid& s) { s.material.density = bad; });
    rejected("density", "greater than 0", [=](Solid& s) { s.density = bad; });
    rejected("rayleigh.mass", "0 or more", [=](Solid& s) { s.rayleigh.mass = bad; });
    rejected("rayleigh.stiffness", "0 or more", [=](Solid& s) { s.rayleigh.stiffness = bad; });
    rejected("material.viscosity", "0 or more", [=](Solid& s) { s.material.viscosity = bad; });
  }
}

TEST(BuildSolid, warns_of_holes_where_the_file_has_other_cells) {
  Scene scene = clamped();
  solid::Mesh mesh = block();
  mesh.ignored = {{"line", 4}, {"quadratic hexahedron", 2}, {"quadrilateral", 9}, {"wedge", 7}};
  const Model model = build(scene, [&](const auto&) { return mesh; });
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_THAT(to_string(model.warnings[0]), HasSubstr("2 of kind quadratic hexahedron, 7 of kind wedge;"));
  mesh.ignored = {{"line", 4}, {"quadrilateral", 9}, {"polygon", 1}};
  EXPECT_TRUE(build(scene, [&](const auto&) { return mesh; }).warnings.empty());
}

TEST(BuildSolid, reactions_are_of_nodes_that_are_held) {
  Scene scene = clamped();
  Output output;
  output.solid = "solid";
  output.quantity = Quantity::reaction;
  scene.outputs.emplace_back("held", output);
  build_block(scene);
  scene.outputs[0].second.region = kRight;
  expect_rejected(scene, block(), "outputs.held", "no node of this region is held");
  hold(scene, kRight, {false, false, true});
  build_block(scene);
  solid_of(scene).fixed.clear();
  solid_of(scene).springs.push_back({kLeft, Vec3::Ones()});
  scene.outputs[0].second.region.reset();
  expect_rejected(scene, block(), "outputs.held", "no node of this solid is held");
}

TEST(Fixed, axes_are_held_where_their_frame_takes_them) {
  Scene scene = clamped();
  FrameMotion motion;
  motion.times = {0.0, 1.0};
  motion.translate = {Vec3::Zero(), Vec3(0.02, 0.5, 0)};
  scene.frames.emplace_back("grip", Frame{{}, motion});
  hold(scene, kRight, {true, false, false}).frame = "grip";
  const SolvedSolid pulled = solve(scene, block());
  const SolidModel& model = pulled.model.solids[0];
  for (int i = 0; i < model.body.nodes(); ++i) {
    const Vec3 x = model.body.rest.col(i), u = pulled.end().solids[0].x.col(i) - x;
    if (x.x() == 1.0) EXPECT_TRUE((model.body.unknown.col(i).array() >= 0).all());
    if (x.x() == 0.0) {
      EXPECT_EQ(u.norm(), 0.0);
      EXPECT_EQ(model.carrier(0, i), -1);
    }
    if (x.x() < 2.0) continue;
    EXPECT_EQ(model.body.unknown(0, i), -1);
    EXPECT_EQ(model.carrier(0, i), 0);
    EXPECT_NEAR(u.x(), 0.02, 1e-15);  // moved along x by the frame, but not along y
    EXPECT_LT(std::abs(u.y()), 0.005);
    EXPECT_LT(u.y() * (x.y() - 0.5), -1e-4);  // thinner
  }
  hold(scene, kRight, {false, true, false});  // by the ground
  const SolvedSolid both = solve(scene, block());
  for (int i = 0; i < both.model.solids[0].body.nodes(); ++i) {
    const Vec3 x = both.model.solids[0].body.rest.col(i), u = both.end().solids[0].x.col(i) - x;
    if (x.x() < 2.0) continue;
    EXPECT_NEAR(u.x(), 0.02, 1e-15);
    EXPECT_EQ(u.y(), 0.0);
  }
  hold(scene, kRight, {true, false, false});
  expect_rejected(scene, block(), "solids.solid.fixed", "held along x by two frames");
}

std::string free_motion_of(const std::function<void(Scene&)>& held, const Pose& pose = {}) {
  Scene scene = solid_scene(solid::corotational(1e6, 0.3), 1);
  solid_of(scene).pose = pose;
  held(scene);
  try {
    EXPECT_TRUE(build_block(scene).warnings.empty());
    return "";
  } catch (const InputError& error) {
    EXPECT_EQ(error.fault().path, "solids.solid.fixed");
    const std::string rule = error.fault().rule, start = "the body is free to ";
    EXPECT_EQ(rule.substr(0, start.size()), start);
    return rule.substr(start.size());
  }
}

TEST(Held, names_the_rigid_motion_that_is_left) {
  // Nodes of the block: 0 at the origin, 1 and 2 beyond it along x, 3 beyond it along y, 6 along z.
  const auto nodes = [](std::vector<int> numbers, std::array<bool, 3> axes = {true, true, true}) {
    return [=](Scene& scene) { hold(scene, NodeNumbers{numbers}, axes); };
  };
  EXPECT_EQ(free_motion_of([](Scene&) {}), "move and turn every way");
  EXPECT_EQ(free_motion_of(nodes({0, 3, 6})), "");
  EXPECT_EQ(free_motion_of(nodes({0, 2})), "turn about [1, 0, 0] through [1, 0, 0] m");
  EXPECT_EQ(free_motion_of(nodes({0, 1, 2})), "turn about [1, 0, 0] through [1, 0, 0] m");
  EXPECT_EQ(free_motion_of(nodes({0, 2}), {{0, 0, 0.25 * pi}, {5, 0, 1}}),
            "turn about [0.707107, 0.707107, 0] through [5.70711, 0.707107, 1] m");
  EXPECT_EQ(
      free_motion_of(nodes({2})),
      "turn about [1, 0, 0] through [2, 0, 0] m, [0, 1, 0] through [2, 0, 0] m and [0, 0, 1] through [2, 0, 0] m");
  const auto on_plane = [](Scene& scene) { hold(scene, kLeft, {true, false, false}); };
  EXPECT_EQ(free_motion_of(on_plane), "move along y and z and turn about [1, 0, 0] through [0.666667, 0.5, 0.5] m");
  // Three, two and one coordinates in three directions hold everything; without the last it turns about node 0.
  EXPECT_EQ(free_motion_of([&](Scene& scene) {
              nodes({0, 2, 3}, {false, false, true})(scene);
              nodes({0, 2}, {false, true, false})(scene);
              nodes({0}, {true, false, false})(scene);
            }),
            "");
  EXPECT_EQ(free_motion_of([&](Scene& scene) {
              nodes({0, 2, 3}, {false, false, true})(scene);
              nodes({0}, {true, true, false})(scene);
            }),
            "turn about [0, 0, 1] through [0, 0, 0] m");
}

TEST(Held, springs_hold_what_they_have_stiffness_for) {
  const auto sprung = [](const Region& region, const Vec3& stiffness) {
    return [=](Scene& scene) { solid_of(scene).springs.push_back({region, stiffness}); };
  };
  EXPECT_EQ(free_motion_of(sprung(WholeSurface{}, Vec3::Ones())), "");
  EXPECT_THAT(free_motion_of(sprung(WholeSurface{}, Vec3(0, 1, 1))), "move along x");
  EXPECT_EQ(free_motion_of(sprung(WholeSurface{}, Vec3::Zero())), "move and turn every way");
  EXPECT_THAT(free_motion_of([&](Scene& scene) {
                hold(scene, NodeNumbers{{0, 2}});
                sprung(NodeNumbers{{3}}, Vec3(0, 0, 1e-9))(scene);
              }),
              "");
}

TEST(Held, a_body_in_motion_or_coupled_only_warns) {
  Scene scene = solid_scene(solid::corotational(1e6, 0.3), 1);
  hold(scene, NodeNumbers{{0, 2}});
  scene.analysis = Analysis::dynamic;
  const Model flies = build_block(scene);
  ASSERT_EQ(flies.warnings.size(), 1u);
  EXPECT_EQ(to_string(flies.warnings[0]),
            "solids.solid: what is fixed and its springs leave it free to turn about [1, 0, 0] through [1, 0, 0] m");
  scene.analysis = Analysis::quasi_static;
  Rod rod;
  rod.path = {Vec3(1, 2, 1), Vec3(1, 1, 1)};
  rod.section = Circle{0.01};
  rod.material = {1e6, 0.3, 1000.0};
  scene.rods.emplace_back("rod", rod);
  Tie tie;
  tie.rod = "rod";
  tie.solid = "solid";
  scene.couplings.emplace_back(tie);
  const Model tied = build_block(scene);
  ASSERT_EQ(tied.warnings.size(), 1u);
  EXPECT_THAT(to_string(tied.warnings[0]), testing::EndsWith("but for its couplings"));
}

/// A block on springs alone, in a frame that moves.
Scene on_springs(const Region& region) {
  Scene scene = solid_scene(solid::corotational(1e6, 0.3), 1);
  FrameMotion motion;
  motion.times = {0.0, 1.0};
  motion.rotate = {Vec3::Zero(), Vec3(0.1, 0.4, -0.2)};
  motion.translate = {Vec3::Zero(), Vec3(0.3, 0.5, 0)};
  scene.frames.emplace_back("hand", Frame{{}, motion});
  solid_of(scene).frame = "hand";
  solid_of(scene).springs.push_back({region, Vec3(1e6, 2e6, 3e6)});
  return scene;
}

TEST(Springs, have_positive_stiffness_at_every_node_of_curved_faces) {
  const solid::Mesh mesh = mapped_block(Kind::tet10, 2, 2, 2, [](const Vec3& x) {
    return Vec3((1 + x.x()) * std::cos(x.y()), (1 + x.x()) * std::sin(x.y()), x.z() + 0.2 * x.x() * x.y());
  });
  const Model model = build(on_springs(WholeSurface{}), [&](const auto&) { return mesh; });
  const SolidModel& solid = model.solids[0];
  EXPECT_LT((solid.springs.rowwise().sum() - Vec3(1e6, 2e6, 3e6)).norm(), 1e-6);
  for (const solid::CellFace& face : solid.mesh.boundary) {
    for (const int node : face.nodes()) EXPECT_GT(solid.springs.col(node).minCoeff(), 1e3);
  }
  EXPECT_EQ((solid.springs.row(0).array() == 0.0).count(), 27);  // the nodes inside: of 5 x 5 x 5
}

TEST(Springs, pull_back_to_where_the_frame_takes_their_rest) {
  for (const Kind kind : {Kind::tet4, Kind::tet10, Kind::hex8}) {
    const Model model = build_block(on_springs(kRight), kind);
    const State start = initial_state(model);
    const Placement moved = frame_displacement(model.scene.frames[0].second, 1.0);
    const Eigen::Matrix3Xd carried = (moved.R * model.solids[0].body.rest).colwise() + moved.p;
    const auto pulling = [&](const Eigen::Matrix3Xd& x) -> Eigen::Matrix3Xd {
      return model.solids[0].springs.cwiseProduct(spring_stretch(model.solids[0], moved, x));
    };
    EXPECT_LT(pulling(carried).norm(), 1e-9);
    const Vec3 off(0.1, -0.2, 0.3);
    const Vec3 force = pulling(carried.colwise() + off).rowwise().sum();
    EXPECT_LT((force - off.cwiseProduct(Vec3(1e6, 2e6, 3e6))).norm(), 1e-6);
    EXPECT_GT(pulling(start.solids[0].x).norm(), 1e5);
    // A body on springs alone goes with its frame, without strain.
    const SolvedSolid solved = solve(on_springs(kRight), block(kind));
    EXPECT_LT((solved.end().solids[0].x - carried).norm(), 1e-8);
  }
}

/// Without gravity and damping what supports do is stored: in the body, and in springs where a load draws them.
TEST(Energies, work_of_supports_and_springs_is_stored) {
  Scene scene = solid_scene(solid::neo_hookean(1e6, 0.4), 20);
  FrameMotion motion;
  motion.times = {0.0, 1.0};
  motion.translate = {Vec3::Zero(), Vec3(0.4, 0.2, 0)};
  scene.frames.emplace_back("hand", Frame{{}, motion});
  hold(scene, plane(Vec3::Zero(), Vec3::UnitX()));
  hold(scene, plane(Vec3(2, 0, 0), Vec3::UnitX())).frame = "hand";
  const auto balance = [](const SolvedSolid& solved) {
    const EnergyBalance energy = energy_balance(solved.model, solved.end());
    EXPECT_GT(energy.elastic, 1e3);
    EXPECT_NEAR(solved.end().energies.work, energy.elastic, 2e-3 * energy.elastic);
  };
  const solid::Mesh mesh = block_mesh(4, 2, 2, Vec3(2, 1, 1), Kind::hex8);
  balance(solve(scene, mesh));
  // Held by springs alone at the other end: their frame moves nothing, the hand draws them.
  solid_of(scene).fixed.erase(solid_of(scene).fixed.begin());
  solid_of(scene).springs.push_back({plane(Vec3::Zero(), Vec3::UnitX()), Vec3(1e5, 2e5, 1e5)});
  balance(solve(scene, mesh));
  // And the springs' frame draws the body against the ground.
  solid_of(scene).fixed[0].frame.reset();
  solid_of(scene).frame = "hand";
  scene.frames.emplace_back("floor", Frame{});
  solid_of(scene).fixed[0].frame = "floor";
  balance(solve(scene, mesh));
}

/// Batches leave out elements without a rotation, which are then put in one by one.
TEST(Tangent, batches_are_what_their_elements_are_also_inside_out) {
  const Model model = build(clamped(), [](const auto&) { return block_mesh(3, 2, 2, Vec3(2, 1, 1), Kind::tet4); });
  const State start = initial_state(model);
  const StepContext context = make_context(model, start, command_at(model, 1.0), 1.0);
  Eigen::Matrix3Xd x = start.solids[0].x;
  x.col(x.cols() - 1) -= Vec3(1.0, 0.3, 0.4);  // through the opposite faces of its elements
  EXPECT_FALSE(solid::folded_cells(model.solids[0].body, x).empty());
  SolidModel one_by_one = model.solids[0];
  for (const solid::TetBatch& batch : one_by_one.body.batches)
    one_by_one.body.others.insert(one_by_one.body.others.end(), batch.cell, batch.cell + batch.count);
  one_by_one.body.batches.clear();
  linalg::SparseFactor batches(model.solids[0].fronts), elements(model.solids[0].fronts);
  assemble(model.solids[0], context.start_of(0), x, solid::Tangent::definite, batches.values());
  assemble(one_by_one, context.start_of(0), x, solid::Tangent::definite, elements.values());
  const linalg::SparseFactor::Matrix A = elements.assembled(), off = batches.assembled() - A;
  EXPECT_LT(off.norm(), 1e-12 * A.norm());
}

/// The tangent over the unknowns against differences of forces, in a disturbed state.
void expect_tangent(const Model& model, const Command& command, double h) {
  const State start = initial_state(model);
  const StepContext context = make_context(model, start, command, h);
  const SolidModel& solid = model.solids[0];
  State state = start;
  for (Eigen::Index i = 0; i < state.solids[0].x.size(); ++i)
    state.solids[0].x(i) += 0.02 * std::sin(1.3 * static_cast<double>(i * i + 1));
  linalg::SparseFactor factor(solid.fronts);
  assemble(solid, context.start_of(0), state.solids[0].x, solid::Tangent::exact, factor.values());
  for (const Grip& grip : command.grips) add_grip(solid, grip, factor.values());
  const Eigen::MatrixXd K = Eigen::MatrixXd(factor.assembled()).selfadjointView<Eigen::Lower>();
  const auto force = [&](const Eigen::VectorXd& moves) -> Eigen::VectorXd {
    State moved = state;
    Eigen::Matrix3Xd dx;
    solid::from_unknowns(solid.body, moves, dx);
    moved.solids[0].x += dx;
    SolidForces forces;
    solid_forces(context, moved, {}, 0, forces);
    return forces.r;
  };
  const Eigen::MatrixXd D = difference(force, Eigen::VectorXd::Zero(solid.body.unknowns), 1e-6);
  EXPECT_LT((K - D).norm(), 1e-8 * K.norm());
}

TEST(Springs, are_in_the_tangent) {
  const Model model = build_block(on_springs(kRight));
  expect_tangent(model, command_at(model, 1.0), 1.0);
}

/// With a node that is held, and another one in one direction; springs and grips pull at these as well.
TEST(Tangent, has_mass_springs_and_grips_where_nodes_are_free) {
  for (const solid::MassMatrix mass : {solid::MassMatrix::lumped, solid::MassMatrix::consistent}) {
    Scene scene = on_springs(WholeSurface{});
    scene.analysis = Analysis::dynamic;
    solid_of(scene).mass_matrix = mass;
    hold(scene, NodeNumbers{{0}});
    solid_of(scene).fixed.push_back({NodeNumbers{{3}}, {false, true, false}});
    const Model model = build_block(scene);
    ASSERT_EQ(model.solids[0].held(), 4);
    Command command = command_at(model, 1.0);
    for (const int node : {0, 3, 5}) command.grips.push_back({0, node, 3e6, Vec3(0.1, 0.2, 0.3)});
    expect_tangent(model, command, 0.1);
  }
}

}  // namespace
}  // namespace sinew::test
