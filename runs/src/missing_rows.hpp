// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace helixnav::runs {

/// What summary.json records of a run that finished.
struct SaidOfRun {
  std::optional<std::size_t> steps;
  std::optional<std::size_t> landmarks;
  std::vector<std::pair<std::string, std::size_t>> rows;  ///< of tables by their names without .csv
};

/// Nothing if the file does not state it or is not JSON. InputError when it cannot be read.
SaidOfRun read_said(const std::string& path);

/// Adds a sentence if one of these tables exists and has fewer rows.
void tell_missing_rows(const std::string& folder, const SaidOfRun& said, std::vector<std::string>& missing);

/// Adds a sentence if drive.bin exists and ends within a scan, or has fewer scans than the run has steps. The content
/// of its blocks is not checked. Test: runs/drive_file_test.cpp.
void tell_cut_drive(const std::string& folder, std::size_t steps, std::vector<std::string>& missing);

/// Adds a sentence with file and numbers if a table has fewer rows than it must have. Test:
/// runs/cut_run_folder_test.cpp.
void tell_missing(const std::string& folder, std::string_view table, std::size_t found, std::size_t expected,
                  std::vector<std::string>& missing);

}  // namespace helixnav::runs
