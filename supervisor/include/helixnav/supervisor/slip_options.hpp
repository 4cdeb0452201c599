// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::supervisor {

/// Motion that odometry did not measure: a slip of the wheels, a push. When a scan sees landmarks beside where they are
/// expected, "slipped" is weighed against "as measured" by the evidence of each. Lengths stand here for a sensor of
/// reference_reach_m (lengths.hpp). Figures: docs/slips.md.
struct SlipOptions {
  bool enabled = true;

  // The mixture of slips that may happen between two scans: standard deviations of position. Those of heading and the
  // probabilities: slip_evidence.cpp.
  double small_m = 0.25;
  double middle_m = 0.7;
  double large_m = 2.0;

  double distinct_m = 0.5;  ///< places farther apart than that are rivals

  // What an accepted slip is ahead by, in nats.
  double nats = 8.0;             ///< of what was associated without a slip
  double same_pairs_nats = 4.0;  ///< of the same pairs without a slip
  double rival_nats = 6.9;       ///< of a slip to any other place: a thousand to one
  double few_pairs_nats = 15.0;  ///< instead of `nats`, where it rests on three pairs only
  double tentative_nats = 25.0;  ///< instead of `nats`, where it rests on landmarks seen only once
  int least_pairs = 4;
};

}  // namespace helixnav::supervisor
