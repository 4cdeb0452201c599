// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bind.hpp"
#include "settings/settings.hpp"

namespace helixnav::python {

/// Settings as a configuration file sets them, and their text.
struct Configuration {
  apps::Settings settings;
  std::string text;
};

enum class Filter { as_chosen, fastslam };

/// From {"search.particles": 300} or {"search": {"particles": 300}}. What a vehicle file tells comes after what the options
/// say; `vehicle` may be empty, and then the one beside `log` is taken. The keys must be
/// of the filter chosen, or of FastSLAM where the caller is one. core::InputError naming the key.
Configuration configuration_of(const py::dict& options, const std::string& vehicle = {}, const std::string& log = {},
                               Filter filter = Filter::as_chosen);

}  // namespace helixnav::python
