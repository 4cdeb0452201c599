// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "earlier_session.hpp"
#include "helixnav/core/joint_map.hpp"
#include "helixnav/core/recording.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/runs/run.hpp"
#include "helixnav/supervisor/navigator_options.hpp"

namespace helixnav::apps {

/// A map that a run made, to localise in.
struct GivenMap {
  std::vector<core::MapLandmark> landmarks;             ///< mature ones, by increasing id
  Eigen::MatrixXd covariance_m2;                        ///< of their places in that order; empty if unknown
  std::shared_ptr<const core::JointMap> large;          ///< the map, if it is large, with its factors alone
  std::map<core::Label, core::LandmarkId> landmark_of;  ///< by label; empty when the run had no labels
  std::optional<SessionStart> start;                    ///< on it; none: as in the log
  std::vector<std::string> missing;                     ///< of the run or the map: lost since it was written
  std::optional<core::Pose2> T_truth_map;  ///< the pose of its frame in that of its truth, if the run knows
};

/// The landmark that most observations of a label were matched with.
std::map<core::Label, core::LandmarkId> landmarks_by_label(const runs::Run& run);

/// Reads a map.csv, alone or in a run folder. Identities are taken from that run's associations and labels: a label is
/// the landmark that most of its observations were matched with. InputError if there is no map.
GivenMap read_given_map(const std::string& path);

/// From the map itself, which does not say which label is which landmark. InputError if it has no mature one.
GivenMap given_map(const core::JointMap& map);

/// Whether a place on it can be searched for: at least 5 landmarks, and no more than a dense joint covariance may have,
/// unless it holds factors.
bool can_be_searched(const GivenMap& map);

/// InputError if the start on it is unknown and cannot be searched for.
void check_start(const GivenMap& map);

/// The map as it is drawn (supervisor::as_drawn) with these landmarks alone, for a sensor of this view; if their joint covariance is
/// unknown, their places are taken as exact, except for the discrepancy between two drives that see the same landmark.
core::JointMap as_drawn(const GivenMap& map, const supervisor::NavigatorOptions& options,
                        const core::FieldOfView& view);

/// The map.csv that the argument of read_given_map refers to.
std::string map_file(const std::string& path);

/// How well the associations of a run in a given map agree with the labels of its log.
struct LabelAgreement {
  std::size_t matched = 0;  ///< observations matched with a landmark
  std::size_t right = 0;    ///< of these: with the landmark of their label
  std::size_t on_map = 0;   ///< observations whose label is on the map

  void count(const core::StepReport& report, const std::vector<core::Label>& labels, const GivenMap& map);
};

/// Precision and recall, one line; empty if the log or the map has no labels.
std::string text_of(const LabelAgreement& agreement);

/// The same for summary.json.
std::vector<std::pair<std::string, double>> numbers_of(const LabelAgreement& agreement);

}  // namespace helixnav::apps
