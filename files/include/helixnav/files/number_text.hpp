// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "helixnav/core/time.hpp"

namespace helixnav::files {

/// The shortest text that reads back as the same double; else nan, inf or -inf.
void append_number(std::string& text, double value);
void append_number(std::string& text, std::int64_t value);

/// Exact decimal seconds, e.g. 1.25.
void append_seconds(std::string& text, core::Nanoseconds t_ns);

/// The whole of `text` as a number, or nothing.
std::optional<double> parse_number(std::string_view text);
std::optional<std::int64_t> parse_integer(std::string_view text);

/// Decimal seconds, exact to the nanosecond; other notations through double.
std::optional<core::Nanoseconds> parse_seconds(std::string_view text);

}  // namespace helixnav::files
