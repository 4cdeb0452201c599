// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "helixnav/association/associate.hpp"
#include "helixnav/cekf/filter_options.hpp"
#include "helixnav/fastslam/options.hpp"

namespace helixnav::mrpt_adapter {

/// The values that the options `association`, `detector`, `retraction` and `fastslam_association` may have.
std::vector<std::string> association_names();
std::vector<std::string> detector_names();
std::vector<std::string> retraction_names();
std::vector<std::string> fastslam_association_names();

/// What has that name; InputError when there is none.
association::Method method_of(const std::string& name);
fastslam::Association fastslam_association_of(const std::string& name);
cekf::Retraction retraction_of(const std::string& name);

/// For messages: 0.5, 1e+06.
std::string short_text(double number);
/// The shortest text that reads back as the same number.
std::string exact_text(double number);

}  // namespace helixnav::mrpt_adapter
