// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "earlier_session.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace helixnav::apps {

/// --start for commands that take an earlier map.
CLI::Option* add_start_option(CLI::App& command, std::optional<SessionStart>& start);

}  // namespace helixnav::apps
