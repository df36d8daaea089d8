#include "sinew/solid/body.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "sinew/solid/invariants.hpp"

namespace sinew::solid {

ElementRest Body::element(int cell) const {
  const auto e = static_cast<std::size_t>(cell);
  const int points = first_point[e + 1] - first_point[e];
  const double* gradient = gradients.data() + 3 * static_cast<std::ptrdiff_t>(first_gradient[e]);
  return {cells[e].kind,
          Eigen::Map<const Eigen::Matrix3Xd>(gradient, 3, points * node_count(cells[e].kind)),
          {volumes.data() + first_point[e], static_cast<std::size_t>(points)}};
}

namespace {

/// Gradients and volumes at the quadrature points of all cells.
void add_quadrature(Body& body) {
  int points = 0, columns = 0;
  for (const Cell& cell : body.cells) {
    body.first_point.push_back(points);
    body.first_gradient.push_back(columns);
    points += static_cast<int>(quadrature(cell.kind).size());
    columns += static_cast<int>(quadrature(cell.kind).size()) * node_count(cell.kind);
  }
  body.first_point.push_back(points);
  body.gradients.resize(3, columns);
  body.volumes.reserve(static_cast<std::size_t>(points));
  for (int e = 0; e < body.elements(); ++e) {
    const Cell& cell = body.cells[static_cast<std::size_t>(e)];
    const NodeVectors X = body.at_nodes(e, body.rest);
    Eigen::Index column = body.first_gradient[static_cast<std::size_t>(e)];
    for (const GaussPoint& point : quadrature(cell.kind)) {
      const NodeVectors slopes = shape_slopes(cell.kind, point.xi);
      const Mat3 jacobian = X * slopes.transpose();  // dX / dxi
      body.gradients.middleCols(column, X.cols()) = jacobian.inverse().transpose() * slopes;
      body.volumes.push_back(point.weight * jacobian.determinant());
      column += X.cols();
    }
  }
}

/// rho int N_a N_b dV of a cell; lumped, its diagonal raised to the cell's mass (always positive).
Eigen::MatrixXd cell_mass(const Body& body, int e, MassMatrix kind) {
  const Cell& cell = body.cells[static_cast<std::size_t>(e)];
  const NodeVectors X = body.at_nodes(e, body.rest);
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(X.cols(), X.cols());
  double volume = 0.0;
  for (const GaussPoint& point : mass_quadrature(cell.kind)) {
    const Mat3 jacobian = X * shape_slopes(cell.kind, point.xi).transpose();
    const NodeValues N = shape_functions(cell.kind, point.xi);
    const double weight = point.weight * jacobian.determinant();
    M += weight * N * N.transpose();
    volume += weight;
  }
  if (kind == MassMatrix::lumped) M = Eigen::MatrixXd((M.diagonal() * volume / M.trace()).asDiagonal());
  return body.of(e).density * M;
}

void add_mass(Body& body, MassMatrix kind, std::optional<double> total) {
  std::vector<Eigen::Triplet<double>> entries;
  double sum = 0.0;
  for (int e = 0; e < body.elements(); ++e) {
    const Eigen::MatrixXd M = cell_mass(body, e, kind);
    const std::span<const int> nodes = body.cells[static_cast<std::size_t>(e)].nodes();
    for (Eigen::Index b = 0; b < M.cols(); ++b) {
      for (Eigen::Index a = 0; a < M.rows(); ++a) {
        if (a != b && kind == MassMatrix::lumped) continue;
        entries.emplace_back(nodes[static_cast<std::size_t>(a)], nodes[static_cast<std::size_t>(b)], M(a, b));
      }
    }
    sum += M.sum();
  }
  body.mass.resize(body.nodes(), body.nodes());
  body.mass.setFromTriplets(entries.begin(), entries.end());
  if (total && sum > 0.0) body.mass *= *total / sum;
  body.masses = body.mass * Eigen::VectorXd::Ones(body.nodes());
}

/// Nodes of an element of a batch, in an order of its own.
void set_nodes(TetBatch& batch, int i, const Cell& cell, const ElementRest& rest, const std::array<int, 4>& order) {
  for (int a = 0; a < 4; ++a) {
    const int own = order[static_cast<std::size_t>(a)];
    batch.node[a][i] = cell.node[static_cast<std::size_t>(own)];
    for (int axis = 0; a < 3 && axis < 3; ++axis) batch.gradient[a][axis][i] = rest.gradients_at(0)(axis, own);
  }
}

/// Gathers the linear tetrahedra of the corotational law.
void add_batches(Body& body) {
  for (int e = 0; e < body.elements(); ++e) {
    const Corotational* const law = std::get_if<Corotational>(&body.of(e).law);
    if (body.cells[static_cast<std::size_t>(e)].kind != Kind::tet4 || !law) {
      body.others.push_back(e);
      continue;
    }
    if (body.batches.empty() || body.batches.back().count == kBatch) body.batches.emplace_back();
    TetBatch& batch = body.batches.back();
    const int i = batch.count++;
    const ElementRest rest = body.element(e);
    const double volume = rest.volumes[0];
    set_nodes(batch, i, body.cells[static_cast<std::size_t>(e)], rest, {0, 1, 2, 3});
    batch.mu[i] = volume * law->moduli.mu;
    batch.lambda[i] = volume * law->moduli.lambda;
    batch.viscous_mu[i] = volume * body.of(e).viscosity.mu;
    batch.viscous_lambda[i] = volume * body.of(e).viscosity.lambda;
    batch.cell[i] = e;
  }
}

}  // namespace

Body make_body(Eigen::Matrix3Xd rest, std::vector<Cell> cells, std::vector<Material> materials,
               std::vector<int> material, const Eigen::Array<bool, 3, Eigen::Dynamic>& held, MassMatrix kind,
               std::optional<double> total) {
  Body body;
  body.rest = std::move(rest);
  body.cells = std::move(cells);
  body.materials = std::move(materials);
  body.material = std::move(material);
  add_quadrature(body);
  add_mass(body, kind, total);
  add_batches(body);
  body.unknown.resize(3, body.nodes());
  for (Eigen::Index node = 0; node < body.unknown.cols(); ++node) {
    for (int axis = 0; axis < 3; ++axis) body.unknown(axis, node) = held(axis, node) ? -1 : body.unknowns++;
    if (held.col(node).any()) body.held_nodes.push_back(static_cast<int>(node));
  }
  return body;
}

void sort_batches(Body& body, const std::vector<int>& rank) {
  for (TetBatch& batch : body.batches) {
    for (int i = 0; i < batch.count; ++i) {
      const Cell& cell = body.cells[static_cast<std::size_t>(batch.cell[i])];
      std::array<int, 4> order = {0, 1, 2, 3};
      std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
        return rank[static_cast<std::size_t>(cell.node[static_cast<std::size_t>(a)])] <
               rank[static_cast<std::size_t>(cell.node[static_cast<std::size_t>(b)])];
      });
      set_nodes(batch, i, cell, body.element(batch.cell[i]), order);
    }
  }
}

