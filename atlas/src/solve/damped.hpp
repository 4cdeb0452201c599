// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tree/state.hpp"

namespace helixnav::atlas {

/// Brings the values near the solution after a loop closure has torn them apart. Every node is linearised at the current values, so that no
/// message is carried far. Every part is weighted as Cauchy's cost weights it, since what is torn by tens of metres is linearised with wrong
/// lever arms and must not bend the drive. The step is halved as often as needed until the cost falls by a tenth of what the linear problem
/// promises. Ends when nothing is torn and a step promises no more than one unit of χ²; everything then has to be eliminated again. Cost:
/// the whole tree per round. NumericalError if no step leads nearer, or after options.max_rounds. Test: atlas/damped_test.cpp.
void damp(State& state, int& redone);

/// Settles a map near its solution, as damp() leaves it, by shortened steps alone, and linearises it there. For what ordinary passes do not
/// settle: a long road that next to nothing holds swings by tens of metres from pass to pass, while χ² hardly changes. Phases are not
/// derived again. Cost: the whole tree per round. NumericalError if a step still promises more than one unit of χ².
/// Test: atlas/damped_test.cpp.
void settle_damped(State& state, int& redone);

}  // namespace helixnav::atlas
