// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <variant>

#include "helixnav/core/step_report.hpp"

namespace helixnav::runs {

/// Which clouds of a search are kept: when an attempt starts, one, three and six scans later, and when a closing was
/// tried. A cloud changes fast at first and little afterwards; keeping all would be most of the folder.
class CloudChoice {
 public:
  /// Every report in order.
  bool keeps(const core::StepReport& report) {
    if (report.cloud.empty()) return false;
    const auto any = [&](const auto& condition) {
      return std::any_of(report.decisions.begin(), report.decisions.end(), condition);
    };
    if (any([](const core::Decision& d) { return std::holds_alternative<core::AttemptStarted>(d); })) {
      scans_ = 0;
    } else {
      ++scans_;
    }
    const bool early = scans_ == 0 || scans_ == 1 || scans_ == 3 || scans_ == 6;
    return early || any(core::is_closure);
  }

 private:
  int scans_ = 0;  ///< since the attempt began
};

}  // namespace helixnav::runs
