// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string_view>

namespace helixnav::logs {

/// What one element of a MATLAB file of version 5 should be and is not, empty where it is: cells and structures that nest at
/// most 8 deep and hold at most 64 MiB where they are compressed, since matio descends into them by recursion, as deep as the
/// file says; at most 32 dimensions, a name of at most 1024 bytes, and no more cells and fields than there are bytes for,
/// since it allocates them all before it reads the first. `element` begins at its tag. Test: logs/hostile_file_test.cpp.
std::string_view broken_bound(std::string_view element, bool little_endian);

/// Number of 32 bits at a place of the file.
std::size_t unsigned32(std::string_view content, std::size_t at, bool little_endian);

}  // namespace helixnav::logs
