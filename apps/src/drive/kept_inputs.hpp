// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace helixnav::apps {

/// InputError if writing a run folder `out` would replace or remove its own inputs: `out` is the folder of a log or of an
/// earlier run, or an input file is in it under a name that a run folder uses, with symbolic links resolved. Killed
/// meanwhile, the new run would leave neither. Empty names and missing files are ignored. Reads no file.
/// Test: apps/kept_inputs_test.cpp.
void refuse_to_replace(const std::vector<std::string>& inputs, const std::string& out);

}  // namespace helixnav::apps
