#include "sinew/sim/solid_matrix.hpp"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>

#include "sinew/sim/building.hpp"
#include "sinew/solid/pressure.hpp"

namespace sinew {

namespace {

/// Visits pairs of a cell's or a face's nodes, on and below the diagonal, row by row.
template <class Visit>
void each_pair(std::span<const int> nodes, const Visit& visit) {
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    for (std::size_t b = 0; b <= a; ++b) visit(a, b);
  }
}

/// Adds the entries (i, j) of two nodes. In a block on the diagonal the upper triangle is added, too, where nothing
/// reads it.
template <class Entry>
void add_block(const BlockPlace& place, const Entry& entry, double* values) {
  double* const at = values + place.at;
  const int down = place.turned ? 4 : 1, across = 5 - down;
  for (int j = 0; j < 3; ++j) {
    for (int i = 0; i < 3; ++i) at[i * down + j * across] += entry(i, j);
  }
}

/// Adds to the diagonal of a block.
void add_diagonal(std::uint32_t at, const Eigen::Vector3d& own, double* values) {
  for (int i = 0; i < 3; ++i) values[at + 5 * static_cast<std::uint32_t>(i)] += own[i];
}

using Pattern = linalg::SparseFactor::Matrix;

/// The lower triangle over the unknowns: nodes meet that share a cell.
Pattern pattern_of(const solid::Body& body) {
  // Nodes that share a cell with each node, ascending, each once; unknowns are numbered in the order of the nodes.
  std::vector<std::vector<int>> near(static_cast<std::size_t>(body.nodes()));
  for (const solid::Cell& cell : body.cells) {
    for (const int node : cell.nodes()) {
      for (const int other : cell.nodes()) {
        if (other >= node) near[static_cast<std::size_t>(node)].push_back(other);
      }
    }
  }
  for (std::vector<int>& own : near) solid::make_ascending(own);
  const auto each_entry = [&](const auto& visit) {
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
  Pattern A(body.unknowns, body.unknowns);
  int* first = A.outerIndexPtr();
  each_entry([&](int, int column) { ++first[column + 1]; });
  std::partial_sum(first, first + body.unknowns + 1, first);
  A.resizeNonZeros(first[body.unknowns]);
  std::fill_n(A.valuePtr(), A.nonZeros(), 0.0);
  int* at = A.innerIndexPtr();
  each_entry([&](int row, int) { *at++ = row; });
  return A;
}

/// H of some points of one volume: how far each moves per motion of the volume's unknowns.
linalg::SparseFactor::Rows border_rows(const solid::Body& body,
                                       const std::vector<const solid::EmbeddedPoint*>& points) {
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const std::span<const int> nodes = body.cells[points[k]->element].nodes();
    for (std::size_t c = 0; c < nodes.size(); ++c) {
      for (int axis = 0; axis < 3; ++axis) {
        const int unknown = body.unknown(axis, nodes[c]);
        const double weight = points[k]->weights[static_cast<Eigen::Index>(c)];
        if (unknown >= 0 && weight != 0.0) entries.emplace_back(static_cast<int>(3 * k) + axis, unknown, weight);
      }
    }
  }
  linalg::SparseFactor::Rows H(static_cast<Eigen::Index>(3 * points.size()), body.unknowns);
  H.setFromTriplets(entries.begin(), entries.end());
  return H;
}

/// The lowest free coordinate of a node, -1: none.
int first_unknown(const solid::Body& body, int node) {
  for (const int unknown : body.unknown.col(node)) {
    if (unknown >= 0) return unknown;
  }
  return -1;
}

BlockPlace block_place(const SolidModel& solid, int row, int column) {
  const int one = first_unknown(solid.body, row), other = first_unknown(solid.body, column);
  BlockPlace place;
  if (one < 0 || other < 0) return place;
  place.at = static_cast<std::uint32_t>(solid.fronts->block(one, other)) & 0x7fffffffU;
  place.turned = solid.fronts->place[one] < solid.fronts->place[other];
  return place;
}

/// Nodes of batches in the order of elimination, so that none of their blocks is turned, and where these go.
void place_batches(SolidModel& solid) {
  std::vector<int> rank(static_cast<std::size_t>(solid.body.nodes()), -1);
  for (int node = 0; node < solid.body.nodes(); ++node) {
    const int unknown = first_unknown(solid.body, node);
    if (unknown >= 0) rank[static_cast<std::size_t>(node)] = solid.fronts->place[unknown];
  }
  solid::sort_batches(solid.body, rank);
  solid.batch_places.assign(solid.body.batches.size(), {});
  for (std::size_t k = 0; k < solid.batch_places.size(); ++k) {
    const solid::TetBatch& batch = solid.body.batches[k];
    for (int i = 0; i < batch.count; ++i) {
      for (int a = 0, number = 0; a < 4; ++a) {
        for (int b = 0; b <= a; ++b, ++number)
          solid.batch_places[k].block[number][i] = block_place(solid, batch.node[a][i], batch.node[b][i]).at;
      }
    }
  }
}

void plan_factor(Model& model, int number) {
  SolidModel& solid = model.solids[static_cast<std::size_t>(number)];
  const solid::Body& body = solid.body;
  std::vector<const solid::EmbeddedPoint*> points;
  const auto gather = [&](const auto& all, std::vector<int>& own) {
    for (std::size_t k = 0; k < all.size(); ++k) {
      if (all[k].solid != number) continue;
      own.push_back(static_cast<int>(k));
      points.push_back(&all[k].where);
    }
  };
  gather(model.solid_rows, solid.rows);
  gather(model.watched, solid.watched);
  solid.border = border_rows(body, points);
  std::vector<int> slots(static_cast<std::size_t>(body.unknowns));
  for (int node = 0; node < body.nodes(); ++node) {
    for (int axis = 0; axis < 3; ++axis) {
      if (body.unknown(axis, node) >= 0) slots[static_cast<std::size_t>(body.unknown(axis, node))] = 4 * node + axis;
    }
  }
  const auto too_fine = [&](const std::string& what) {
    building::reject("solids." + solid.name, std::to_string(body.unknowns) + " unknowns", what, "use a coarser mesh");
  };
  try {
    solid.fronts = linalg::SparseFactor::make_plan(pattern_of(body), solid.border, slots, model.scene.newton.precision);
  } catch (const std::length_error&) {
    too_fine("a block of its factor would have more than 2^31 numbers");
  }
  if (solid.fronts->numbers() > std::numeric_limits<std::int32_t>::max())
    too_fine("its matrix would have more than 2^31 numbers");
  const auto add_places = [&](std::span<const int> nodes, std::vector<BlockPlace>& places) {
    each_pair(nodes, [&](std::size_t a, std::size_t b) { places.push_back(block_place(solid, nodes[a], nodes[b])); });
  };
  std::size_t blocks = 0;
  for (const solid::Cell& cell : body.cells) blocks += cell.nodes().size() * (cell.nodes().size() + 1) / 2;
  solid.places.reserve(blocks);
  for (const solid::Cell& cell : body.cells) {
    solid.first_place.push_back(solid.places.size());
    add_places(cell.nodes(), solid.places);
  }
  place_batches(solid);
  for (int b = 0; b < body.nodes(); ++b) {
    solid.node_places.push_back(block_place(solid, b, b).at);
    for (Eigen::SparseMatrix<double>::InnerIterator at(body.mass, b); at; ++at) {
      const auto a = static_cast<int>(at.row());
      const BlockPlace place = block_place(solid, a, b);
      if (a >= b && place.at != 0) solid.mass_places.push_back({place.at, at.value()});
    }
  }
  for (LoadModel& load : model.loads) {
    SolidLoadModel* const own = std::get_if<SolidLoadModel>(&load.on);
    if (!own || own->solid != number) continue;
    for (const solid::CellFace& face : own->faces) add_places(face.nodes(), own->places);
  }
}

}  // namespace

