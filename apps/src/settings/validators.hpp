// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <sstream>
#include <string>
#include <type_traits>
#include <vector>

#include <CLI/CLI.hpp>

#include "helixnav/core/nearest_name.hpp"

namespace helixnav::apps {

/// A number from `low` to `high`; NaN is outside. CLI::Range lets NaN through and prints bounds with six decimals.
template <typename T>
CLI::Validator number_between(T low, T high) {
  std::ostringstream range;
  range.precision(10);
  range << low << " to " << high;
  const auto objection = [low, high, range = range.str()](std::string& word) -> std::string {
    T value{};
    const bool wraps = std::is_unsigned_v<T> && word.find('-') != std::string::npos;  // "-1" would be 2^64 - 1
    if (!wraps && CLI::detail::lexical_cast(word, value) && value >= low && value <= high) return {};
    return std::string("expected ") + (std::is_integral_v<T> ? "a whole number" : "a number") + " from " + range +
           ", found '" + word + "'";
  };
  return CLI::Validator(objection, range.str());
}

/// Numbers of robots of a log, separated by commas: CLI11 skips an empty one.
inline CLI::Validator robot_numbers() {
  const auto objection = [](std::string& word) -> std::string {
    constexpr std::size_t most_digits = 6;
    std::size_t digits = 0;
    bool right = true;
    for (const char c : word + ',') {
      const bool is_digit = c >= '0' && c <= '9';
      right = right && (is_digit ? digits < most_digits : c == ',' && digits > 0);
      digits = is_digit ? digits + 1 : 0;
    }
    return right ? std::string() : "expected numbers of robots, as 1,3, found '" + word + "'";
  };
  return CLI::Validator(objection, "");
}

/// One of these words; the objection names one that is near.
inline CLI::Validator one_of(const std::vector<std::string>& words) {
  const auto objection = [words](std::string& word) -> std::string {
    if (std::find(words.begin(), words.end(), word) != words.end()) return {};
    const std::string near = core::near_name(word, words);
    return "unknown name '" + word + '\'' + (near.empty() ? "." : "; did you mean '" + near + "'?") +
           " Known are: " + CLI::detail::join(words, ", ");
  };
  return CLI::Validator(objection, "{" + CLI::detail::join(words, ",") + "}");
}

}  // namespace helixnav::apps
