// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"

namespace helixnav::core {

/// True identity of an observed object, where known; no_label: false detection or unknown.
using Label = std::int64_t;
inline constexpr Label no_label = -1;

/// A pose known from elsewhere (simulator, Vicon), of the robot's reference point.
struct TruePose {
  Nanoseconds t_ns = 0;
  Pose2 T_world_robot;
};

/// The frame that true poses are in. Truths of several drives are assumed to be in one frame, that of one motion
/// capture room or of one grid, so that a drive on the map of another can be judged.
struct TruthFrame {
  bool is_map = true;  ///< they are in the map frame; false: unknown where the map is in theirs
  std::optional<Pose2>
      T_truth_map;  ///< of the map frame in the frame in which the truth was given, where that is known
};

/// A landmark position known from elsewhere (simulator, survey).
struct TrueLandmark {
  Label label = no_label;
  Eigen::Vector2d point_m = Eigen::Vector2d::Zero();
};

/// A position fix kept for evaluation, of the point `antenna_robot_m` on the robot, in the frame of the truth (which is
/// not the map frame: evaluation aligns the two).
struct TruePosition {
  Nanoseconds t_ns = 0;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
  double sigma_m = 0.0;  ///< of x and of y; 0: the log does not say
};

/// An observation that shows several objects at once, as when a detector joins lines that it cannot separate: all their
/// labels.
struct SharedObservation {
  std::size_t scan = 0;
  std::size_t observation = 0;
  std::vector<Label> labels;
};

/// What a reader or a simulator hands out: the events, in time order, and alongside them what only evaluation may see.
/// Estimators never include this header (checked by the include-graph test).
struct Recording {
  std::string name;
  PoseGaussian start;         ///< of the robot in the map frame; DESIGN: identity with zero covariance
  std::vector<Event> events;  ///< in time order; an increment comes before the scan that ends it

  std::vector<std::vector<Label>> labels;  ///< [scan][observation]; empty when the log has no labels
  std::vector<std::string> label_names;    ///< [label] where the log names its landmarks by words; empty: by numbers
  std::vector<SharedObservation> shared_observations;  ///< `labels` holds the first label of each
  bool labels_are_given = false;  ///< what is seen is part of the problem, as in a graph, and not in question
  std::vector<TruePose> true_poses;
  TruthFrame truth_frame;  ///< of true_poses, and of true_landmarks where there are no true_positions
  std::optional<TruthFrame> truth_frame_when_placed;  ///< likewise, once the drive finds its place on an earlier map
  std::vector<TrueLandmark> true_landmarks;
  std::vector<Nanoseconds>
      true_carries_ns;  ///< of the first measurement after each time that it was carried, ascending (simulator)
  std::vector<Nanoseconds> true_slips_ns;  ///< ends of the increments that a slip made wrong, ascending (simulator)
  std::vector<TruePosition> true_positions;
  /// Observations of no mapped landmark in a scan, clutter and new ones together, as known for the sensor; 0:
  /// unknown, to be learnt from the drive. Nothing: the navigator's default.
  std::optional<double> extraneous_per_scan;
  Eigen::Vector2d antenna_robot_m = Eigen::Vector2d::Zero();  ///< lever arm that true_positions refer to
  std::vector<std::string> remarks;  ///< what the reader repaired, left out or doubts, a sentence each
};

}  // namespace helixnav::core
