// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/runs/run_manifest.hpp"

namespace helixnav::apps {

/// The file, or the files of the folder in order of name, with their digests. InputError if one cannot be read.
std::vector<runs::InputFile> input_files(const std::string& path);

}  // namespace helixnav::apps
