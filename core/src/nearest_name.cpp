// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/nearest_name.hpp"

#include <algorithm>
#include <numeric>

namespace helixnav::core {
namespace {

/// Letters that both have, in the same order.
std::size_t common_letters(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1, 0);
  for (const char letter : a) {
    std::size_t diagonal = 0;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t with_it = letter == b[j - 1] ? diagonal + 1 : 0;
      diagonal = row[j];
      row[j] = std::max({with_it, row[j], row[j - 1]});
    }
  }
  return row[b.size()];
}

/// Length of the section that both begin with, as "search.".
std::size_t common_section(std::string_view a, std::string_view b) {
  const std::size_t dot = a.rfind('.');
  return dot != std::string_view::npos && b.substr(0, dot + 1) == a.substr(0, dot + 1) ? dot + 1 : 0;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);  // distances from the letters of `a` so far to each beginning of `b`
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates) {
  const auto nearest = std::min_element(candidates.begin(), candidates.end(), [&](const auto& a, const auto& b) {
    return edit_distance(name, a) < edit_distance(name, b);
  });
  return nearest == candidates.end() ? std::string() : *nearest;
}

std::string near_name(std::string_view name, const std::vector<std::string>& candidates) {
  const std::string nearest = nearest_name(name, candidates);
  const std::size_t section = common_section(name, nearest);
  const std::string_view a = name.substr(section), b = std::string_view(nearest).substr(section);
  return 2 * common_letters(a, b) >= std::max(a.size(), b.size()) ? nearest : std::string();
}

}  // namespace helixnav::core
