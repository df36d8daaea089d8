#include "sinew/sim/row_jacobian.hpp"

#include <algorithm>
#include <utility>

#include "sinew/sim/rod_rows.hpp"

namespace sinew {

std::vector<int> rows_of_followed(const Model& model) {
  std::vector<int> rows(static_cast<std::size_t>(model.followed), -1);
  for (const TieModel& tie : model.ties) {
    if (!tie.body()) continue;
    for (int i = 0; i < (tie.directors ? 12 : 3); ++i)
      rows[static_cast<std::size_t>(tie.unknown - model.first_followed + i)] = tie.body_row + i;
  }
  return rows;
}

namespace {

using Entry = RowJacobian::Entry;
using Row = RowJacobian::Row;

void sum_up(Row& row) {
  std::stable_sort(row.begin(), row.end(), [](const Entry& a, const Entry& b) { return a.column < b.column; });
  std::size_t kept = 0;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (kept > 0 && row[kept - 1].column == row[i].column) {
      row[kept - 1].value += row[i].value;
    } else {
      row[kept++] = row[i];
    }
  }
  row.resize(kept);
}

}  // namespace

RowJacobian::RowJacobian(const Model& model, const State& iterate, const solve::CoupledProblem& problem,
                         std::vector<int> rows)
    : model_(model), holds_(rows_of_followed(model)), rows_(std::move(rows)) {
  std::vector<int> wanted = rows_;
  wanted.insert(wanted.end(), holds_.begin(), holds_.end());
  slot_.assign(static_cast<std::size_t>(model.rows), -1);
  for (const int row : wanted) {
    if (slot_[row] >= 0) continue;
    slot_[row] = static_cast<int>(all_.size());
    all_.emplace_back();
  }
  gather(iterate, problem);
  substitute();
}

void RowJacobian::gather(const State& iterate, const solve::CoupledProblem& problem) {
  const auto nz = static_cast<int>(problem.r.size());
  first_strain_ = nz;
  moved_.assign(static_cast<std::size_t>(nz), model_.size);
  for (const auto& [row, column, value] : problem.G) add(row, column, value / model_.arms[column]);
  int first = nz;
  for (std::size_t n = 0; n < problem.chains.size(); ++n) {
    const solve::ChainPart& part = problem.chains[n];
    const Eigen::VectorXd levers = strain_levers(model_.rods[n].rod);
    const Eigen::VectorXd strains = iterate.rods[n].q.tail(levers.size()).cwiseProduct(levers).cwiseAbs();
    moved_.insert(moved_.end(), strains.begin(), strains.end());
    const auto spread = [&](int row, const Eigen::VectorXd& along) {
      for (Eigen::Index c = 0; c < along.size(); ++c) add(row, first + static_cast<int>(c), along[c] / levers[c]);
    };
    for (std::size_t i = 0; i < part.at.size(); ++i) {
      const int row = part.at[i] - nz;
      if (row < 0 || slot_[row] < 0) continue;
      spread(row, linalg::dense(part.chain, part.attachments[i]));
      for (Eigen::Index b = 0; b < part.base.cols(); ++b) {
        const int z = part.first_base + static_cast<int>(b);
        add(row, z, part.base.col(b).dot(part.attachments[i].g) / model_.arms[z]);
      }
    }
    for (std::size_t f = 0; f < part.whole_at.size(); ++f)
      spread(part.whole_at[f] - nz, part.whole.col(static_cast<Eigen::Index>(f)));
    first += part.chain.coordinates();
  }
  std::vector<int> first_of(model_.solids.size());
  for (std::size_t i = 0; i < model_.solids.size(); ++i) {
    first_of[i] = first;
    first += model_.solids[i].body.unknowns;
  }
  for (const SolidRow& row : model_.solid_rows) {
    if (slot_[row.row] < 0 || (row.point >= 0 && !iterate.points[row.point].on)) continue;
    const solid::Body& body = model_.solids[row.solid].body;
    const auto nodes = body.cells[row.where.element].nodes();
    for (std::size_t k = 0; k < nodes.size(); ++k) {
      for (int axis = 0; axis < 3; ++axis) {
        const int unknown = body.unknown(axis, nodes[k]);
        if (unknown >= 0)
          add(row.row + axis, first_of[row.solid] + unknown, -row.where.weights[static_cast<Eigen::Index>(k)]);
      }
    }
  }
  for (Row& row : all_) sum_up(row);
}

void RowJacobian::substitute() {
  used_.resize(rows_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    Row& own = all_[slot_[rows_[i]]];
    Row rest;
    for (const Entry& entry : own) {
      const int followed = entry.column - model_.first_followed;
      if (followed < 0 || followed >= model_.followed) {
        rest.push_back(entry);
        continue;
      }
      const int holding = holds_[static_cast<std::size_t>(followed)];
      used_[i].push_back({holding, entry.value});
      for (const Entry& other : all_[slot_[holding]]) {
        if (other.column != entry.column) rest.push_back({other.column, -entry.value * other.value});
      }
    }
    sum_up(rest);
    own = std::move(rest);
  }
}

}  // namespace sinew
