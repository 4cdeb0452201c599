// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/cekf/match.hpp"
#include "helixnav/cekf/update_workspace.hpp"

namespace helixnav::cekf {

/// Throws PreconditionError naming the verb and the landmark when the observation cannot be used.
void check_observation_of(const Match& match, const char* verb);

/// "<verb>: <what>; landmarks <ids involved>".
std::string problem_with(const UpdateWorkspace& w, const char* verb, const char* what);

}  // namespace helixnav::cekf
