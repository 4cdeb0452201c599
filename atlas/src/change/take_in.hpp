// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tree/state.hpp"

namespace helixnav::atlas {

/// Adds what a phase says about the landmarks of another one, `host`, to a part of `host`. The phase is derived once more where it is now; its
/// entry, its exit and its other landmarks are marginalised as if nothing else held them, and what is left is information on landmarks,
/// whatever frame they are in. It is kept relative to a frame of its own, a pose tied to them only by a gauge, so that it turns with them and
/// does not constrain any heading. False, and nothing done, if that is not determined. The values of both have to be up to date.
/// Test: atlas/condense_test.cpp.
bool take_in(State& state, int host, int phase);

}  // namespace helixnav::atlas
