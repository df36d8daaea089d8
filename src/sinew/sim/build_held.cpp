// Whether what holds a solid leaves it a rigid motion.
#include <Eigen/Dense>
#include <algorithm>

#include "sinew/sim/building.hpp"
#include "sinew/sim/contact_places.hpp"

namespace sinew::building {

namespace {

/// Of singular values, with lengths in units of the body: less is rounding, of mesh files too.
constexpr double kFree = 1e-6;

struct Turn {
  Vec3 axis, through;  ///< through [m]
};

/// Rigid motions at rest that move no held coordinate and no spring.
struct FreeMotions {
  std::vector<int> along;  ///< axes of the world
  std::vector<Turn> about;
  bool none() const { return along.empty() && about.empty(); }
};

/// A basis of the null space of a symmetric matrix, of vectors as near to the axes as it has.
std::vector<Vec3> null_space(const Eigen::Matrix3d& S, double least) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solved(S);
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();  // the projection on what is left of it
  int left = 0;
  for (int i = 0; i < 3; ++i) {
    if (solved.eigenvalues()[i] > least) continue;
    P += solved.eigenvectors().col(i) * solved.eigenvectors().col(i).transpose();
    ++left;
  }
  std::vector<Vec3> basis;
  for (; left > 0; --left) {
    Eigen::Index nearest = 0;
    P.diagonal().maxCoeff(&nearest);
    const Vec3 n = P.col(nearest).normalized();
    basis.push_back(n);
    P -= n * n.transpose();
  }
  return basis;
}

/// A motion t + w x r moves the coordinate along e_a of a node at r by t_a + w . (r x e_a). What is held along an axis
/// lets the body move along it or not at all; with r from the mean of what is held along each axis, the turns that t
/// can make up for are the null space of the Gram matrix of the r x e_a.
FreeMotions free_motions(const SolidModel& solid) {
  const solid::Body& body = solid.body;
  const auto holds = [&](int axis, int node) {
    return body.unknown(axis, node) < 0 || (solid.springs.size() > 0 && solid.springs(axis, node) > 0.0);
  };
  FreeMotions free;
  Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d mean = body.rest.rowwise().mean().replicate<1, 3>();  // a column an axis
  int count = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Vec3> held;
    for (int node = 0; node < body.nodes(); ++node) {
      if (holds(axis, node)) held.emplace_back(body.rest.col(node));
    }
    if (held.empty()) {
      free.along.push_back(axis);
      continue;
    }
    mean.col(axis).setZero();
    for (const Vec3& x : held) mean.col(axis) += x / static_cast<double>(held.size());
    for (const Vec3& x : held) {
      const Vec3 row = (x - mean.col(axis)).cross(Vec3::Unit(axis)) / solid.mesh.diagonal;
      S += row * row.transpose();
    }
    count += static_cast<int>(held.size());
  }
  const Vec3 middle = mean.rowwise().mean();
  for (const Vec3& w : null_space(S, kFree * kFree * std::max(count, 1))) {
    Vec3 t;  // of the middle
    for (int axis = 0; axis < 3; ++axis) t[axis] = -w.dot((mean.col(axis) - middle).cross(Vec3::Unit(axis)));
    free.about.push_back({w, middle + w.cross(t)});
  }
  return free;
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " and " : ", ";
    text += words[i];
  }
  return text;
}

/// "move along x and y and turn about [0, 0, 1] through [0, 0, 0.1] m".
std::string in_words(const FreeMotions& free, double size) {
  if (free.along.size() + free.about.size() == 6) return "move and turn every way";
  const auto clean = [](const Vec3& v, double unit) {
    return text(Vec3(v.unaryExpr([unit](double value) { return std::abs(value) < kFree * unit ? 0.0 : value; })));
  };
  std::vector<std::string> along, about, both;
  for (const int axis : free.along) along.emplace_back(1, "xyz"[axis]);
  for (const auto& [axis, through] : free.about)
    about.push_back(clean(axis, 1.0) + " through " + clean(through, size) + " m");
  if (!along.empty()) both.push_back("move along " + joined(along));
  if (!about.empty()) both.push_back("turn about " + joined(about));
  return joined(both);
}

}  // namespace

void check_held(Model& model, int number) {
  const SolidModel& solid = model.solids[number];
  const FreeMotions free = free_motions(solid);
  if (free.none()) return;
  if (in_a_pair(model, {Collider::Kind::solid, number})) return;  // it is there to be touched
  const std::string path = "solids." + solid.name, motions = in_words(free, solid.mesh.diagonal);
  const bool coupled =
      std::any_of(model.points.begin(), model.points.end(), [&](const PointModel& p) { return p.solid == number; }) ||
      std::any_of(model.solid_rows.begin(), model.solid_rows.end(),
                  [&](const SolidRow& row) { return row.solid == number; });
  if (coupled || model.scene.analysis == Analysis::dynamic) {
    model.warnings.push_back({.code = "solid_free",
                              .where = path,
                              .message = "what is fixed and its springs leave it free to " + motions +
                                         (coupled ? ", but for its couplings" : "")});
    return;
  }
  reject(path + ".fixed", std::to_string(solid.held()) + " coordinates", "the body is free to " + motions,
         "add a region to `fixed`, or `springs`, that hold it there");
}

}  // namespace sinew::building
