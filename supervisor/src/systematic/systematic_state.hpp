// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "loop/tape.hpp"
#include "systematic/odd_closing.hpp"
#include "systematic/systematic_learner.hpp"

namespace helixnav::supervisor {

/// What is known of systematic errors, and where on the tape and on the road the present stretch began.
struct SystematicState {
  SystematicLearner learner;
  std::optional<Tape::Position> begun;
  double begun_m = 0.0;
  Tape::Position read = 0;  ///< up to here nothing interrupts the stretch
  OddClosing odd;           ///< the last one; what odometry was allowed for it is on the tape

  /// What refers to the present tape, if another takes its place.
  void leave_tape() {
    begun.reset();
    odd = {};
  }

  void begin(Tape::Position position, double path_m) {
    begun = read = position;
    begun_m = path_m;
  }
};

}  // namespace helixnav::supervisor
