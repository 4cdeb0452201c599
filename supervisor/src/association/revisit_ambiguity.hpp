// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "helixnav/association/innovation_problem.hpp"
#include "helixnav/association/landmark_life.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/events.hpp"

namespace helixnav::supervisor {

/// Mature landmarks unseen over a drive of `old_after_m`, ascending.
std::vector<core::LandmarkId> old_landmarks(const association::LandmarkLife& life, double old_after_m);

/// An old landmark that an observation would be matched to, and what else may be in its gate.
struct RevisitAmbiguity {
  core::LandmarkId landmark = core::no_landmark;
  /// η = neighbours + extraneous density × area of the gate, each weighted by how much less likely it is to look like
  /// the observation, if class and size are given.
  double expected_confusers = 0.0;
  int neighbours = 0;  ///< other old landmarks in its 95 % gate, or that the observation may also be of
  /// π·5.99·(√|S| − √|R|) in the units of the observation: what the pose's uncertainty adds to the gate. Clutter in the
  /// part due to the sensor's noise does not depend on the pose.
  double gate_area = 0.0;
  double widening = 1.0;            ///< √(|S|/|R|): how much wider the gate is than sensor noise alone would make it
  double extraneous_density = 0.0;  ///< of objects in no map where it is expected, per unit of the observation space
  bool is_mature = true;            ///< a search can begin only for a mature one
};

/// √(|S|/|R|) above which a landmark counts as old, however short the drive since it was seen: a vehicle that turns on
/// the spot covers no distance, and yet may no longer know where it is looking. This is what old_after_m of driving
/// leads to with usual odometry.
/// Measured: docs/adr/0014-ambiguous-pose.md.
inline constexpr double drifted_widening = 8.0;

/// Landmarks with a pair whose gate is wider than that, mature or not. Ascending. O(pairs).
/// Test: supervisor/association/drifted_test.cpp.
std::vector<core::LandmarkId> drifted_from(const association::InnovationProblem& problem, const core::Scan& scan);

/// Mature landmarks that a search beginning with this scan leaves out: old ones, and those for which an observation
/// with the noise of the scan's first one would have such a gate. Ascending. O(q) for each landmark that is not old.
/// Test: supervisor/association/drifted_test.cpp.
std::vector<core::LandmarkId> old_or_drifted(const cekf::CompressedEkf& filter, const association::LandmarkLife& life,
                                             const core::Scan& scan, double old_after_m);

/// Every old landmark that has an observation in its gate, ascending. P(wrong | matched) is about η/(P_D + η): η
/// is the risk of associating scan by scan. `old` ascending.
/// Cost: gated pairs × old landmarks in view, and nothing as long as no old landmark is gated.
/// Source: PROTOTYPE §2. Test: supervisor/association/revisit_ambiguity_test.cpp.
std::vector<RevisitAmbiguity> returns_in_gate(const cekf::CompressedEkf& filter,
                                              const association::InnovationProblem& problem, const core::Scan& scan,
                                              const std::vector<core::LandmarkId>& old, double extraneous_per_scan,
                                              const core::MapAppearance& appearance = {});

/// The part of η due to extraneous objects, if the pair's innovation has covariance S.
/// Test: supervisor/association/place_evidence_test.cpp.
double extraneous_in_gate(const association::InnovationProblem& problem, const association::GatedPair& pair,
                          const Eigen::Matrix2d& S, const core::Scan& scan, double extraneous_per_scan);

/// The mature one with the largest η; null if there is none.
const RevisitAmbiguity* most_ambiguous(const std::vector<RevisitAmbiguity>& returns);

}  // namespace helixnav::supervisor
