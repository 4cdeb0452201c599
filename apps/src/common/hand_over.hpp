// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace helixnav::apps {

/// Replaces this process by `program` with these arguments: the one next to this program, else the one on PATH. Returns
/// only by throwing: core::InputError if there is none. Whatever needs MRPT is a separate program, because loading its
/// libraries takes longer than most of what this one does (docs/adr/0004-where-mrpt-may-appear.md).
[[noreturn]] void hand_over(const std::string& program, const std::vector<std::string>& arguments);

}  // namespace helixnav::apps
