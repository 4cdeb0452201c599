// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace helixnav::core {

/// Version of this library, "major.minor.patch".
std::string_view version();

/// Abbreviated git commit of the sources, read when the library is built; ends in "+changes" when tracked files
/// differed from that commit, "unknown" when the sources were not a git checkout.
std::string_view commit();

}  // namespace helixnav::core
