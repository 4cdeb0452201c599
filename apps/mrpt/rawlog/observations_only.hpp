// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace helixnav::apps {

/// Writes the rawlog `in` as single observations: frames are split up, movements become CObservationOdometry, the sum of
/// all so far. Their covariances are lost, because that observation has none. An odometer reading takes the time of the
/// frame that follows. Returns the number of observations. Test: mrpt_apps/convert_test.cpp.
std::size_t write_observations_only(const std::string& in, const std::string& out);

}  // namespace helixnav::apps