namespace {

/// Visits the runs of nodes between those that are held, (first node, their number), and then these, (node).
template <class Free, class Held>
void each_run(const Body& body, const Free& free, const Held& held) {
  int from = 0;
  const auto visit = [&](int end) {
    if (end > from) free(from, end - from);
    from = end + 1;
  };
  for (const int node : body.held_nodes) {
    visit(node);
    held(node);
  }
  visit(body.nodes());
}

}  // namespace

void at_unknowns(const Body& body, const Eigen::Matrix3Xd& nodal, Eigen::VectorXd& u) {
  u.resize(body.unknowns);
  each_run(
      body, [&](int node, int count) { std::copy_n(&nodal(0, node), 3 * count, &u[body.unknown(0, node)]); },
      [&](int node) {
        for (int axis = 0; axis < 3; ++axis) {
          if (const int own = body.unknown(axis, node); own >= 0) u[own] = nodal(axis, node);
        }
      });
}

void from_unknowns(const Body& body, const Eigen::VectorXd& u, Eigen::Matrix3Xd& nodal) {
  nodal.resize(3, body.nodes());
  each_run(
      body, [&](int node, int count) { std::copy_n(&u[body.unknown(0, node)], 3 * count, &nodal(0, node)); },
      [&](int node) {
        for (int axis = 0; axis < 3; ++axis) {
          const int own = body.unknown(axis, node);
          nodal(axis, node) = own >= 0 ? u[own] : 0.0;
        }
      });
}

