// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace helixnav::apps {

/// Runs `program` with these arguments in place of this process: the one that stands beside this program, else the one
/// on PATH. Returns only by throwing: core::InputError when there is none. What needs MRPT is a program of its own,
/// because loading its libraries takes longer than most of what this one does (docs/adr/0004-where-mrpt-may-appear.md).
[[noreturn]] void hand_over(const std::string& program, const std::vector<std::string>& arguments);

}  // namespace helixnav::apps
