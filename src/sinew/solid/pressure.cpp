#include "sinew/solid/pressure.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <map>

#include "sinew/lie/rotation.hpp"

namespace sinew::solid {

namespace {

Face kind_of(const CellFace& face) { return {static_cast<int>(face.corners().size()), face.count, {0, 1, 2, 3, 4, 5}}; }

Eigen::Matrix3Xd at_nodes(const CellFace& face, const Eigen::Matrix3Xd& x) {
  Eigen::Matrix3Xd own(3, face.count);
  for (int i = 0; i < face.count; ++i) own.col(i) = x.col(face.node[static_cast<std::size_t>(i)]);
  return own;
}

/// Visits the face's quadrature points with the area vector each stands for, along the normal, and N there.
template <class Visit>
void each_area(const CellFace& face, const Eigen::Matrix3Xd& x, const Visit& visit) {
  const Face kind = kind_of(face);
  const Eigen::Matrix3Xd own = at_nodes(face, x);
  for (const FacePoint& point : face_quadrature(kind)) {
    const Eigen::Matrix<double, 3, 2> tangents = own * face_slopes(kind, point.xi).transpose();
    visit(Vec3(point.weight * tangents.col(0).cross(tangents.col(1))), face_functions(kind, point.xi));
  }
}

}  // namespace

FaceValues face_shares(const CellFace& face, const Eigen::Matrix3Xd& x) {
  FaceValues shares = FaceValues::Zero(face.count);
  each_area(face, x, [&](const Vec3& area, const FaceValues& N) { shares += area.norm() * N; });
  return shares;
}

FaceValues lumped_face_shares(const CellFace& face, const Eigen::Matrix3Xd& x) {
  FaceValues shares = FaceValues::Zero(face.count);
  double total = 0.0;
  each_area(face, x, [&](const Vec3& area, const FaceValues& N) {
    shares += area.norm() * N.cwiseAbs2();
    total += area.norm();
  });
  return shares * (total / shares.sum());
}

Eigen::Matrix3Xd pressure_force(const CellFace& face, double p, const Eigen::Matrix3Xd& x) {
  Eigen::Matrix3Xd force = Eigen::Matrix3Xd::Zero(3, face.count);
  each_area(face, x, [&](const Vec3& area, const FaceValues& N) { force -= p * area * N.transpose(); });
  return force;
}

Eigen::MatrixXd pressure_tangent(const CellFace& face, double p, const Eigen::Matrix3Xd& x) {
  const Face kind = kind_of(face);
  const Eigen::Matrix3Xd own = at_nodes(face, x);
  Eigen::MatrixXd K = Eigen::MatrixXd::Zero(3 * face.count, 3 * face.count);
  for (const FacePoint& point : face_quadrature(kind)) {
    const FaceSlopes slopes = face_slopes(kind, point.xi);
    const FaceValues N = face_functions(kind, point.xi);
    const Eigen::Matrix<double, 3, 2> tangents = own * slopes.transpose();
    const Mat3 first = lie::hat(tangents.col(0)), second = lie::hat(tangents.col(1));
    for (int b = 0; b < face.count; ++b) {
      const Mat3 turned = p * point.weight * (slopes(1, b) * first - slopes(0, b) * second);
      for (int a = 0; a < face.count; ++a) K.block<3, 3>(3 * a, 3 * b) += N[a] * turned;
    }
  }
  return K;
}

std::vector<Edge> rim(const std::vector<CellFace>& faces) {
  // An edge with another middle is another curve.
  std::map<std::array<int, 3>, int> found;  // ends in ascending order and middle; how often it runs up, less down
  for (const CellFace& face : faces) {
    const std::span<const int> corner = face.corners();
    for (std::size_t i = 0; i < corner.size(); ++i) {
      const int a = corner[i], b = corner[(i + 1) % corner.size()], middle = face.count == 6 ? face.node[3 + i] : -1;
      found[{std::min(a, b), std::max(a, b), middle}] += a < b ? 1 : -1;
    }
  }
  std::vector<Edge> edges;
  for (const auto& [node, turns] : found) {
    if (turns != 0) edges.push_back({node, node[2] < 0 ? 2 : 3});
  }
  return edges;
}

}  // namespace sinew::solid