namespace {

using Records = Eigen::Map<Eigen::Matrix<double, kRecord, Eigen::Dynamic>>;
Records records(linalg::AlignedVector<double>& numbers) {
  return {numbers.data(), kRecord, static_cast<Eigen::Index>(numbers.size()) / kRecord};
}
/// A vector in a node's record.
Eigen::Map<const Vec3> elastic_of(const linalg::AlignedVector<double>& forces, Eigen::Index node) {
  return Eigen::Map<const Vec3>(forces.data() + kRecord * node);
}
Eigen::Map<const Vec3> viscous_of(const linalg::AlignedVector<double>& forces, Eigen::Index node) {
  return Eigen::Map<const Vec3>(forces.data() + kRecord * node + kRecord / 2);
}

/// Visits the cells of a batch that have no rotation.
template <class Visit>
void each_missing(const TetBatch& batch, const TetFrames& frames, const Visit& visit) {
  if (frames.missing == 0) return;
  for (int i = 0; i < batch.count; ++i) {
    if (frames.missing >> i & 1U) visit(batch.cell[i]);
  }
}

bool viscous(const Body& body, int e) {
  const Lame& moduli = body.of(e).viscosity;
  return moduli.mu > 0.0 || moduli.lambda != 0.0;
}

/// Elastic and, where `start` moves, viscous forces of the elements that no batch has evaluated; none: no numbers.
void add_others(const Body& body, const StepStart& start, const Eigen::Matrix3Xd& x, const Deformation& deformation,
                linalg::AlignedVector<double>& forces) {
  forces.clear();
  ElementResponse response;
  const auto add = [&](int e) {
    if (forces.empty()) forces.resize(kRecord * static_cast<std::size_t>(body.nodes()), 0.0);
    const auto scatter = [&](Eigen::Index first) {
      const std::span<const int> nodes = body.cells[static_cast<std::size_t>(e)].nodes();
      for (std::size_t i = 0; i < nodes.size(); ++i)
        records(forces).col(nodes[i]).segment<3>(first) += response.force.col(static_cast<Eigen::Index>(i));
    };
    evaluate(body.of(e).law, body.element(e), body.at_nodes(e, x), Derivatives::first, Tangent::exact, response);
    scatter(0);
    if (start.rate == 0.0 || !viscous(body, e)) return;
    response.force.setZero(3, body.element(e).nodes());
    add_viscosity(body.of(e).viscosity, start.rate, body.element(e), body.at_nodes(e, start.x), body.at_nodes(e, x),
                  Derivatives::first, Tangent::exact, response);
    scatter(kRecord / 2);
  };
  for (std::size_t k = 0; k < body.batches.size(); ++k) each_missing(body.batches[k], deformation.frames[k], add);
  for (const int e : body.others) add(e);
}

}  // namespace

void deform(const Body& body, const StepStart& start, const Eigen::Matrix3Xd& x, Deformation& deformation) {
  const int n = body.nodes();
  const auto size = kRecord * static_cast<std::size_t>(n + 1);
  deformation.nodes.resize(size, 0.0);
  deformation.forces.assign(size, 0.0);
  deformation.frames.resize(body.batches.size());
  if (body.batches.empty()) return;
  auto nodes = records(deformation.nodes);
  for (int node = 0; node < n; ++node) {
    nodes.col(node).head<3>() = x.col(node);
    nodes.col(node).segment<3>(kRecord / 2) =
        start.rate > 0.0 ? Vec3(x.col(node) - start.x.col(node)) : Vec3(Vec3::Zero());
  }
  tet_kernels().add_forces(body.batches.data(), static_cast<int>(body.batches.size()), deformation.nodes.data(),
                           start.rate, n, deformation.frames.data(), deformation.forces.data());
}

