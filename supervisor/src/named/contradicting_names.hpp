// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/supervisor/slip_options.hpp"

namespace helixnav::supervisor {

/// A sighting that was given a name, and contradicts the prediction and all others of its scan.
struct ContradictingName {
  std::size_t match = 0;  ///< index
  double nis = 0.0;       ///< of the sighting, given the others that do not contradict
  int dof = 0;
};

/// What names are weighed by.
struct AssumedOfNames {
  core::FieldOfView view;
  double reach_m = 0.0;      ///< of a sensor that does not say
  double wrong = 0.0;        ///< share of sightings that are of something else, as NameOptions, above 0
  double noise_scale = 1.0;  ///< of S, which noise that is stated too small makes too small
};

/// νᵀS⁻¹ν that a scan has with right names but once in a thousand.
double usual_nis(const std::vector<cekf::Match>& matches);

/// Which sightings rather show something else than the landmark of their name. A share w does, anywhere in view with the same
/// density u: a name is wrong where w·u is above N(ν; S) of the sighting given all others. The least likely one is left out
/// first, then what the rest say is asked again. None where all of them are right and the vehicle is far from where it is
/// predicted, so that they are only not linear. O(m³), m rows of all sightings.
/// Source: docs/names.md. Test: supervisor/named/contradicting_names_test.cpp.
std::vector<ContradictingName> contradicting_names(const cekf::CompressedEkf& filter,
                                                   const std::vector<cekf::Match>& matches,
                                                   const AssumedOfNames& assumed);

/// ln of how much likelier all sightings are with right names after a slip, of which one motion in a thousand has one, than without
/// and with `contradicting` of something else. A slip moves and turns by options.middle_m and 5° (standard deviations), linearised.
/// Test: supervisor/named/contradicting_names_test.cpp.
double nats_for_slip(const cekf::CompressedEkf& filter, const std::vector<cekf::Match>& matches,
                     const std::vector<ContradictingName>& contradicting, const AssumedOfNames& assumed,
                     const SlipOptions& options);

/// Whether all sightings agree about some pose within reach of the predicted one, whatever the motion was, and are more rows than a pose
/// has unknowns. Test: supervisor/named/contradicting_names_test.cpp.
bool agree_about_a_pose(const cekf::CompressedEkf& filter, const std::vector<cekf::Match>& matches,
                        const AssumedOfNames& assumed);

}  // namespace helixnav::supervisor
