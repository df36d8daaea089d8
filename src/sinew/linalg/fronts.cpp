#include "sinew/linalg/fronts.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

#include "sinew/linalg/kernels.hpp"

namespace sinew::linalg {

namespace {

std::vector<int> inverse_of(const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = static_cast<int>(k);
  return place;
}

/// Which position first meets each one after it (Liu's algorithm on the graph in the order of elimination).
std::vector<int> elimination_tree(const Graph& graph, const std::vector<int>& order) {
  const std::vector<int> place = inverse_of(order);
  std::vector<int> parent(order.size(), -1), ancestor(order.size(), -1);
  for (int j = 0; j < static_cast<int>(order.size()); ++j) {
    for (const int neighbour : graph.neighbours(order[j])) {
      int i = place[neighbour];
      while (i >= 0 && i < j) {
        const int next = ancestor[i];
        ancestor[i] = j;
        if (next < 0) parent[i] = j;
        i = next;
      }
    }
  }
  return parent;
}

/// Visits for each front the later positions that it meets, ascending: those of its graph nodes and of its children.
/// Front s has the positions first[s] .. before first[s + 1]; children come before their parents.
template <class Visit>
void each_structure(const Graph& graph, const std::vector<int>& order, const std::vector<int>& first,
                    const std::vector<int>& parent, const Visit& visit) {
  const std::vector<int> place = inverse_of(order);
  std::vector<std::vector<int>> left(parent.size());  // by the children
  std::vector<int> seen(order.size(), -1);
  for (std::size_t s = 0; s < parent.size(); ++s) {
    std::vector<int> own;
    const auto add = [&](int i) {
      if (i < first[s + 1] || seen[i] == static_cast<int>(s)) return;
      seen[i] = static_cast<int>(s);
      own.push_back(i);
    };
    for (const int i : std::exchange(left[s], {})) add(i);
    for (int k = first[s]; k < first[s + 1]; ++k) {
      for (const int neighbour : graph.neighbours(order[k])) add(place[neighbour]);
    }
    std::sort(own.begin(), own.end());
    if (parent[s] >= 0) left[parent[s]].insert(left[parent[s]].end(), own.begin(), own.end());
    visit(s, std::move(own));
  }
}

/// About how long a front takes, in multiplications at full speed: what is arithmetic, what moves numbers (clearing the
/// front, adding it to its parent) and what is paid for any front. The weights are measured (README.md).
double duration(double columns, double rows) {
  constexpr double kNumber = 8.0, kFront = 4500.0;
  return 0.5 * columns * rows * rows + 0.5 * kNumber * rows * rows + kFront;
}

/// Merges fronts with their parents where together they take less time, and numbers them so that each one's descendants
/// come just before it. Fills `order` anew and gives the first position of each front, and its parent.
void merge(const Graph& graph, std::vector<int>& order, std::vector<int>& first, std::vector<int>& parent) {
  const std::size_t n = order.size();
  std::vector<double> columns(n), rows(n);
  std::vector<std::vector<int>> children(n), nodes(n);  // of fronts; nodes by their positions
  each_structure(graph, order, first, parent, [&](std::size_t s, const std::vector<int>& below) {
    nodes[s] = {static_cast<int>(s)};
    columns[s] = rows[s] = graph.weight[order[s]];
    for (const int i : below) rows[s] += graph.weight[order[i]];
    if (parent[s] >= 0) children[parent[s]].push_back(static_cast<int>(s));
  });
  for (std::size_t p = 0; p < n; ++p) {
    const auto gain = [&](int c) {
      return duration(columns[c], rows[c]) + duration(columns[p], rows[p]) -
             duration(columns[c] + columns[p], columns[c] + rows[p]);
    };
    for (;;) {
      const auto best =
          std::max_element(children[p].begin(), children[p].end(), [&gain](int a, int b) { return gain(a) < gain(b); });
      if (best == children[p].end() || !(gain(*best) > 0.0)) break;
      const int child = *best;
      children[p].erase(best);
      children[p].insert(children[p].end(), children[child].begin(), children[child].end());
      nodes[p].insert(nodes[p].end(), nodes[child].begin(), nodes[child].end());
      columns[p] += columns[child];
      rows[p] += columns[child];
      columns[child] = 0.0;
      nodes[child].clear();
    }
  }
  std::vector<int> next, finished;  // depth first; a front is finished after its children
  for (std::size_t s = n; s-- > 0;) {
    if (parent[s] < 0) next.push_back(static_cast<int>(s));
  }
  while (!next.empty()) {  // parents first, then turned round
    const int s = next.back();
    next.pop_back();
    finished.push_back(s);
    next.insert(next.end(), children[s].begin(), children[s].end());
  }
  std::reverse(finished.begin(), finished.end());
  const std::vector<int> before = std::exchange(order, {});
  std::vector<int> number(n, -1);
  first = {0};
  for (std::size_t k = 0; k < finished.size(); ++k) {
    std::vector<int>& own = nodes[finished[k]];
    std::sort(own.begin(), own.end());
    for (const int i : own) order.push_back(before[i]);
    first.push_back(static_cast<int>(order.size()));
    number[finished[k]] = static_cast<int>(k);
  }
  parent.assign(finished.size(), -1);
  for (std::size_t k = 0; k < finished.size(); ++k) {
    for (const int child : children[finished[k]]) parent[number[child]] = static_cast<int>(k);
  }
}

/// The fronts of an order: their unknowns, their rows below and their parents.
void add_fronts(const Graph& graph, std::vector<int> order, Fronts& plan) {
  std::vector<int> first(order.size() + 1), parent = elimination_tree(graph, order);
  std::iota(first.begin(), first.end(), 0);
  merge(graph, order, first, parent);

  std::vector<int> position = {0};  // first unknown of each graph node
  plan.place.resize(graph.member.size());
  for (const int node : order) {
    int at = position.back();
    for (const int unknown : graph.members(node)) plan.place[unknown] = at++;
    position.push_back(at);
  }
  plan.fronts.resize(parent.size());
  each_structure(graph, order, first, parent, [&](std::size_t s, const std::vector<int>& below) {
    Front& front = plan.fronts[s];
    front.first = position[first[s]];
    front.columns = position[first[s + 1]] - front.first;
    front.parent = parent[s];
    front.index = plan.below.size();
    for (const int i : below) {
      for (int at = position[i]; at < position[i + 1]; ++at) plan.below.push_back(at);
    }
    front.below = static_cast<int>(plan.below.size() - front.index);
  });
}

/// The row of a front that a position is.
int row_of(const Fronts& plan, const Front& front, int position) {
  if (position < front.first + front.columns) return position - front.first;
  const std::span<const int> below = plan.rows_below(front);
  return front.columns + static_cast<int>(std::lower_bound(below.begin(), below.end(), position) - below.begin());
}

/// Who hangs on whom.
void add_descent(Fronts& plan) {
  std::vector<std::vector<int>> children(plan.fronts.size());
  for (std::size_t s = 0; s < plan.fronts.size(); ++s) {
    Front& front = plan.fronts[s];
    front.first_child = plan.children.size();
    front.child_count = static_cast<int>(children[s].size());
    plan.children.insert(plan.children.end(), children[s].begin(), children[s].end());
    if (front.parent < 0) continue;
    children[front.parent].push_back(static_cast<int>(s));
  }
}

/// Which rows of the parent a front's rows below and border rows are.
void add_runs(Fronts& plan) {
  for (Front& front : plan.fronts) {
    front.first_run = plan.runs.size();
    if (front.parent < 0) continue;
    const Front& parent = plan.fronts[front.parent];
    const auto put = [&](int row, int into) {
      if (plan.runs.size() > front.first_run) {
        Run& last = plan.runs.back();
        if (last.row + last.length == row && last.into + last.length == into) {
          ++last.length;
          return;
        }
      }
      plan.runs.push_back({row, into, 1});
    };
    for (int i = 0; i < front.below; ++i) {
      const int into = row_of(plan, parent, plan.below[front.index + i]);
      if (into < parent.columns) ++front.to_panel;
      put(i, into);
    }
    put(front.below, parent.right());
    for (int i = 0; i < front.borders; ++i)
      put(front.below + 1 + i, parent.first_border() + front.border - parent.border + i);
    front.run_count = static_cast<int>(plan.runs.size() - front.first_run);
  }
}

/// Which fronts border rows reach: those on the way from the first of their unknowns to the root.
void add_border(const Compressed& border, const std::vector<int>& front_of, Fronts& plan) {
  std::vector<int> start(static_cast<std::size_t>(border.size));
  for (int k = 0; k < border.size; ++k) {
    int lowest = static_cast<int>(plan.place.size());
    for (int at = border.first[k]; at < border.first[k + 1]; ++at)
      lowest = std::min(lowest, plan.place[border.index[at]]);
    start[k] = border.first[k] < border.first[k + 1] ? front_of[lowest] : static_cast<int>(plan.fronts.size());
    for (int at = border.first[k]; at < border.first[k + 1]; ++at) {
      const Front& front = plan.fronts[start[k]];
      const int position = plan.place[border.index[at]];
      const std::span<const int> below = plan.rows_below(front);
      if (position >= front.first + front.columns && !std::binary_search(below.begin(), below.end(), position))
        throw std::invalid_argument("plan_fronts: unknowns of a border row that do not meet");
    }
  }
  std::vector<int> sorted(start.size());
  std::iota(sorted.begin(), sorted.end(), 0);
  std::stable_sort(sorted.begin(), sorted.end(), [&start](int a, int b) { return start[a] < start[b]; });
  plan.border = inverse_of(sorted);
  const auto count_before = [&](int front) {
    return static_cast<int>(
        std::lower_bound(sorted.begin(), sorted.end(), front, [&start](int k, int s) { return start[k] < s; }) -
        sorted.begin());
  };
  std::vector<int> earliest(plan.fronts.size());  // of a front and all that hang on it
  for (std::size_t s = 0; s < plan.fronts.size(); ++s) {
    Front& front = plan.fronts[s];
    earliest[s] = front.child_count > 0 ? earliest[plan.children_of(front).front()] : static_cast<int>(s);
    front.border = count_before(earliest[s]);
    front.borders = count_before(static_cast<int>(s) + 1) - front.border;
  }
}

/// Room for updates: each lives from its own front to its parent's.
class Room {
 public:
  std::size_t take(std::size_t size) {
    if (size == 0) return 0;
    for (auto at = free_.begin(); at != free_.end(); ++at) {
      if (at->second < size) continue;
      const auto [begin, length] = *at;
      free_.erase(at);
      if (length > size) free_[begin + size] = length - size;
      return begin;
    }
    std::size_t begin = end_;  // what is free at the very end is part of what is taken
    if (!free_.empty() && free_.rbegin()->first + free_.rbegin()->second == end_) {
      begin = free_.rbegin()->first;
      free_.erase(begin);
    }
    end_ = begin + size;
    return begin;
  }
  void give_back(std::size_t begin, std::size_t size) {
    if (size == 0) return;
    auto at = free_.emplace(begin, size).first;
    const auto next = std::next(at);
    if (next != free_.end() && at->first + at->second == next->first) {
      at->second += next->second;
      free_.erase(next);
    }
    if (at == free_.begin()) return;
    const auto before = std::prev(at);
    if (before->first + before->second == at->first) {
      before->second += at->second;
      free_.erase(at);
    }
  }
  std::size_t end() const { return end_; }

