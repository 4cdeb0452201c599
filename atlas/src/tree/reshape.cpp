// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/atlas/atlas.hpp"
#include "solve/settle.hpp"
#include "tree/lay_out.hpp"

namespace helixnav::atlas {

void Atlas::reshape() {
  finish_descent(*working_);
  if (working_->root >= 0) lay_out(*working_, working_->root);
}

void Atlas::forget(core::LandmarkId id) {
  finish_descent(*working_);
  for (State* state : {working_.get(), settled_.get()}) {
    if (id < 0 || id >= static_cast<int>(state->variable_of_landmark.size())) continue;
    const int v = state->variable_of_landmark[State::index(id)];
    if (v < 0) continue;
    state->variable_of_landmark.write(State::index(id)) = -1;
    if (state->variable(v).name == id) state->variables.write(State::index(v)).name = -1;
  }
}

}  // namespace helixnav::atlas
