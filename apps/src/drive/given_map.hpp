// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
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
  Eigen::MatrixXd covariance_m2;                        ///< of their places in that order; empty where nobody knows it
  std::map<core::Label, core::LandmarkId> landmark_of;  ///< by label; empty when the run had no labels
  std::optional<SessionStart> start;                    ///< on it; nothing: as the log says
  std::vector<std::string> missing;                     ///< of the run or the map: lost since it was written
  std::optional<core::Pose2> T_truth_map;  ///< where it lies in the frame of its truth, where its run knows
};

/// The landmark that most observations of a label were matched with.
std::map<core::Label, core::LandmarkId> landmarks_by_label(const runs::Run& run);

/// Reads a map.csv, alone or in a run folder. Who is who is taken from that run's associations and labels: a label is
/// the landmark that most of its observations were matched with. InputError when there is no map.
GivenMap read_given_map(const std::string& path);

/// From a map itself, in which nothing says which label is which landmark. InputError without a mature one.
GivenMap given_map(const core::JointMap& map);

/// Whether a place on it can be looked for: 5 landmarks at least, and no more than a dense joint covariance may have.
bool can_be_searched(const GivenMap& map);

/// InputError where the start on it is unknown and cannot be looked for.
void check_start(const GivenMap& map);

/// The map as it is drawn (supervisor::as_drawn) with these landmarks alone, for a sensor of this view; where their joint covariance
/// is unknown, they are taken to be where they are, but for what two drives see of one landmark.
core::JointMap as_drawn(const GivenMap& map, const supervisor::NavigatorOptions& options,
                        const core::FieldOfView& view);

/// The map.csv meant by what read_given_map takes.
std::string map_file(const std::string& path);

/// How the associations of a run in a given map agree with the labels of its log.
struct LabelAgreement {
  std::size_t matched = 0;  ///< observations matched with a landmark
  std::size_t right = 0;    ///< of these: with the one of their label
  std::size_t on_map = 0;   ///< observations whose label the map has

  void count(const core::StepReport& report, const std::vector<core::Label>& labels, const GivenMap& map);
};

/// Precision and recall, one line; empty when the log or the map has no labels.
std::string text_of(const LabelAgreement& agreement);

/// The same for summary.json.
std::vector<std::pair<std::string, double>> numbers_of(const LabelAgreement& agreement);

}  // namespace helixnav::apps
