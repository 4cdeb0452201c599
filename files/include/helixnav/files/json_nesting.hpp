// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace helixnav::files {

/// Throws InputError ("path:line: …") if brackets of the JSON text nest deeper than 64: writing such a value out again
/// costs a stack frame per level and an indentation per line. Our own files nest up to 4. Does not check whether the
/// text is JSON. Test: runs/run_folder_test.cpp.
void check_json_nesting(const std::string& path, std::string_view text);

}  // namespace helixnav::files