void plan_factors(Model& model) {
  for (std::size_t i = 0; i < model.solids.size(); ++i) plan_factor(model, static_cast<int>(i));
}

void add_pressure_tangent(const SolidLoadModel& load, double factor, const Eigen::Matrix3Xd& x, double* values) {
  const BlockPlace* place = load.places.data();
  for (const solid::CellFace& face : load.faces) {
    const Eigen::MatrixXd K = solid::pressure_tangent(face, factor * load.pressure, x);
    each_pair(face.nodes(), [&](std::size_t a, std::size_t b) {
      const auto entry = [&](int i, int j) {
        const auto row = static_cast<Eigen::Index>(3 * a) + i, column = static_cast<Eigen::Index>(3 * b) + j;
        return 0.5 * (K(row, column) + K(column, row));
      };
      add_block(*place++, entry, values);
    });
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
              double* values) {
  solid::Deformation deformation;
  solid::deform(model.body, start, x, deformation);
  assemble(model, start, x, deformation, kind, values);
}

void assemble(const SolidModel& model, const solid::StepStart& start, const Eigen::Matrix3Xd& x,
              const solid::Deformation& deformation, solid::Tangent kind, double* values) {
  const solid::Body& body = model.body;
  const auto insert = [&](int cell, const solid::ElementMatrix& own) {
    const BlockPlace* place = model.places.data() + model.first_place[static_cast<std::size_t>(cell)];
    const std::span<const int> nodes = body.cells[cell].nodes();
    each_pair(nodes, [&](std::size_t a, std::size_t b) {
      const auto block = own.block<3, 3>(static_cast<Eigen::Index>(3 * a), static_cast<Eigen::Index>(3 * b));
      add_block(*place++, block, values);
    });
  };
  const auto insert_batch = [&](const solid::TetBatch& batch, const solid::TetStiffness& own, unsigned left_out) {
    const auto number = static_cast<std::size_t>(&batch - body.batches.data());
    if (left_out == 0) return solid::tet_kernels().add(own, model.batch_places[number], values);
    solid::TetPlaces places = model.batch_places[number];
    for (int i = 0; i < solid::kBatch; ++i) {
      if (!(left_out >> i & 1U)) continue;
      for (int k = 0; k < 10; ++k) places.block[k][i] = 0;  // where nothing is read
    }
    solid::tet_kernels().add(own, places, values);
  };
  // By reference: functions as large as these would ask for memory.
  solid::assemble_tangent(body, start, x, deformation, kind, std::cref(insert), std::cref(insert_batch));
  const double factor = solid::mass_factor(body, start.rate);
  for (const MassPlace& own : model.mass_places)
    add_diagonal(own.at, Eigen::Vector3d::Constant(factor * own.mass), values);
  for (Eigen::Index node = 0; node < model.springs.cols(); ++node)
    add_diagonal(model.node_places[static_cast<std::size_t>(node)], model.springs.col(node), values);
}

void add_over_nodes(const SolidModel& model, std::span<const int> nodes, const Eigen::Ref<const Eigen::MatrixXd>& K,
                    double* values) {
  each_pair(nodes, [&](std::size_t a, std::size_t b) {
    const auto block = K.block<3, 3>(static_cast<Eigen::Index>(3 * a), static_cast<Eigen::Index>(3 * b));
    add_block(block_place(model, nodes[a], nodes[b]), block, values);
  });
}

void add_grip(const SolidModel& model, const Grip& grip, double* values) {
  add_diagonal(model.node_places[static_cast<std::size_t>(grip.node)], Eigen::Vector3d::Constant(grip.stiffness),
               values);
}

}  // namespace sinew
