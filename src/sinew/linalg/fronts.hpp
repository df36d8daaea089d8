// How a sparse symmetric matrix is eliminated: which unknowns go together, in which order, and where everything is
// kept. Decided once per pattern (README.md).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sinew/linalg/kernels.hpp"
#include "sinew/linalg/ordering.hpp"
#include "sinew/linalg/precision.hpp"

namespace sinew::linalg {

/// Unknowns that are eliminated together, and what they meet. Its panel has the rows: its own unknowns, those below
/// (later ones that they meet), one of the right side, and the border rows that reach it. Its update is what the panel
/// does to all but its own.
struct Front {
  int first = 0, columns = 0;   ///< its own: positions first .. before first + columns in the order of elimination
  int below = 0;                ///< how many below
  int border = 0, borders = 0;  ///< first border row that reaches it, and how many (sorted)
  int parent = -1;              ///< the front its update goes to
  int stride = 0, update_stride = 0;  ///< [numbers] from one column to the next, of panel and update
  std::size_t panel = 0, update = 0;  ///< where they begin; the latter in a room of its part's, or where all share one
  bool in_part = false;               ///< below the root of a part
  std::size_t index = 0;              ///< where its rows begin in `below`
  std::size_t first_run = 0;          ///< and in `runs`
  int run_count = 0;
  std::size_t first_block = 0;  ///< entries of A that begin in its panel
  int block_count = 0;
  std::size_t first_border_entry = 0;  ///< and of border rows
  int border_entry_count = 0;
  int to_panel = 0;             ///< so many of its rows below are columns of its parent's panel
  std::size_t first_child = 0;  ///< where its children begin in `children`
  int child_count = 0;

  int rows() const { return columns + below; }
  int right() const { return rows(); }  ///< the right side's row
  int first_border() const { return rows() + 1; }
  int height() const { return first_border() + borders; }
};

struct Fronts {
  Precision precision = Precision::float64;
  std::vector<int> place;     ///< of each unknown in the order of elimination
  std::vector<int> border;    ///< of each border row in the order in which they are kept
  std::vector<Front> fronts;  ///< children before parents, each one's descendants just before it
  std::vector<int> below;     ///< positions of the rows below, ascending
  std::vector<Run> runs;      ///< which rows of the parent they and the border rows are
  std::vector<int> children;
  std::vector<Block> blocks;  ///< front by front, by columns, each column's from the diagonal down
  struct BorderEntry {
    int from = 0;  ///< which of the border's numbers, row by row
    std::uint32_t into = 0;
  };
  std::vector<BorderEntry> border_entries;
  std::vector<std::uint8_t> slot, rank;  ///< of each unknown: its slot, and how many of its node's come before it
  /// Subtrees that know nothing of each other, the heaviest first: fronts first .. before end, the last one their root.
  /// `top`: the fronts above them, ascending. A choice by size alone.
  struct Part {
    int first = 0, end = 0;
  };
  std::vector<Part> parts;
  std::vector<int> top;
  /// [numbers] that all panels take, updates of `top` and of the roots of parts alive at one time, and those of any one
  /// part.
  std::size_t panels = 0, updates = 0, part_updates = 0;

  std::span<const int> rows_below(const Front& front) const {
    return {below.data() + front.index, static_cast<std::size_t>(front.below)};
  }
  std::span<const int> children_of(const Front& front) const {
    return {children.data() + front.first_child, static_cast<std::size_t>(front.child_count)};
  }
  /// Where the numbers of all blocks begin that belong to two unknowns' nodes, which must meet, and of two unknowns
  /// themselves. The first kBlockSize numbers are of no block. Takes a search: for when a model is built.
  std::size_t block(int one, int other) const;
  std::size_t entry(int one, int other) const { return block(one, other) + place_in_block(one, other); }
  std::size_t numbers() const { return kBlockSize * (blocks.size() + 1); }
  const Front& front_of(int unknown) const;
  double work() const;          ///< multiplications of a numeric factorisation, border rows included
  std::size_t entries() const;  ///< of L below its diagonal, zeros of merged fronts included

 private:
  std::size_t place_in_block(int one, int other) const {
    const bool turned = place[one] < place[other];
    return static_cast<std::size_t>(slot[turned ? other : one] + 4 * slot[turned ? one : other]);
  }
};

/// Compressed columns, or rows, of a sparse matrix.
struct Compressed {
  int size = 0;
  const int* first = nullptr;
  const int* index = nullptr;
};

/// `lower`: columns of the lower triangle. `border`: rows of a matrix beside it; the unknowns of a row must all meet
/// each other, like the nodes of an element. `slots`: four times its node plus its slot, 0 to 2, of each unknown,
/// ascending; none: each is a node of its own. The unknowns of a node must all have the same neighbours. `precision`
/// tells how wide registers are. Throws std::invalid_argument where any of this does not hold, std::length_error where
/// a panel has 2^31 numbers or more.
Fronts plan_fronts(const Compressed& lower, const Compressed& border, std::span<const int> slots = {},
                   Precision precision = Precision::float64);

}  // namespace sinew::linalg
