// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <limits>
#include <string_view>
#include <vector>

#include "helixnav/association/innovation_problem.hpp"
#include "helixnav/association/likelihood_ratio.hpp"
#include "helixnav/core/landmark_id.hpp"

namespace helixnav::association {

enum class Method {
  nearest_neighbour,         ///< each observation takes its nearest landmark; two may take the same
  nearest_neighbour_unique,  ///< the nearest pair of all first, then the nearest of the rest
  likelihood_ratio,          ///< optimal assignment with likelihood-ratio costs
  jcbb,                      ///< most pairs that are jointly compatible, then least joint NIS
  joint_likelihood_ratio,    ///< assignment with the best likelihood ratio of all pairs together
  ihgr_published,            ///< linear programme with the cost and the gate 6.63 of ihgr_zhang2005
  ihgr_likelihood_ratio,     ///< the same linear programme with likelihood-ratio costs
};

/// Names as on the command line: "nearest-neighbour", "likelihood-ratio", "jcbb", …
std::string_view name(Method method);

struct Options {
  double detection_probability = 0.9;  ///< P_D of a landmark of the map in one scan
  ExtraneousDensity extraneous;
  bool joint_test = true;             ///< false: accept a set of pairs that is not jointly compatible
  double joint_probability = 0.99;    ///< the set's joint NIS must not exceed this χ² quantile
  int joint_alternatives = 10;        ///< likelihood-ratio assignments tried, best first, when the joint test fails
  double min_margin_nats = 0.0;       ///< a match whose best alternative is closer than this is ambiguous; 0: none
  std::int64_t node_budget = 30'000;  ///< nodes of JCBB (at most 10 ms), combinations of IHGR's tie rule
};

enum class Outcome {
  matched,       ///< observation of the landmark named
  new_landmark,  ///< far from every landmark
  ambiguous,     ///< neither near nor far enough, margin too small, or dropped by the joint test: not to be used
};

/// What became of one observation, with the numbers that decided it.
struct ObservationOutcome {
  Outcome outcome = Outcome::ambiguous;
  /// Matched landmark; for an ambiguous observation the one it was dropped from, else the nearest.
  core::LandmarkId landmark = core::no_landmark;
  int candidate = -1;                                     ///< index into InnovationProblem::ids
  int pair = -1;                                          ///< index into InnovationProblem::pairs
  double nis = std::numeric_limits<double>::quiet_NaN();  ///< to the landmark named; NaN without one
  int dof = 0;
  /// Likelihood-ratio cost of the best alternative minus that of the choice: for the likelihood-ratio methods, over the
  /// assignment of the whole scan; for the others, over what the other observations leave for this one, where it may be
  /// negative; +inf without an alternative.
  double margin_nats = std::numeric_limits<double>::infinity();
  bool dropped_by_joint_test = false;
};

struct Assignment {
  std::vector<ObservationOutcome> observations;  ///< in the order of the scan
  std::vector<int> pairs;  ///< the matched pairs, indices into InnovationProblem::pairs, by observation
  double joint_nis = 0.0;  ///< of the matched set
  int joint_dof = 0;
  double first_joint_nis = 0.0;  ///< of the set before the joint test changed it
  int first_joint_dof = 0;
  int dropped_pairs = 0;    ///< by the joint test
  int alternative = 0;      ///< 0: the method's own first choice; k: its k-th alternative passed the joint test
  std::int64_t nodes = 0;   ///< of the search, where there was one
  bool budget_hit = false;  ///< the search ended early: best found, not proven best
  int roundings = 0;        ///< variables that IHGR rounded; 0 for an integral solution
};

/// Which observation belongs to which landmark. An empty scan gives an empty assignment; without candidates every
/// observation is new. Throws PreconditionError for options outside their range, NumericalError when a joint covariance
/// is not positive definite or CLP fails. Never runs longer than the node budget allows.
/// Tests: association/associate_test.cpp, and one file per method.
Assignment associate(Method method, const InnovationProblem& problem, const Options& options = {});

}  // namespace helixnav::association
