// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace helixnav::apps {

/// InputError where writing a run folder `out` would replace or remove what it is made of: `out` is the folder of a log or
/// of an earlier run, or a file that is read lies in it under a name that a run folder uses, followed through symbolic links.
/// Killed meanwhile, the new run would leave neither. Nothing for empty names and for what is not there. Reads no file.
/// Test: apps/kept_inputs_test.cpp.
void refuse_to_replace(const std::vector<std::string>& inputs, const std::string& out);

}  // namespace helixnav::apps
