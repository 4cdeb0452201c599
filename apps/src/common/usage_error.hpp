// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace helixnav::apps {

/// The message for a command line that cannot be understood: what is wrong, the nearest valid name where a name was
/// unknown, and where help is.
std::string explain_usage_error(const CLI::App& app, const CLI::ParseError& error);

}  // namespace helixnav::apps
