#include "sinew/rod/kinematics.hpp"

#include <Eigen/Dense>
#include <algorithm>

namespace sinew::rod {

namespace {

/// Exponentials one after another from a frame on; returns the last frame.
template <class Sequence>
void walk(const Weights& weights, const Coefficients& strains, Mat3& R, Vec3& p, Sequence& pieces) {
  for (Eigen::Index j = 0; j < weights.rows(); ++j) {
    Vec6 W = weights(j, 0) * strains.col(0);
    for (Eigen::Index d = 1; d < strains.cols(); ++d) W += weights(j, d) * strains.col(d);
    const Piece& piece = pieces.emplace_back(R, p, W);
    p = piece.end();
    R = piece.end_frame();
  }
}

/// Adds the twists of the coordinates of a section that exponential j brings, given its own.
void add_twists(const Section& section, const Weights& weights, Eigen::Index j, const Mat6& own,
                SectionTwists& twists) {
  for (std::size_t c = 0; c < section.modes.size(); ++c) {
    const Mode& mode = section.modes[c];
    twists.col(static_cast<Eigen::Index>(c)) += weights(j, mode.degree) * own.col(mode.strain);
  }
}

}  // namespace

Mat6 piece_twists(const Piece& piece, const Vec3& origin) {
  const Mat3 V = piece.R * piece.tangent().matrix();
  Mat6 twists;
  twists.topLeftCorner<3, 3>() = V;
  twists.topRightCorner<3, 3>().setZero();
  twists.bottomRightCorner<3, 3>() = V;
  twists.bottomLeftCorner<3, 3>() = piece.R * piece.tangent().gradient(piece.rho) + lie::hat(piece.end() - origin) * V;
  return twists;
}

Configuration configure(const Rod& rod, const Placement& base, const Eigen::VectorXd& q) {
  return configure(rod, Base{base, Mat3::Identity()}, q);
}

Configuration configure(const Rod& rod, const Base& base, const Eigen::VectorXd& q) {
  Configuration shape;
  configure(rod, base, q, shape);
  return shape;
}

void reconfigure(const Rod& rod, const Base& base, const Eigen::VectorXd& q, Configuration& shape) {
  const Base& from = shape.from;
  if (shape.rod == &rod && from.rest.R == base.rest.R && from.rest.p == base.rest.p && from.turned == base.turned &&
      shape.q == q)
    return;
  configure(rod, base, q, shape);
}

Placement first_frame(const Rod& rod, const Base& base, const Eigen::VectorXd& q, Matrix6X* twists) {
  Placement first{base.rest.R * base.turned, base.rest.p};
  if (twists) twists->setZero(6, rod.base_coordinates());
  for (int i = 0; i < rod.base_coordinates(); ++i) {
    if (rod.base[i].turns) continue;
    const Vec3 axis = rod.base[i].sign * base.rest.R.col(rod.base[i].axis);
    first.p += q[i] * axis;
    if (twists) twists->col(i).tail<3>() = axis;
  }
  for (int i = 0; i < rod.base_coordinates(); ++i) {  // one after another, each about an axis the earlier ones turned
    if (!rod.base[i].turns) continue;
    const Vec3 axis = rod.base[i].sign * Vec3::Unit(rod.base[i].axis);
    if (twists) {
      twists->col(i).head<3>() = first.R * axis;
      twists->col(i).tail<3>() = (first.p - base.rest.p).cross(Vec3(first.R * axis));
    }
    first.R = first.R * lie::exp(q[i] * axis);
  }
  return first;
}

void configure(const Rod& rod, const Base& base, const Eigen::VectorXd& q, Configuration& shape) {
  shape.rod = nullptr;  // until all is there: memory may run out
  shape.from = base;
  shape.q = q;
  shape.origin = base.rest.p;
  const int N = rod.count();
  auto [R, p] = first_frame(rod, base, q, &shape.base);

  shape.R.clear();
  shape.p.clear();
  shape.strains.clear();
  shape.first_step.clear();
  shape.steps.clear();
  shape.pieces.clear();
  shape.R.reserve(N + 1);
  shape.p.reserve(N + 1);
  shape.R.push_back(R);
  shape.p.push_back(p);
  shape.strains.reserve(N);
  shape.first_step.reserve(N + 1);
  shape.first_step.push_back(0);
  shape.steps.reserve(N);
  shape.pieces.reserve(N);
  shape.twists.resize(6, rod.strain_coordinates());
  for (int i = 0; i < N; ++i) {
    const Section& section = rod.sections[i];
    Coefficients& strains = shape.strains.emplace_back(strain_coefficients(section, rod.of_section(q, i)));
    strains(3, 0) += 1.0;
    SectionTwists twists = SectionTwists::Zero(6, static_cast<Eigen::Index>(section.modes.size()));
    for (const Step& step : section.steps) {
      const std::size_t from = shape.pieces.size();
      shape.steps.push_back({R, p, twists, static_cast<int>(from)});
      walk(step.weights, strains, R, p, shape.pieces);
      for (Eigen::Index j = 0; j < step.weights.rows(); ++j) {
        const Piece& piece = shape.pieces[from + static_cast<std::size_t>(j)];
        add_twists(section, step.weights, j, piece_twists(piece, shape.origin), twists);
      }
    }
    shape.twists.middleCols(rod.first[i], twists.cols()) = twists;
    shape.first_step.push_back(static_cast<int>(shape.steps.size()));
    shape.R.push_back(R);
    shape.p.push_back(p);
  }
  shape.rod = &rod;
}

Branch branch(const Configuration& shape, double s) {
  Branch branch;
  const int i = shape.rod->section_at(s);
  const Section& section = shape.rod->sections[i];
  std::size_t step = 0;
  while (step + 1 < section.steps.size() && s >= section.steps[step].end) ++step;
  branch_in(shape, i, shape.first_step[i] + static_cast<int>(step), s, branch);
  return branch;
}

void branch_in(const Configuration& shape, int i, int step, double s, Branch& branch) {
  const Section& section = shape.rod->sections[i];
  const Coefficients& strains = shape.strains[i];
  branch.section = i;
  branch.step = step;
  partial_weights(section.begin, section.end, static_cast<int>(strains.cols()) - 1,
                  section.steps[static_cast<std::size_t>(step - shape.first_step[i])].begin, s, branch.weights);
  branch.R = shape.steps[step].R;
  branch.p = shape.steps[step].p;
  branch.pieces.clear();
  walk(branch.weights.value, strains, branch.R, branch.p, branch.pieces);
}

void branch_to(const Configuration& shape, const Station& station, Branch& branch) {
  branch.section = station.section;
  branch.step = shape.first_step[station.section] + station.step;
  branch.weights.value = station.weights;
  branch.R = shape.steps[branch.step].R;
  branch.p = shape.steps[branch.step].p;
  branch.pieces.clear();
  walk(station.weights, shape.strains[station.section], branch.R, branch.p, branch.pieces);
}

namespace {

/// gamma_s = R u, so gamma_ss = R (k x u + u').
Vec3 second_derivative(const Section& section, const Coefficients& strains, double s, const Mat3& R) {
  Vec6 xi = strains.col(0);
  Vec3 slope = Vec3::Zero();
  if (strains.cols() > 1) {
    const double x = section.local(s);
    xi = strains * legendre(x).head(strains.cols());
    slope = strains.bottomRows<3>() * legendre_slopes(x).head(strains.cols()) * (2.0 / section.length());
  }
  return R * (xi.head<3>().cross(xi.tail<3>()) + slope);
}

/// From the start of a section of constant strain: one exponential.
Piece piece_to(const Configuration& shape, int i, double s) {
  return {shape.R[i], shape.p[i], (s - shape.rod->sections[i].begin) * shape.strains[i].col(0)};
}

void put_centre(const Configuration& shape, int i, double s, const Piece& piece, CentrePoint& point) {
  const Coefficients& strains = shape.strains[i];
  point.section = i;
  point.position = piece.end();
  point.R = piece.end_frame();
  point.derivative = point.R * strains.col(0).tail<3>();
  point.second = second_derivative(shape.rod->sections[i], strains, s, point.R);
}

CurvePoint curve_point_in(const Configuration& shape, int i, double s) {
  const Section& section = shape.rod->sections[i];
  const Piece piece = piece_to(shape, i, s);
  const Mat6 twists = piece_twists(piece, shape.origin);
  CurvePoint point;
  put_centre(shape, i, s, piece, point);
  point.twists.resize(6, static_cast<Eigen::Index>(section.modes.size()));
  for (Eigen::Index c = 0; c < point.twists.cols(); ++c)
    point.twists.col(c) = (s - section.begin) * twists.col(section.modes[static_cast<std::size_t>(c)].strain);
  return point;
}

}  // namespace

CurvePoint curve_point(const Configuration& shape, double s) {
  const int number = shape.rod->section_at(s);
  if (shape.strains[number].cols() == 1) return curve_point_in(shape, number, s);
  const Branch own = branch(shape, s);
  const Section& section = shape.rod->sections[own.section];
  const Coefficients& strains = shape.strains[own.section];
  CurvePoint point;
  point.section = own.section;
  point.position = own.p;
  point.R = own.R;
  point.twists = shape.steps[own.step].before;
  point.derivative.setZero();
  for (Eigen::Index j = 0; j < own.weights.value.rows(); ++j) {
    const Mat6 twists = piece_twists(own.pieces[static_cast<std::size_t>(j)], shape.origin);
    add_twists(section, own.weights.value, j, twists, point.twists);
    const Vec6 dW = strains * own.weights.first.row(j).head(strains.cols()).transpose();
    point.derivative += moved(twists * dW, own.p - shape.origin);
  }
  point.second = second_derivative(section, strains, s, own.R);
  return point;
}

CentrePoint centre_point(const Configuration& shape, double s) {
  const int i = shape.rod->section_at(s);
  if (shape.strains[i].cols() > 1) return static_cast<const CentrePoint&>(curve_point(shape, s));
  CentrePoint point;
  put_centre(shape, i, s, piece_to(shape, i, s), point);
  return point;
}

Vec3 position(const Configuration& shape, double s, const Vec3& offset) {
  const int i = shape.rod->section_at(s);
  if (shape.strains[i].cols() == 1) {
    const Piece piece = piece_to(shape, i, s);
    return piece.end() + piece.R * (piece.exponential() * offset);
  }
  const Branch own = branch(shape, s);
  return own.p + own.R * offset;
}

Eigen::Matrix3Xd mass_positions(const Configuration& shape) {
  Eigen::Matrix3Xd positions;
  mass_positions(shape, positions);
  return positions;
}

double longest_exponential(const Coefficients& strains) {
  return strains.cols() > 1 ? 0.0 : kLargestTurn / std::max(strains.col(0).head<3>().norm(), 1e-300);
}

namespace {

Beginning beginning(const Mat3& R, const Vec3& p, const Coefficients& strains) {
  Beginning from;
  Eigen::Map<Mat3>(&from.R[0][0]) = R;
  Eigen::Map<Vec3>(from.p) = p;
  Eigen::Map<Vec3>(from.rotation) = strains.col(0).head<3>();
  Eigen::Map<Vec3>(from.translation) = strains.col(0).tail<3>();
  return from;
}

}  // namespace

void mass_positions(const Configuration& shape, Eigen::Matrix3Xd& positions) {
  const Rod& rod = *shape.rod;
  positions.resize(3, static_cast<Eigen::Index>(rod.masses.size()));
  const auto place = [&](const Station& station, const Mat3& R, const Vec3& p) {
    for (int i = station.first_mass; i < station.first_mass + station.masses; ++i)
      positions.col(i) = p + R * rod.masses[static_cast<std::size_t>(i)].offset;
  };
  const RodKernels& kernels = rod_kernels();
  Eight length;
  Reached reached;
  Branch own;
  for (std::size_t k = 0; k < rod.stations.size();) {
    const Station& first = rod.stations[k];
    const Configuration::StepStart& start = shape.steps[shape.first_step[first.section] + first.step];
    const Coefficients& strains = shape.strains[first.section];
    const double longest = longest_exponential(strains);
    int count = 0;
    for (; count < kLanes && k + count < rod.stations.size(); ++count) {
      const Station& station = rod.stations[k + count];
      if (station.section != first.section || !(station.weights(0, 0) < longest)) break;
      length[count] = station.weights(0, 0);
    }
    if (count == 0) {
      branch_to(shape, first, own);
      place(first, own.R, own.p);
      ++k;
      continue;
    }
    std::fill(length + count, length + kLanes, 0.0);
    kernels.reach(beginning(start.R, start.p, strains), length, count, reached);
    for (int i = 0; i < count; ++i, ++k) {
      Mat3 R;
      Vec3 p;
      for (int c = 0; c < 3; ++c) {
        p[c] = reached.p[c][i];
        for (int r = 0; r < 3; ++r) R(r, c) = reached.R[c][r][i];
      }
      place(rod.stations[k], R, p);
    }
  }
}

Matrix6X twists_at(const Configuration& shape, double s) {
  const Rod& rod = *shape.rod;
  const CurvePoint point = curve_point(shape, s);
  const int nb = rod.base_coordinates(), own = rod.first[point.section];
  Matrix6X twists = Matrix6X::Zero(6, rod.coordinates());
  twists.leftCols(nb) = shape.base;
  twists.middleCols(nb, own) = shape.twists.leftCols(own);
  twists.middleCols(nb + own, point.twists.cols()) = point.twists;
  return twists;
}

Eigen::Matrix3Xd position_jacobian(const Configuration& shape, double s, const Vec3& offset) {
  const Matrix6X twists = twists_at(shape, s);
  return twists.bottomRows<3>() - lie::hat(position(shape, s, offset) - shape.origin) * twists.topRows<3>();
}

}  // namespace sinew::rod
