// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace helixnav::files {

/// Throws InputError ("path:line: …") where brackets of the JSON text nest deeper than 64: writing such a value again costs
/// a stack frame a level and an indentation a line. Our own files nest up to 4. Says nothing of texts that are no JSON.
/// Test: runs/run_folder_test.cpp.
void check_json_nesting(const std::string& path, std::string_view text);

}  // namespace helixnav::files
