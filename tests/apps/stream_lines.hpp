// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace helixnav::apps {

/// The first `seconds` of the log that new-vehicle writes, as lines in time order; one scan per line.
std::vector<std::string> lines_of(const std::filesystem::path& log, double seconds);

/// The cells of a row of a table without quotes.
std::vector<std::string> columns_of(const std::string& row);

}  // namespace helixnav::apps
