// The Jacobian of constraint rows by every free coordinate of a scene.
#pragma once

#include <vector>

#include "sinew/sim/state.hpp"
#include "sinew/solve/coupled_problem.hpp"

namespace sinew {

/// Jacobians of some rows by all free coordinates, columns scaled by lever arms so that entries are near one. Rows that
/// hold auxiliary unknowns (what attachments follow), one each, are substituted in those that use them.
class RowJacobian {
 public:
  struct Entry {
    int column = 0;
    double value = 0.0;
  };
  using Row = std::vector<Entry>;  ///< by ascending columns, each once

  RowJacobian(const Model& model, const State& iterate, const solve::CoupledProblem& problem, std::vector<int> rows);

  const std::vector<int>& rows() const { return rows_; }
  const Row& of(std::size_t i) const { return all_[slot_[rows_[i]]]; }
  /// What a row takes of each row that holds an auxiliary unknown.
  const std::vector<Entry>& substituted(std::size_t i) const { return used_[i]; }
  bool is_strain(int column) const { return column >= first_strain_ && column < std::ssize(moved_); }
  /// [m] how far a scaled coordinate has moved: of strains from rest, of all others at most the scene's size.
  double moved(int column) const { return column < std::ssize(moved_) ? moved_[column] : model_.size; }

 private:
  void add(int row, int column, double value) {
    if (slot_[row] >= 0 && value != 0.0) all_[slot_[row]].push_back({column, value});
  }
  void gather(const State& iterate, const solve::CoupledProblem& problem);
  void substitute();

  const Model& model_;
  std::vector<int> holds_, rows_, slot_;
  int first_strain_ = 0;
  std::vector<double> moved_;  ///< of all but the nodes of solids
  std::vector<Row> all_;
  std::vector<std::vector<Entry>> used_;
};

/// Row of each auxiliary unknown z that holds it, by its number among them: c = is - z.
std::vector<int> rows_of_followed(const Model& model);

}  // namespace sinew
