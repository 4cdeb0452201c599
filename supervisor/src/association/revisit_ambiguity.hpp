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
  /// η = neighbours + extraneous density × area of the gate, each weighted by how much less likely it is to look so, where
  /// class and size are given.
  double expected_confusers = 0.0;
  int neighbours = 0;  ///< other old landmarks in its 95 % gate, or that the observation may be as well
  /// π·5.99·(√|S| − √|R|) in the units of the observation: what the pose's uncertainty adds to the gate. Clutter in the
  /// part due to the sensor's noise does not depend on the pose.
  double gate_area = 0.0;
  double widening = 1.0;  ///< √(|S|/|R|): how much wider the gate is than the sensor's noise makes it
};

/// Every old landmark that has an observation in its gate, ascending. P(wrong | matched) is about η/(P_D + η): η
/// is the risk of associating scan by scan. `old` ascending.
/// Cost: gated pairs × old landmarks in view, and nothing as long as no old landmark is gated.
/// Source: PROTOTYPE §2. Test: supervisor/association/revisit_ambiguity_test.cpp.
std::vector<RevisitAmbiguity> returns_in_gate(const cekf::CompressedEkf& filter,
                                              const association::InnovationProblem& problem, const core::Scan& scan,
                                              const std::vector<core::LandmarkId>& old, double extraneous_per_scan,
                                              const core::MapAppearance& appearance = {});

/// The part of η that objects of no landmark make up, where the pair's innovation has covariance S.
/// Test: supervisor/association/place_evidence_test.cpp.
double extraneous_in_gate(const association::InnovationProblem& problem, const association::GatedPair& pair,
                          const Eigen::Matrix2d& S, const core::Scan& scan, double extraneous_per_scan);

/// The one with the largest η; null when there is none.
const RevisitAmbiguity* most_ambiguous(const std::vector<RevisitAmbiguity>& returns);

}  // namespace helixnav::supervisor
