// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/runs/run_manifest.hpp"

namespace helixnav::runs {

/// Reads the output of manifest_json. InputError names `path`.
RunManifest manifest_from_text(const std::string& path, const std::string& text);

}  // namespace helixnav::runs
