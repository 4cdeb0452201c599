// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tree/state.hpp"

namespace helixnav::atlas {

/// Brings the values near the solution from where a closing has torn them apart. Every node is linearised at the present values, so that
/// no message is carried far; every part is weighed as Cauchy's cost weighs it, since what is torn by tens of metres is linearised
/// where its lever arms are wrong and must not bend the drive; and of the step so much is made, halved as often as need be, as keeps a tenth
/// of what the linear problem promises. Ends where nothing is torn and a step promises no more than one of χ²; then
/// all is to be eliminated again. Cost: the whole tree a round. NumericalError where no step leads nearer, or after
/// options.max_rounds. Test: atlas/damped_test.cpp.
void damp(State& state, int& redone);

}  // namespace helixnav::atlas
