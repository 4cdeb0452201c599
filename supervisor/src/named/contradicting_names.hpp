// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/supervisor/name_integrity.hpp"
#include "helixnav/supervisor/slip_options.hpp"

namespace helixnav::supervisor {

/// A named sighting that contradicts the prediction and all other sightings of its scan.
struct ContradictingName {
  std::size_t match = 0;  ///< index
  double nis = 0.0;       ///< of the sighting, given the others that do not contradict
  int dof = 0;
};

/// The assumptions by which names are weighed.
struct AssumedOfNames {
  core::FieldOfView view;
  double reach_m = 0.0;      ///< of a sensor that does not report it
  double wrong = 0.0;        ///< share of sightings that are of something else, as in NameOptions, above 0
  double noise_scale = 1.0;  ///< of S, which is too small if the assumed noise is too small
};

/// νᵀS⁻¹ν that a scan with right names exceeds only once in a thousand times.
double usual_nis(const std::vector<cekf::Match>& matches);

/// Which sightings more likely show something else than the landmark of their name. A share w does, anywhere in view
/// with the same density u: a name is wrong if w·u exceeds N(ν; S) of the sighting given all others. The least likely
/// one is left out first, then the rest are tested again. None if all of them are right and the vehicle is far from its
/// predicted pose, so that they are merely nonlinear. O(m³), m rows of all sightings.
/// Source: docs/names.md. Test: supervisor/named/contradicting_names_test.cpp.
std::vector<ContradictingName> contradicting_names(const cekf::CompressedEkf& filter,
                                                   const std::vector<cekf::Match>& matches,
                                                   const AssumedOfNames& assumed);

/// ln of how much likelier all sightings are with right names after a slip (one motion in a thousand has one) than
/// without a slip and with `contradicting` of something else. A slip moves and turns by options.middle_m and 5°
/// (standard deviations), linearised. Test: supervisor/named/contradicting_names_test.cpp.
double nats_for_slip(const cekf::CompressedEkf& filter, const std::vector<cekf::Match>& matches,
                     const std::vector<ContradictingName>& contradicting, const AssumedOfNames& assumed,
                     const SlipOptions& options);

/// Whether all sightings agree on some pose within reach of the predicted one, whatever the motion was, and have more
/// rows than a pose has unknowns. Test: supervisor/named/contradicting_names_test.cpp.
bool agree_about_a_pose(const cekf::CompressedEkf& filter, const std::vector<cekf::Match>& matches,
                        const AssumedOfNames& assumed);

/// What a contradicting sighting says about where its landmark is instead. `landmark`: as known outside the filter.
ContradictedName contradicted_name(const cekf::CompressedEkf& filter, const cekf::Match& match,
                                   const core::FieldOfView& view, core::LandmarkId landmark);

}  // namespace helixnav::supervisor
