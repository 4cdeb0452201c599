// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace helixnav::apps {

/// The message for an invalid command line: what is wrong, the nearest valid name if a name was unknown, and where
/// to find help.
std::string explain_usage_error(const CLI::App& app, const CLI::ParseError& error);

}  // namespace helixnav::apps
