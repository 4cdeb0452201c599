// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace helixnav::supervisor {

/// Motion that odometry did not measure: wheel slip, a push. When a scan sees landmarks away from where they are
/// expected, "slipped" is weighed against "as measured" by the evidence for each. Lengths here are for a sensor with a
/// reach of reference_reach_m (lengths.hpp). Figures: docs/slips.md.
struct SlipOptions {
  bool enabled = true;

  // The mixture of slips that may occur between two scans: standard deviations of position. For those of heading and
  // the probabilities see slip_evidence.cpp.
  double small_m = 0.25;
  double middle_m = 0.7;
  double large_m = 2.0;

  double distinct_m = 0.5;  ///< places farther apart than this are rivals

  // The lead that a slip needs to be accepted, in nats.
  double nats = 8.0;             ///< over what was associated without a slip
  double same_pairs_nats = 4.0;  ///< over the same pairs without a slip
  double rival_nats = 6.9;       ///< over a slip to any other place: a thousand to one
  double few_pairs_nats = 11.0;  ///< instead of `nats`, if it rests on only three pairs
  double tentative_nats = 25.0;  ///< instead of `nats`, if it rests on landmarks seen only once
  int least_pairs = 4;
};

}  // namespace helixnav::supervisor