Eigen::Matrix3Xd elastic_force(const Body& body, const Eigen::Matrix3Xd& x) {
  const StepStart still{x, x};  // (without a rate neither counts)
  Deformation deformation;
  deform(body, still, x, deformation);
  linalg::AlignedVector<double> others;
  add_others(body, still, x, deformation, others);
  Eigen::Matrix3Xd force = records(deformation.forces).topLeftCorner(3, body.nodes());
  if (!others.empty()) force += records(others).topRows<3>();
  return force;
}

double kinetic_energy(const Body& body, const Eigen::Matrix3Xd& v) { return 0.5 * v.cwiseProduct(v * body.mass).sum(); }

double elastic_energy(const Body& body, const Eigen::Matrix3Xd& x) {
  double energy = 0.0;
  ElementResponse response;
  for (int e = 0; e < body.elements(); ++e) {
    evaluate(body.of(e).law, body.element(e), body.at_nodes(e, x), Derivatives::none, Tangent::exact, response);
    energy += response.energy;
  }
  return energy;
}

void residual(const Body& body, const StepStart& start, const Eigen::Matrix3Xd& x, const Deformation& deformation,
              const Vec3& gravity, Residual& residual) {
  const int n = body.nodes();
  add_others(body, start, x, deformation, residual.others);
  const double factor = mass_factor(body, start.rate);
  residual.sum.resize(3, n);
  if (start.rate > 0.0) residual.acceleration = factor * (x - start.x) - start.rate * start.v;
  Eigen::Array4d largest = Eigen::Array4d::Zero();  // of each kind, squared
  for (int b = 0; b < n; ++b) {
    Vec3 inertia = Vec3::Zero();
    if (start.rate > 0.0) {
      for (Eigen::SparseMatrix<double>::InnerIterator at(body.mass, b); at; ++at)
        inertia += at.value() * residual.acceleration.col(at.row());
    }
    const Vec3 weight = body.masses[b] * gravity;
    Vec3 elastic = elastic_of(deformation.forces, b), viscous = viscous_of(deformation.forces, b);
    if (!residual.others.empty()) {
      elastic += elastic_of(residual.others, b);
      viscous += viscous_of(residual.others, b);
    }
    residual.sum.col(b) = inertia + elastic + viscous - weight;
    largest = largest.max(
        Eigen::Array4d(inertia.squaredNorm(), elastic.squaredNorm(), viscous.squaredNorm(), weight.squaredNorm()));
  }
  residual.scale = std::sqrt(largest.maxCoeff());
}

void assemble_tangent(const Body& body, const StepStart& start, const Eigen::Matrix3Xd& x,
                      const Deformation& deformation, Tangent kind, const InsertElement& insert,
                      const InsertBatch& insert_batch) {
  ElementResponse response;
  const auto add = [&](int e) {
    evaluate(body.of(e).law, body.element(e), body.at_nodes(e, x), Derivatives::second, kind, response);
    if (start.rate > 0.0 && viscous(body, e))
      add_viscosity(body.of(e).viscosity, start.rate, body.element(e), body.at_nodes(e, start.x), body.at_nodes(e, x),
                    Derivatives::second, kind, response);
    insert(e, response.stiffness);
  };
  const TetKernels& kernels = tet_kernels();
  TetStiffness stiffness;
  for (std::size_t k = 0; k < body.batches.size(); ++k) {
    const TetBatch& batch = body.batches[k];
    const TetFrames& frames = deformation.frames[k];
    if (kind == Tangent::definite) {
      kernels.definite(batch, frames, start.rate, stiffness);
    } else {
      kernels.exact(batch, frames, deformation.nodes.data(), start.rate, stiffness);
    }
    insert_batch(batch, stiffness, frames.missing);
    each_missing(batch, frames, add);
  }
  for (const int e : body.others) add(e);
}

