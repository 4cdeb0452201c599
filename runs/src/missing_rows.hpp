// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace helixnav::runs {

/// What summary.json says of a run that came to its end.
struct SaidOfRun {
  std::optional<std::size_t> steps;
  std::optional<std::size_t> landmarks;
};

/// Nothing where the file says nothing of it or is no JSON. InputError when it cannot be read.
SaidOfRun read_said(const std::string& path);

/// Adds a sentence with file and numbers where a table has fewer rows than there must be. Test: runs/run_folder_test.cpp.
void tell_missing(const std::string& folder, std::string_view table, std::size_t found, std::size_t expected,
                  std::vector<std::string>& missing);

}  // namespace helixnav::runs
