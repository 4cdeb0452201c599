// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string_view>

namespace helixnav::logs {

/// Whether cells and structures of one element of a MATLAB file of version 5 nest deeper than 8, or hold more than 64 MiB
/// where they are compressed: matio descends into them by recursion, as deep as the file says. `element` begins at its tag.
bool nests_too_deep(std::string_view element, bool little_endian);

/// Number of 32 bits at a place of the file.
std::size_t unsigned32(std::string_view content, std::size_t at, bool little_endian);

}  // namespace helixnav::logs
