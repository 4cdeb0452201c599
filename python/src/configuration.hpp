// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "bind.hpp"
#include "settings/settings.hpp"

namespace helixnav::python {

/// Settings as a configuration file sets them, and their text.
struct Configuration {
  apps::Settings settings;
  std::string text;
  std::vector<std::string> keys;  ///< given, with their sections
};

enum class Filter { as_chosen, fastslam, compressed_ekf };

/// From {"search.particles": 300} or {"search": {"particles": 300}}. What a vehicle file tells comes after what the options
/// say; `vehicle` may be empty, and then the one beside `log` is taken. The keys must be
/// of the filter chosen, or of the one that the caller is. core::InputError naming the key.
Configuration configuration_of(const py::dict& options, const std::string& vehicle = {}, const std::string& log = {},
                               Filter filter = Filter::as_chosen);

/// core::InputError naming the first key given that only the reader of a log heeds, or that chooses what navigates: a navigator
/// that is made without a log would pass over it in silence. `association.method` 'known' is for `navigates` that goes by identities.
void refuse_unheeded(const Configuration& configuration, const std::string& navigates, bool by_identities);

}  // namespace helixnav::python
