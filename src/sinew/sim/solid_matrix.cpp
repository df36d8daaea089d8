#include "sinew/sim/solid_matrix.hpp"

#include <algorithm>
#include <numeric>

#include "sinew/solid/pressure.hpp"

namespace sinew {

namespace {

/// Pairs of unknowns (row >= column) of some nodes, in the order in which places are kept: columns, then rows.
template <class Visit>
void each_entry(const solid::Body& body, std::span<const int> nodes, const Visit& visit) {
  const auto n = static_cast<int>(3 * nodes.size());
  const auto unknown = [&](int i) { return body.unknown(i % 3, nodes[static_cast<std::size_t>(i / 3)]); };
  for (int j = 0; j < n; ++j) {
    const int column = unknown(j);
    if (column < 0) continue;
    for (int i = 0; i < n; ++i) {
      const int row = unknown(i);
      if (row >= column) visit(i, j, row, column);
    }
  }
}

/// The same of the mass matrix, with the mass.
template <class Visit>
void each_mass(const solid::Body& body, const Visit& visit) {
  for (int b = 0; b < body.mass.outerSize(); ++b) {
    for (Eigen::SparseMatrix<double>::InnerIterator at(body.mass, b); at; ++at) {
      for (int axis = 0; axis < 3; ++axis) {
        const int row = body.unknown(axis, at.row()), column = body.unknown(axis, b);
        if (column >= 0 && row >= column) visit(row, column, at.value());
      }
    }
  }
}

int place_of(const linalg::SparseFactor::Matrix& A, int row, int column) {
  const int* begin = A.innerIndexPtr() + A.outerIndexPtr()[column];
  const int* end = A.innerIndexPtr() + A.outerIndexPtr()[column + 1];
  return static_cast<int>(std::lower_bound(begin, end, row) - A.innerIndexPtr());
}

}  // namespace

void make_pattern(SolidModel& model) {
  const solid::Body& body = model.body;
  // Nodes that share a cell with each node, ascending, each once; unknowns are numbered in the order of the nodes.
  std::vector<std::vector<int>> near(static_cast<std::size_t>(body.nodes()));
  for (const solid::Cell& cell : body.cells) {
    for (const int node : cell.nodes()) {
      for (const int other : cell.nodes()) {
        if (other >= node) near[static_cast<std::size_t>(node)].push_back(other);
      }
    }
  }
  for (std::vector<int>& own : near) {
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
  }
  const auto each_pair = [&](const auto& visit) {
    for (int node = 0; node < body.nodes(); ++node) {
      for (int axis = 0; axis < 3; ++axis) {
        const int column = body.unknown(axis, node);
        if (column < 0) continue;
        for (const int other : near[static_cast<std::size_t>(node)]) {
          for (int i = 0; i < 3; ++i) {
            const int row = body.unknown(i, other);
            if (row >= column) visit(row, column);
          }
        }
      }
    }
  };
  linalg::SparseFactor::Matrix& A = model.matrix;
  A.resize(body.unknowns, body.unknowns);
  int* first = A.outerIndexPtr();
  each_pair([&](int, int column) { ++first[column + 1]; });
  std::partial_sum(first, first + body.unknowns + 1, first);
  A.resizeNonZeros(first[body.unknowns]);
  std::fill_n(A.valuePtr(), A.nonZeros(), 0.0);
  int* at = A.innerIndexPtr();
  each_pair([&](int row, int) { *at++ = row; });

  const auto place = [&A](int row, int column) { return place_of(A, row, column); };
  std::size_t most = 0;
  for (const solid::Cell& cell : body.cells) most += 3 * cell.nodes().size() * (3 * cell.nodes().size() + 1) / 2;
  model.places.reserve(most);
  for (int e = 0; e < body.elements(); ++e) {
    model.first_place.push_back(model.places.size());
    each_entry(body, body.cells[e].nodes(),
               [&](int, int, int row, int column) { model.places.push_back(place(row, column)); });
  }
  each_mass(body, [&](int row, int column, double) { model.mass_places.push_back(place(row, column)); });
  for (int i = 0; i < body.unknowns; ++i) model.diagonal.push_back(A.outerIndexPtr()[i]);
}

std::vector<int> face_places(const SolidModel& model, const std::vector<solid::CellFace>& faces) {
  std::vector<int> places;
  for (const solid::CellFace& face : faces)
    each_entry(model.body, face.nodes(),
               [&](int, int, int row, int column) { places.push_back(place_of(model.matrix, row, column)); });
  return places;
}

void add_pressure_tangent(const SolidModel& model, const SolidLoadModel& load, double factor, const Eigen::Matrix3Xd& x,
                          linalg::SparseFactor::Matrix& A) {
  const int* place = load.places.data();
  for (const solid::CellFace& face : load.faces) {
    const Eigen::MatrixXd K = solid::pressure_tangent(face, factor * load.pressure, x);
    each_entry(model.body, face.nodes(),
               [&](int i, int j, int, int) { A.valuePtr()[*place++] += 0.5 * (K(i, j) + K(j, i)); });
  }
}

Eigen::MatrixXd pressure_skew(const SolidModel& model, const SolidLoadModel& load, double factor,
                              const Eigen::Matrix3Xd& x) {
  const auto size = static_cast<Eigen::Index>(load.rim.size());
  Eigen::MatrixXd skew = Eigen::MatrixXd::Zero(size, size);
  for (const solid::CellFace& face : load.faces) {
    std::vector<Eigen::Index> at;  // of the face's coordinates on the rim, -1 inside
    for (const int node : face.nodes()) {
      for (const int unknown : model.body.unknown.col(node)) {
        const auto place = std::lower_bound(load.rim.begin(), load.rim.end(), unknown);
        at.push_back(place != load.rim.end() && *place == unknown ? place - load.rim.begin() : -1);
      }
    }
    if (std::count(at.begin(), at.end(), -1) == static_cast<std::ptrdiff_t>(at.size())) continue;
    const Eigen::MatrixXd K = solid::pressure_tangent(face, factor * load.pressure, x);
    for (std::size_t i = 0; i < at.size(); ++i) {
      for (std::size_t j = 0; j < at.size(); ++j) {
        const auto a = static_cast<Eigen::Index>(i), b = static_cast<Eigen::Index>(j);
        if (at[i] >= 0 && at[j] >= 0) skew(at[i], at[j]) += 0.5 * (K(a, b) - K(b, a));
      }
    }
  }
  return skew;
}

void assemble(const SolidModel& model, const solid::StepStart& start, const Eigen::Matrix3Xd& x, solid::Tangent kind,
              linalg::SparseFactor::Matrix& A) {
  double* values = A.valuePtr();
  std::fill(values, values + A.nonZeros(), 0.0);
  solid::assemble_tangent(model.body, start, x, kind, [&](int cell, const solid::ElementMatrix& own) {
    const int* place = model.places.data() + model.first_place[static_cast<std::size_t>(cell)];
    each_entry(model.body, model.body.cells[cell].nodes(),
               [&](int i, int j, int, int) { values[*place++] += own(i, j); });
  });
  const double factor = solid::mass_factor(model.body, start.rate);
  const int* place = model.mass_places.data();
  each_mass(model.body, [&](int, int, double mass) { values[*place++] += factor * mass; });
  if (model.springs.size() == 0) return;
  for (int node = 0; node < model.body.nodes(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      const int unknown = model.body.unknown(axis, node);
      if (unknown >= 0) values[model.diagonal[unknown]] += model.springs(axis, node);
    }
  }
}

}  // namespace sinew
