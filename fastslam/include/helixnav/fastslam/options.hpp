// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>

namespace helixnav::fastslam {

/// Where new poses are drawn from.
enum class Proposal {
  motion,           ///< FastSLAM 1.0: odometry alone; the scan only weighs
  motion_and_scan,  ///< FastSLAM 2.0: odometry corrected by the landmarks that the scan matched
};

/// How a particle decides which of its landmarks an observation belongs to.
enum class Association {
  known,               ///< given by the caller
  nearest_neighbour,   ///< least normalised distance within the gate
  likelihood_ratio,    ///< best likelihood ratio first, while it favours a match
  sampled,             ///< drawn with the probabilities of the alternatives
  multiple_hypotheses  ///< one child for each alternative: n matches, spurious, new
};

/// Evidence for a landmark's existence, kept by each particle (nats), as in association::LifeOptions.
struct ExistenceOptions {
  bool remove = true;                  ///< false: landmarks never die and are mature after `mature_looks`
  double detection_probability = 0.7;  ///< that an expected landmark is seen in one look
  double false_hit_probability = 0.1;  ///< that clutter stands in for one that does not exist
  double look_distance_m = 0.25;       ///< a look is what the sensor sees along this much of the drive
  double max_log_odds = 8.0;
  int mature_looks = 3;
  double mature_log_odds = 3.0;
  double tentative_death_log_odds = -2.0;
  double mature_death_log_odds = -6.0;
};

/// What Association::multiple_hypotheses adds.
struct HypothesisOptions {
  bool split_always = false;      ///< false: only where several landmarks are in the gate, as in the paper
  int resample_every_scans = 3;   ///< scans with observations between resamplings, instead of resample_below
  std::size_t most_children = 6;  ///< times `particles`: beyond, they are resampled at once
};

struct Options {
  std::size_t particles = 200;
  Proposal proposal = Proposal::motion_and_scan;
  Association association = Association::likelihood_ratio;

  double match_gate = 13.82;  ///< νᵀS⁻¹ν up to which a landmark is a match: χ²₂ at 0.999
  double new_gate = 23.03;  ///< beyond which of all, an observation is of something new (0.99999); between, of nothing
  bool exclusive = true;    ///< two observations of one scan are never of the same landmark

  double detection_probability = 0.9;  ///< that a landmark in the field of view is observed in one scan
  double new_density = 0.01;  ///< observations of new landmarks per scan and unit of z (m·rad, or m² if cartesian)
  double clutter_density = 0.01;  ///< observations of clutter, likewise
  bool weigh_unseen = true;       ///< weights include landmarks in view that were not seen; needs a bounded view

  double resample_below = 0.5;  ///< resample when the effective sample size falls below this share of `particles`
  HypothesisOptions hypotheses;
  ExistenceOptions existence;

  double added_sigma_m = 1e-3;  ///< noise added to the odometry of each scan, in x and in y: keeps the cloud alive
  double added_sigma_rad = 1e-4;
  double genealogy_m = 100.0;  ///< drive over which core::CloudReport::distinct_ancestors looks back: a loop's length
  unsigned threads = 1;        ///< results do not depend on it
};

}  // namespace helixnav::fastslam
