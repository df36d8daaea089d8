// The same block and finger in an independent program, CalculiX (ccx on the PATH; without it these tests are skipped).
// Its elastic material under NLGEOM is Saint Venant-Kirchhoff.
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <sstream>

#include "sinew/io/mesh_file.hpp"
#include "validation/solids.hpp"

namespace sinew::test {
namespace {

namespace fs = std::filesystem;

/// Writes a model under its dead loads as a CalculiX job, runs it, and reads the displacements of all nodes.
Eigen::Matrix3Xd by_calculix(const Model& model, double young, double poisson, const fs::path& folder) {
  const SolidModel& solid = model.solids[0];
  fs::create_directories(folder);
  {
    std::ofstream job(folder / "job.inp");
    job.precision(12);
    job << "*NODE, NSET=ALL\n";
    for (int i = 0; i < solid.body.nodes(); ++i)
      job << i + 1 << ", " << solid.body.rest(0, i) << ", " << solid.body.rest(1, i) << ", " << solid.body.rest(2, i)
          << "\n";
    const solid::Kind kind = solid.body.cells[0].kind;
    job << "*ELEMENT, ELSET=BODY, TYPE="
        << (kind == solid::Kind::tet4    ? "C3D4"
            : kind == solid::Kind::tet10 ? "C3D10"
                                         : "C3D8")
        << "\n";
    for (int e = 0; e < solid.body.elements(); ++e) {
      job << e + 1;
      for (const int node : solid.body.cells[e].nodes()) job << ", " << node + 1;
      job << "\n";
    }
    job << "*MATERIAL, NAME=SILICONE\n*ELASTIC\n"
        << young << ", " << poisson << "\n*SOLID SECTION, ELSET=BODY, MATERIAL=SILICONE\n*BOUNDARY\n";
    for (int i = 0; i < solid.body.nodes(); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        if (solid.body.unknown(axis, i) < 0) job << i + 1 << ", " << axis + 1 << ", " << axis + 1 << "\n";
      }
    }
    job << "*STEP, NLGEOM, INC=1000\n*STATIC\n0.1, 1.\n*CLOAD\n";
    const Eigen::Matrix3Xd& force = std::get<SolidLoadModel>(model.loads[0].on).force;
    for (int i = 0; i < solid.body.nodes(); ++i) {
      for (int axis = 0; axis < 3; ++axis) {
        if (std::abs(force(axis, i)) > 1e-14) job << i + 1 << ", " << axis + 1 << ", " << force(axis, i) << "\n";
      }
    }
    job << "*NODE PRINT, NSET=ALL, FREQUENCY=1000\nU\n*END STEP\n";
  }
  const std::string command = "cd '" + folder.string() + "' && OMP_NUM_THREADS=1 ccx job > job.log 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0);
  Eigen::Matrix3Xd u = Eigen::Matrix3Xd::Constant(3, solid.body.nodes(), NAN);
  std::ifstream data(folder / "job.dat");
  for (std::string line; std::getline(data, line);) {
    std::istringstream words(line);
    int node = 0;
    double x = 0.0, y = 0.0, z = 0.0;
    if (words >> node >> x >> y >> z) u.col(node - 1) << x, y, z;
  }
  EXPECT_TRUE(u.allFinite()) << "see " << folder;
  return u;
}

/// Largest difference of displacements over the largest displacement.
double difference(const Scene& scene, const solid::Mesh& mesh, double young, double poisson, const std::string& name) {
  const SolvedSolid solved = solve(scene, mesh);
  const fs::path folder = fs::temp_directory_path() / ("sinew_calculix_" + name);
  const Eigen::Matrix3Xd theirs = by_calculix(solved.model, young, poisson, folder);
  const Eigen::Matrix3Xd ours = solved.end().solids[0].x - solved.model.solids[0].body.rest;
  const double largest = theirs.colwise().norm().maxCoeff();
  const double off = (ours - theirs).colwise().norm().maxCoeff() / largest;
  std::cout << name << ": largest displacement " << largest * 1e3 << " mm, largest difference " << 100 * off << " %\n";
  if (off < 0.01) fs::remove_all(folder);
  return off;
}

bool there_is_calculix() { return std::system("command -v ccx > /dev/null 2>&1") == 0; }

TEST(CalculiX, bends_a_block_of_every_kind_of_element_likewise) {
  if (!there_is_calculix()) GTEST_SKIP() << "no ccx on the PATH";
  const Vec3 size(60 * mm, 10 * mm, 10 * mm);
  constexpr double young = 500e3;
  for (const auto& [kind, n, poisson] :
       {std::tuple(solid::Kind::tet4, 3, 0.3), {solid::Kind::tet10, 2, 0.0}, {solid::Kind::hex8, 4, 0.0}}) {
    const solid::Mesh mesh = mapped_block(kind, 6 * n, n, n, [&](const Vec3& x) { return Vec3(x.cwiseProduct(size)); });
    Scene scene = solid_scene(solid::saint_venant_kirchhoff(young, poisson));
    hold(scene, plane(Vec3::Zero(), Vec3::UnitX()));
    load_solid(scene, plane(size, Vec3::UnitX()), Vec3(0, 0.1, 0.05));
    EXPECT_LT(difference(scene, mesh, young, poisson,
                         kind == solid::Kind::tet4    ? "block_tet4"
                         : kind == solid::Kind::tet10 ? "block_tet10"
                                                      : "block_hex8"),
              0.01);
  }
}

TEST(CalculiX, bends_the_finger_likewise) {
  if (!there_is_calculix()) GTEST_SKIP() << "no ccx on the PATH";
  solid::Mesh mesh = io::read_mesh(fs::path(SINEW_SOURCE_DIR) / "examples/meshes/finger.vtk");
  constexpr double young = 600e3, poisson = 0.45;
  Scene scene = solid_scene(solid::saint_venant_kirchhoff(young, poisson));
  scene.solids[0].second.scale = 1e-3;
  hold(scene, plane(Vec3::Zero(), Vec3::UnitX()));
  load_solid(scene, plane(Vec3(95 * mm, 0, 0), Vec3::UnitX()), Vec3(0, 0, -0.05));
  EXPECT_LT(difference(scene, mesh, young, poisson, "finger"), 0.01);
}

}  // namespace
}  // namespace sinew::test
