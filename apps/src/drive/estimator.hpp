// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "drive.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::apps {

/// What a drive feeds: the navigator, FastSLAM or the localizer, with the labels given to it if the job says so. The job must
/// outlive it.
struct Estimator {
  std::function<std::optional<core::StepReport>(const core::Event&)> take;  ///< for core::EventLoop
  std::function<core::PoseGaussian()> pose;                                 ///< at the last scan or fix
  std::function<std::vector<core::MapLandmark>()> map;
  std::function<std::optional<core::JointMap>()>
      joint_map;  ///< to continue in; none for a localizer, or if it is too large
  std::function<runs::ParticleEnd()> particle_end = {};  ///< only for a particle cloud
  std::function<std::map<int, core::JointMap>()> parts_apart =
      {};                                                       ///< of the drive, from before the vehicle was carried
  std::function<std::vector<core::MapLandmark>()> sketch = {};  ///< map() for a picture, if that is cheaper
  std::function<bool()> is_start_ambiguous = {};  ///< see StartCheck; only where a start on an earlier map was given
};

/// The one requested by the job. `agreement` as in localizer_of.
Estimator estimator_of(const Drive& job, LabelAgreement& agreement);

Estimator navigator_of(const Drive& job);

/// FastSLAM with job.fastslam; labels as in NamedNavigator. Its map is that of the heaviest particle. Fixes are not
/// used.
Estimator fastslam_of(const Drive& job);

/// [scan fed] labels: an estimator gets nothing from the withheld scans.
std::vector<std::vector<core::Label>> labels_fed(const Drive& job);

/// Localises in job.given_map; `agreement` is updated by each scan of a log with labels. Fixes are not used.
Estimator localizer_of(const Drive& job, LabelAgreement& agreement);

}  // namespace helixnav::apps
