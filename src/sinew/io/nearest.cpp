#include "sinew/io/nearest.hpp"

#include <algorithm>
#include <numeric>

namespace sinew::io {

int edit_distance(std::string_view a, std::string_view b) {
  // Optimal string alignment, one row of the table at a time: row[j] is the distance of a[0..i) and b[0..j).
  std::vector<int> before_last, last(b.size() + 1), row(b.size() + 1);
  std::iota(last.begin(), last.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = static_cast<int>(i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const int replace = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replace});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before_last[j - 2] + 1);
      }
    }
    before_last = last;
    last = row;
  }
  return last[b.size()];
}

namespace {

bool same_but_for_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; };
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return lower(x) == lower(y); });
}

}  // namespace

std::string nearest(std::string_view word, const std::vector<std::string>& known) {
  constexpr std::size_t longest = 64;  // beyond, it is no misspelling and not worth the time
  std::string best;
  if (word.size() > longest) return best;
  int fewest = std::max(1, static_cast<int>(word.size()) / 3) + 1;
  for (const std::string& candidate : known) {
    if (candidate.size() > longest) continue;
    const int edits = same_but_for_case(word, candidate) ? 0 : edit_distance(word, candidate);
    if (edits < fewest && edits < static_cast<int>(std::max(word.size(), candidate.size()))) {
      fewest = edits;
      best = candidate;
    }
  }
  return best;
}

}  // namespace sinew::io