 private:
  std::map<std::size_t, std::size_t> free_;  // where it begins, how long it is
  std::size_t end_ = 0;
};

std::size_t update_size(const Front& front) {
  return static_cast<std::size_t>(front.update_stride) * static_cast<std::size_t>(front.below);
}

double work_of(const Front& front) {
  double sum = 0.0;
  const double height = front.height();
  for (int k = 0; k < front.columns; ++k) sum += 0.5 * (height - k) * (height - k);
  return sum;
}

/// Cuts the tree below its heaviest fronts until no subtree has more than an eighth of the work.
void add_parts(Fronts& plan) {
  std::vector<double> work(plan.fronts.size());  // of subtrees
  std::vector<int> first(plan.fronts.size());    // front of each
  double all = 0.0;
  std::vector<int> uncut;
  for (std::size_t s = 0; s < plan.fronts.size(); ++s) {
    const Front& front = plan.fronts[s];
    const std::span<const int> children = plan.children_of(front);
    all += work_of(front);
    work[s] += work_of(front);
    first[s] = children.empty() ? static_cast<int>(s) : first[children.front()];
    if (front.parent >= 0) {
      work[front.parent] += work[s];
    } else {
      uncut.push_back(static_cast<int>(s));
    }
  }
  const auto lighter = [&work](int a, int b) { return work[a] < work[b] || (work[a] == work[b] && a < b); };
  std::make_heap(uncut.begin(), uncut.end(), lighter);
  while (!uncut.empty() && work[uncut.front()] > all / 8.0) {
    std::pop_heap(uncut.begin(), uncut.end(), lighter);
    const int root = uncut.back();
    uncut.pop_back();
    plan.top.push_back(root);
    for (const int child : plan.children_of(plan.fronts[root])) {
      uncut.push_back(child);
      std::push_heap(uncut.begin(), uncut.end(), lighter);
    }
  }
  std::sort(plan.top.begin(), plan.top.end());
  std::sort(uncut.begin(), uncut.end(), [&lighter](int a, int b) { return lighter(b, a); });
  for (const int root : uncut) plan.parts.push_back({first[root], root + 1});
}

/// Where updates of a part begin, but for its root's. What a front's children leave lies at one end of the room, what
/// it leaves itself at the other, so that each end is a stack, and no room is lost between them.
void add_room(const Fronts::Part& part, Fronts& plan) {
  std::vector<bool> far(static_cast<std::size_t>(part.end - part.first), false);  // at the end of the room
  std::size_t near_taken = 0, far_taken = 0, most = 0;
  const auto taken = [&](bool at_end) -> std::size_t& { return at_end ? far_taken : near_taken; };
  for (int s = part.end - 2; s >= part.first; --s)
    far[static_cast<std::size_t>(s - part.first)] = !far[static_cast<std::size_t>(plan.fronts[s].parent - part.first)];
  for (int s = part.first; s + 1 < part.end; ++s) {
    Front& front = plan.fronts[s];
    const bool own = far[static_cast<std::size_t>(s - part.first)];
    front.in_part = true;
    front.update = taken(own);
    taken(own) += update_size(front);
    most = std::max(most, near_taken + far_taken);
    for (const int child : plan.children_of(front)) taken(!own) -= update_size(plan.fronts[child]);
  }
  for (int s = part.first; s + 1 < part.end; ++s) {
    Front& front = plan.fronts[s];
    if (far[static_cast<std::size_t>(s - part.first)]) front.update = most - front.update - update_size(front);
  }
  plan.part_updates = std::max(plan.part_updates, most);
}

/// Where panels and updates begin. Parts can be done at one time: each in a room like that of any other, but for the
/// updates of their roots, which wait for their parents.
void add_places(Fronts& plan) {
  const int lanes = plan.precision == Precision::float64 ? kLanesOf<double> : kLanesOf<float>;
  for (Front& front : plan.fronts) {
    // A panel is read in whole registers from its first row below and from its first border row on, and factored from
    // every eighth row on, whatever the lanes; where it starts, a row more is written (kernels.hpp).
    const int from_border = front.first_border() + whole_lanes(front.borders, lanes) + lanes - kLanes;
    const int from_below = front.columns + whole_lanes(front.height() - front.columns, lanes);
    front.stride = whole_lanes(std::max(from_border, from_below), lanes);
    if (static_cast<std::int64_t>(front.stride) * front.columns > std::numeric_limits<std::int32_t>::max())
      throw std::length_error("plan_fronts: a front of " + std::to_string(front.columns) + " unknowns");
    front.update_stride = whole_lanes(front.height() - front.columns, lanes);
    front.panel = plan.panels;
    plan.panels += static_cast<std::size_t>(front.stride) * static_cast<std::size_t>(front.columns);
  }
  Room shared;
  for (const Fronts::Part& part : plan.parts) {
    plan.fronts[part.end - 1].update = shared.take(update_size(plan.fronts[part.end - 1]));
    add_room(part, plan);
  }
  for (const int s : plan.top) {
    plan.fronts[s].update = shared.take(update_size(plan.fronts[s]));
    for (const int child : plan.children_of(plan.fronts[s]))
      shared.give_back(plan.fronts[child].update, update_size(plan.fronts[child]));
  }
  plan.updates = shared.end();
}

/// Slots of the unknowns, and their ranks in their nodes.
void add_slots(std::span<const int> slots, Fronts& plan) {
  const std::size_t n = plan.place.size();
  plan.slot.assign(n, 0);
  plan.rank.assign(n, 0);
  for (std::size_t i = 0; i < slots.size(); ++i) {
    plan.slot[i] = static_cast<std::uint8_t>(slots[i] % 4);
    if (plan.slot[i] > 2) throw std::invalid_argument("plan_fronts: a node of more than three unknowns");
    if (i == 0 || slots[i] / 4 != slots[i - 1] / 4) continue;
    plan.rank[i] = static_cast<std::uint8_t>(plan.rank[i - 1] + 1);
    if (plan.place[i] != plan.place[i - 1] + 1 || plan.slot[i] <= plan.slot[i - 1])
      throw std::invalid_argument("plan_fronts: unknowns of a node that have different neighbours");
  }
}

/// Where entries of the matrix and of the border rows go, once strides are known.
void add_entries(const Compressed& lower, const Compressed& border, const std::vector<int>& front_of, Fronts& plan) {
  const auto n = static_cast<int>(plan.place.size());
  std::vector<std::uint8_t> bits(plan.place.size());  // of the node of each first unknown
  for (int i = n - 1, own = 0; i >= 0; --i) {
    own |= 1 << plan.slot[i];
    if (plan.rank[i] > 0) continue;
    bits[i] = static_cast<std::uint8_t>(own);
    own = 0;
  }
  std::vector<std::vector<Block>> blocks(plan.fronts.size());
  for (int j = 0; j < n; ++j) {
    if (plan.rank[j] > 0) continue;
    for (int at = lower.first[j]; at < lower.first[j + 1]; ++at) {
      const int i = lower.index[at];
      if (plan.rank[i] > 0) continue;
      const int first = plan.place[i] < plan.place[j] ? i : j, later = first == i ? j : i;
      const Front& front = plan.fronts[front_of[plan.place[first]]];
      const int row = row_of(plan, front, plan.place[later]), column = plan.place[first] - front.first;
      blocks[front_of[plan.place[first]]].push_back(
          {static_cast<std::uint32_t>(row + column * front.stride), bits[later], bits[first]});
    }
  }
  std::vector<std::vector<Fronts::BorderEntry>> entries(plan.fronts.size());
  for (int k = 0; k < border.size; ++k) {
    for (int at = border.first[k]; at < border.first[k + 1]; ++at) {
      const int position = plan.place[border.index[at]];
      const Front& front = plan.fronts[front_of[position]];
      entries[front_of[position]].push_back(
          {at, static_cast<std::uint32_t>(front.first_border() + plan.border[k] - front.border +
                                          (position - front.first) * front.stride)});
    }
  }
  for (std::size_t s = 0; s < plan.fronts.size(); ++s) {
    Front& front = plan.fronts[s];
    std::sort(blocks[s].begin(), blocks[s].end(), [](const Block& a, const Block& b) { return a.into < b.into; });
    front.first_block = plan.blocks.size();
    front.block_count = static_cast<int>(blocks[s].size());
    plan.blocks.insert(plan.blocks.end(), blocks[s].begin(), blocks[s].end());
    front.first_border_entry = plan.border_entries.size();
    front.border_entry_count = static_cast<int>(entries[s].size());
    plan.border_entries.insert(plan.border_entries.end(), entries[s].begin(), entries[s].end());
  }
}

}  // namespace

const Front& Fronts::front_of(int unknown) const {
  return *std::prev(std::upper_bound(fronts.begin(), fronts.end(), place[unknown],
                                     [](int position, const Front& front) { return position < front.first; }));
}

std::size_t Fronts::block(int one, int other) const {
  const int first = place[one] < place[other] ? one : other, later = first == one ? other : one;
  const Front& front = front_of(first);
  const auto into = static_cast<std::uint32_t>(row_of(*this, front, place[later] - rank[later]) +
                                               (place[first] - rank[first] - front.first) * front.stride);
  const auto begin = blocks.begin() + static_cast<std::ptrdiff_t>(front.first_block), end = begin + front.block_count;
  const auto found =
      std::lower_bound(begin, end, into, [](const Block& own, std::uint32_t at) { return own.into < at; });
  if (found == end || found->into != into) throw std::invalid_argument("Fronts: unknowns that do not meet");
  return kBlockSize * static_cast<std::size_t>(found - blocks.begin() + 1);
}

double Fronts::work() const {
  double sum = 0.0;
  for (const Front& front : fronts) sum += work_of(front);
  return sum;
}

std::size_t Fronts::entries() const {
  std::size_t sum = 0;
  for (const Front& front : fronts) {
    const auto n = static_cast<std::size_t>(front.columns);
    sum += n * static_cast<std::size_t>(front.below) + n * (n - 1) / 2;
  }
  return sum;
}

Fronts plan_fronts(const Compressed& lower, const Compressed& border, std::span<const int> slots, Precision precision) {
  const Graph graph = graph_of(lower.size, lower.first, lower.index);
  Fronts best;
  for (const auto& ordering : {minimum_degree, nested_dissection}) {
    std::vector<int> order = ordering(graph);
    if (order.size() != graph.weight.size()) continue;
    Fronts plan;
    plan.precision = precision;
    add_fronts(graph, std::move(order), plan);
    std::vector<int> front_of(plan.place.size());
    for (std::size_t s = 0; s < plan.fronts.size(); ++s)
      std::fill_n(front_of.begin() + plan.fronts[s].first, plan.fronts[s].columns, static_cast<int>(s));
    add_descent(plan);
    add_border(border, front_of, plan);
    add_runs(plan);
    if (!best.fronts.empty() && best.work() <= plan.work()) continue;
    add_parts(plan);
    add_places(plan);
    add_slots(slots, plan);
    add_entries(lower, border, front_of, plan);
    best = std::move(plan);
  }
  return best;
}

}  // namespace sinew::linalg
