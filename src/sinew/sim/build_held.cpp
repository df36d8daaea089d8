// Whether what holds a solid leaves it a rigid motion.
#include <Eigen/Dense>
#include <algorithm>

#include "sinew/sim/building.hpp"
#include "sinew/sim/contact_places.hpp"
#include "sinew/solid/mesh_pieces.hpp"

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
FreeMotions free_motions(const SolidModel& solid, const std::vector<int>& nodes) {
  const solid::Body& body = solid.body;
  const auto holds = [&](int axis, int node) {
    return body.unknown(axis, node) < 0 || (solid.springs.size() > 0 && solid.springs(axis, node) > 0.0);
  };
  FreeMotions free;
  Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
  const Vec3 middle_at_rest = body.rest(Eigen::all, nodes).rowwise().mean();
  Eigen::Matrix3d mean = middle_at_rest.replicate<1, 3>();  // a column an axis
  int count = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<Vec3> held;
    for (const int node : nodes) {
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

/// "its piece of 96 cells about [0.03, 0.005, 0.005] m", or "it" if there is but one.
std::string piece_in_words(const SolidModel& solid, const solid::Pieces& pieces, int piece,
                           const std::vector<int>& nodes) {
  if (pieces.count == 1) return "it";
  const auto cells = std::count(pieces.of_cell.begin(), pieces.of_cell.end(), piece);
  const Vec3 middle = solid.body.rest(Eigen::all, nodes).rowwise().mean();
  return "its piece of " + std::to_string(cells) + " cells about " + text(middle) + " m";
}

/// The pieces that what holds a solid leaves a motion.
struct FreePieces {
  int count = 0;
  int worst = -1;          ///< the first that no coupling holds either, or the first
  bool coupled = false;    ///< it is
  std::vector<int> nodes;  ///< of it
  FreeMotions motions;     ///< its
};

/// Per piece of a solid: whether a coupling holds it.
std::vector<bool> coupled_pieces(const Model& model, int number, const solid::Pieces& pieces) {
  std::vector<bool> coupled(static_cast<std::size_t>(pieces.count), false);
  const auto mark = [&](int solid, const solid::EmbeddedPoint& where) {
    if (solid != number) return;
    coupled[static_cast<std::size_t>(pieces.of_cell[static_cast<std::size_t>(where.element)])] = true;
  };
  for (const PointModel& point : model.points) mark(point.solid, point.where);
  for (const SolidRow& row : model.solid_rows) mark(row.solid, row.where);
  return coupled;
}

FreePieces free_pieces(const Model& model, int number, const solid::Pieces& pieces) {
  const SolidModel& solid = model.solids[number];
  std::vector<std::vector<int>> nodes(static_cast<std::size_t>(pieces.count));
  for (int node = 0; node < solid.body.nodes(); ++node)
    nodes[static_cast<std::size_t>(pieces.of_node[static_cast<std::size_t>(node)])].push_back(node);
  const std::vector<bool> coupled = coupled_pieces(model, number, pieces);
  FreePieces found;
  for (int piece = 0; piece < pieces.count; ++piece) {
    std::vector<int>& own = nodes[static_cast<std::size_t>(piece)];
    FreeMotions free = free_motions(solid, own);
    if (free.none()) continue;
    const bool held = coupled[static_cast<std::size_t>(piece)];
    if (found.count++ > 0 && !(found.coupled && !held)) continue;
    found.worst = piece;
    found.coupled = held;
    found.nodes = std::move(own);
    found.motions = std::move(free);
  }
  return found;
}

}  // namespace

void check_held(Model& model, int number) {
  if (in_a_pair(model, {Collider::Kind::solid, number})) return;  // it is there to be touched
  const SolidModel& solid = model.solids[number];
  const solid::Pieces pieces = solid::find_pieces(solid.body.cells, solid.body.nodes());
  const FreePieces free = free_pieces(model, number, pieces);
  if (free.count == 0) return;
  const std::string path = "solids." + solid.name, motions = in_words(free.motions, solid.mesh.diagonal),
                    more = free.count > 1 ? " (and " + std::to_string(free.count - 1) + " pieces more)" : "",
                    what = piece_in_words(solid, pieces, free.worst, free.nodes) + more;
  if (free.coupled || model.scene.analysis == Analysis::dynamic) {
    model.warnings.push_back({.code = "solid_free",
                              .where = path,
                              .message = "what is fixed and its springs leave " + what + " free to " + motions +
                                         (free.coupled ? ", but for its couplings" : "")});
    return;
  }
  const std::size_t same = solid::coincident_nodes(solid.body.rest, solid.body.cells).size();
  reject(path + ".fixed", std::to_string(solid.held()) + " coordinates",
         (pieces.count == 1 ? "the body" : what) + " is free to " + motions +
             (same > 0
                  ? "; " + std::to_string(same) + " nodes of the mesh are at the place of another and not joined to it"
                  : ""),
         same > 0 ? "join the nodes at the same place in the program that writes the mesh, or hold it by a region of "
                    "`fixed`, or `springs`"
                  : "add a region to `fixed`, or `springs`, that hold it there");
}

}  // namespace sinew::building
