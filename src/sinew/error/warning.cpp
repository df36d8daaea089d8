#include "sinew/error/warning.hpp"

#include <algorithm>
#include <cstdio>

#include "sinew/error/printable.hpp"

namespace sinew {

namespace {

bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

}  // namespace

bool Warning::operator==(const Warning& other) const {
  return code == other.code && where == other.where && message == other.message && remedy == other.remedy &&
         same(time, other.time) && same(value, other.value) && same(limit, other.limit) && unit == other.unit &&
         steps == other.steps && latest == other.latest;
}

std::string to_string(const Warning& warning) {
  std::string text = warning.where.empty() ? "" : warning.where + ": ";
  text += warning.message;
  if (std::isfinite(warning.time)) {
    char when[48];
    std::snprintf(when, sizeof when, " (from t = %.4g s)", warning.time);
    text += when;
  }
  if (!warning.remedy.empty()) text += "; " + warning.remedy;
  return printable(text);
}

std::vector<std::string> to_strings(const std::vector<Warning>& warnings) {
  std::vector<std::string> texts;
  for (const Warning& warning : warnings) texts.push_back(to_string(warning));
  return texts;
}

void merge(const Warning& warning, std::vector<Warning>& list) {
  const auto same_kind = [&](const Warning& earlier) {
    return earlier.code == warning.code && earlier.where == warning.where;
  };
  const auto found = std::find_if(list.begin(), list.end(), same_kind);
  if (found == list.end()) {
    list.push_back(warning);
    return;
  }
  found->steps += warning.steps;
  if (warning.latest || std::abs(warning.value) > std::abs(found->value)) {
    found->message = warning.message;
    found->remedy = warning.remedy;
    found->value = warning.value;
    found->limit = warning.limit;
  }
}

void merge(const std::vector<Warning>& warnings, std::vector<Warning>& list) {
  for (const Warning& warning : warnings) merge(warning, list);
}

const Warning* find_warning(const std::vector<Warning>& list, const std::string& code, const std::string& where) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const Warning& own) {
    return own.code == code && (where.empty() || own.where == where);
  });
  return found == list.end() ? nullptr : &*found;
}

}  // namespace sinew
