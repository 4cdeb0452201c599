// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "helixnav/core/step_report.hpp"

namespace helixnav::reports {

/// A decision of supervisor::Navigator in words, without the line's end. A decision of an unknown kind is listed as it
/// is.
std::string sentence_of(const core::Decision& decision);

/// How join placed a session, or why it did not: there whole maps are compared, and nobody drives.
std::string sentence_of_join(const core::PlacedDecision& decision);

/// `value` with three significant digits and the noun, in the plural unless it is 1: "3 pairs".
std::string counted(double value, const std::string& noun);

/// Three significant digits, and all digits before the point.
std::string short_number(double value);

}  // namespace helixnav::reports
