// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "bind.hpp"
#include "common/settings.hpp"

namespace helixnav::python {

/// Settings as a configuration file sets them, and their text.
struct Configuration {
  apps::Settings settings;
  std::string text;
};

/// From {"search.particles": 300} or {"search": {"particles": 300}}. What a vehicle file tells comes after what the options
/// say; `vehicle` may be empty, and then the one beside `log` is taken. core::InputError naming the key.
Configuration configuration_of(const py::dict& options, const std::string& vehicle = {}, const std::string& log = {});

}  // namespace helixnav::python
