// What can be recorded of what: the one list of outputs, with their columns and units.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "sinew/sim/state.hpp"

namespace sinew {

/// A column of numbers: "x" of an output or, with the output's name before it, of signals.csv; and its SI unit, "1" of
/// what has none.
struct Column {
  std::string name, unit;
};

/// What an output is of: a point of a solid or a rod, a rigid body, or two that touch.
enum class Subject { solid, rod, body, pair };
Subject subject_of(const OutputModel& output);

/// An entry of the list.
struct OutputKind {
  Quantity quantity;
  Subject subject;
  std::vector<Column> columns;
  std::vector<double> (*values)(const Model&, const State&, const OutputModel&);  ///< one of each column
};

/// All of them. A new quantity is a word of `Quantity`, its name in `quantity_words` and its entries here.
const std::vector<OutputKind>& output_kinds();

/// The entry of a quantity of a subject, or null: it is not known of that.
const OutputKind* find_kind(Quantity quantity, Subject subject);
/// That of an output of a model.
const OutputKind& kind_of(const OutputModel& output);

/// How scene files write each quantity; a pair's goes without saying.
const std::vector<std::pair<std::string, Quantity>>& quantity_words();
/// "`position`, `orientation` or `force`": what is known of a subject.
std::string known_of(Subject subject);

}  // namespace sinew
