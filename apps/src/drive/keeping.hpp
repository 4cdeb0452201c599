// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>

#include "helixnav/core/events.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/runs/drive_file.hpp"

namespace helixnav::apps {

/// An estimator whose inputs are recorded, so that its drive can be continued.
template <typename Estimator>
class Keeping {
 public:
  /// `file` null: nothing is recorded.
  Keeping(Estimator& estimator, runs::DriveFile* file) : estimator_(estimator), file_(file) {}

  std::optional<core::StepReport> take(const core::Event& event) {
    std::optional<core::StepReport> step = estimator_.take(event);
    if (file_ != nullptr) file_->add(event);
    return step;
  }

 private:
  Estimator& estimator_;
  runs::DriveFile* file_;
};

}  // namespace helixnav::apps
