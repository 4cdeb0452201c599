// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string_view>

namespace helixnav::logs {

/// What is wrong with one element of a version 5 MATLAB file, empty if nothing is. Allowed are cells and structures
/// that nest at most 8 deep and hold at most 64 MiB if compressed, since matio descends into them by recursion, as deep
/// as the file says; at most 32 dimensions, a name of at most 1024 bytes, and no more cells and fields than there are
/// bytes for, since it allocates them all before it reads the first. `element` starts at its tag. Test:
/// logs/hostile_file_test.cpp.
std::string_view broken_bound(std::string_view element, bool little_endian);

/// The 32-bit number at a position in the file.
std::size_t unsigned32(std::string_view content, std::size_t at, bool little_endian);

}  // namespace helixnav::logs