double mass_factor(const Body& body, double rate) { return (rate + body.damping_mass) * rate; }

std::vector<int> ended_cells(const Body& body, const Eigen::Matrix3Xd& x) {
  std::vector<int> ended;
  ElementResponse response;
  for (int e = 0; e < body.elements(); ++e) {
    evaluate(body.of(e).law, body.element(e), body.at_nodes(e, x), Derivatives::none, Tangent::exact, response);
    if (!std::isfinite(response.energy)) ended.push_back(e);
  }
  return ended;
}

std::vector<int> folded_cells(const Body& body, const Eigen::Matrix3Xd& x) {
  std::vector<int> folded;
  // Of a linear tetrahedron det F is the ratio of its volumes.
  const auto volume = [](const Cell& cell, const Eigen::Matrix3Xd& at) {
    const Vec3 from = at.col(cell.node[0]);
    const Vec3 d = at.col(cell.node[1]) - from, e = at.col(cell.node[2]) - from;
    return d.cross(e).dot(at.col(cell.node[3]) - from);
  };
  for (int e = 0; e < body.elements(); ++e) {
    const Cell& cell = body.cells[static_cast<std::size_t>(e)];
    if (cell.kind == Kind::tet4) {
      const double at_rest = body.volumes[static_cast<std::size_t>(body.first_point[static_cast<std::size_t>(e)])];
      if (!(volume(cell, x) * at_rest > 0.0)) folded.push_back(e);
      continue;
    }
    const ElementRest rest = body.element(e);
    const NodeVectors own = body.at_nodes(e, x);
    for (std::size_t q = 0; q < rest.volumes.size(); ++q) {
      if (deformation_gradient(rest, q, own).determinant() > 0.0) continue;
      folded.push_back(e);
      break;
    }
  }
  return folded;
}

namespace {

Mat3 symmetric(const Mat3& m) { return 0.5 * (m + m.transpose()); }

}  // namespace

CellMeans cell_means(const Body& body, int cell, const Eigen::Matrix3Xd& x) {
  const ElementRest rest = body.element(cell);
  const NodeVectors own = body.at_nodes(cell, x);
  const ElementStress stress(body.of(cell).law, rest, own);
  Mat3 kirchhoff = Mat3::Zero(), strain = Mat3::Zero();
  double before = 0.0, now = 0.0, least = INFINITY;
  for (std::size_t q = 0; q < rest.volumes.size(); ++q) {
    const Mat3 F = deformation_gradient(rest, q, own);
    least = std::min(least, F.determinant());
    kirchhoff += rest.volumes[q] * stress(F) * F.transpose();
    strain += rest.volumes[q] * green_strain(F);
    before += rest.volumes[q];
    now += rest.volumes[q] * F.determinant();
  }
  return {now > 0.0 ? symmetric(kirchhoff / now) : Mat3::Constant(NAN), strain / before, now / before, least};
}

namespace {

Mat3 gradient_at(const Body& body, const EmbeddedPoint& point, const Eigen::Matrix3Xd& x) {
  const Cell& cell = body.cells[static_cast<std::size_t>(point.element)];
  return cell_nodes(x, cell) * gradients(body.rest, cell, point.local).transpose();
}

}  // namespace

Mat3 cauchy_stress(const Body& body, const EmbeddedPoint& point, const Eigen::Matrix3Xd& x) {
  const int cell = point.element;
  const Mat3 F = gradient_at(body, point, x);
  const ElementStress stress(body.of(cell).law, body.element(cell), body.at_nodes(cell, x));
  return F.determinant() > 0.0 ? symmetric(cauchy_stress(stress(F), F)) : Mat3::Constant(NAN);
}

Mat3 green_strain(const Body& body, const EmbeddedPoint& point, const Eigen::Matrix3Xd& x) {
  return green_strain(gradient_at(body, point, x));
}

Vec3 principal_values(const Mat3& tensor) {
  return Eigen::SelfAdjointEigenSolver<Mat3>(tensor, Eigen::EigenvaluesOnly).eigenvalues().reverse();
}

}  // namespace sinew::solid
