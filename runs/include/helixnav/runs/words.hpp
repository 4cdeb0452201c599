// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

#include "helixnav/core/step_report.hpp"

namespace helixnav::runs {

/// Enumerators by name, in the order of their declaration in core.
inline constexpr std::array<std::string_view, 4> outcome_words{"matched", "augmented", "ambiguous", "rejected"};
inline constexpr std::array<std::string_view, 3> state_words{"tentative", "mature", "dead"};
inline constexpr std::array<std::string_view, 2> mode_words{"mapping", "searching"};

template <typename Enum, std::size_t n>
std::string_view word_of(const std::array<std::string_view, n>& words, Enum value) {
  return words[static_cast<std::size_t>(value)];
}

template <typename Enum, std::size_t n>
std::optional<Enum> value_of(const std::array<std::string_view, n>& words, std::string_view word) {
  for (std::size_t i = 0; i < n; ++i) {
    if (words[i] == word) return static_cast<Enum>(i);
  }
  return std::nullopt;
}

}  // namespace helixnav::runs
