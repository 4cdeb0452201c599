// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "helixnav/logs/sick_scan.hpp"

namespace helixnav::logs {

inline constexpr const char* laser_file = "LASER.txt";

/// The scans of ACFR's LASER.txt: a time [s] and 361 ranges [m] each, all on one line.
std::vector<SickScan> parse_laser_text(std::string_view text, const std::string& file_name);

/// The scans of LASER.txt in `folder`, else of the one in victoria_park_ascii.zip there, else none.
std::vector<SickScan> find_laser_text(const std::filesystem::path& folder);

}  // namespace helixnav::logs
