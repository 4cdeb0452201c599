// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace helixnav::core {

/// The candidate with the fewest letters to insert, delete or replace (Levenshtein distance), the first of equals: what
/// an error about an unknown name suggests. Empty without candidates. Cost: letters × letters per candidate.
/// Test: core/nearest_name_test.cpp.
std::string nearest_name(std::string_view name, const std::vector<std::string>& candidates);

/// The nearest candidate if it may have been meant: half of the letters of the longer one, a common section ("search.") not counted,
/// are those of the other, in order. Otherwise empty.
std::string near_name(std::string_view name, const std::vector<std::string>& candidates);

/// Letters to insert, delete or replace to make one of the other (Levenshtein distance).
std::size_t edit_distance(std::string_view a, std::string_view b);

}  // namespace helixnav::core
