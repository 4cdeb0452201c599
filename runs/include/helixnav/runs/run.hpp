// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "helixnav/core/joint_map.hpp"
#include "helixnav/core/particle_cloud.hpp"
#include "helixnav/core/recording.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/runs/run_manifest.hpp"
#include "helixnav/runs/smoothed_run.hpp"

namespace helixnav::runs {

/// What is known from elsewhere about a run; any part may be empty.
struct RunTruth {
  std::vector<core::TruePose> poses;          ///< of the reference point, in the map frame, if `frame` says so
  std::vector<core::TruePosition> positions;  ///< of the antenna, in a frame of their own
  Eigen::Vector2d antenna_robot_m = Eigen::Vector2d::Zero();
  core::TruthFrame frame;  ///< of the poses
  std::optional<core::TruthFrame>
      frame_when_placed;                      ///< that they belong into once the run finds its place on an earlier map
  std::vector<core::TrueLandmark> landmarks;  ///< in the frame of the poses, or of the positions if there are any
  std::vector<std::vector<core::Label>> labels;  ///< [step][observation]
};

/// What a recording knows of the truth.
RunTruth truth_of(const core::Recording& recording);

/// What an estimator that is a cloud of particles knows at the end of a drive, for paths.csv, mixture.csv and the report.
struct ParticleEnd {
  std::vector<core::PathPoint> paths;
  std::vector<core::MixedLandmark> mixture;
};

/// What of the map was new after a step, for the player of the report.
struct MapChange {
  std::int64_t step = 0;
  std::vector<core::MapLandmark> changed;  ///< began, or moved by what can be seen
  std::vector<core::LandmarkId> removed;   ///< merged or dead
};

/// A drive as a value: what an estimator reported step by step, what came of it, and what is known from elsewhere. It is
/// made by RunRecorder while the drive goes on, or read from a folder by read_run.
struct Run {
  std::string path;  ///< of its folder
  RunManifest manifest;
  /// In order of time; revisions applied; only the clouds that were kept; all in one frame, also those before a session
  /// found its place on an earlier map.
  std::vector<core::StepReport> steps;
  std::vector<double> microseconds;    ///< [step] wall clock
  std::vector<core::MapLandmark> map;  ///< empty unless the run finished
  /// What the user calls landmarks that were known by name; empty where association was not known.
  std::map<core::LandmarkId, std::string> names;
  /// [step] as known at the end; empty unless a closing or a smoother corrected it, or a session found its place.
  std::vector<core::Pose2> final_path;
  RunTruth truth;
  bool finished = false;  ///< the run finished
  /// What a run that finished wrote and read_run did not find, a sentence with file and numbers each: the steps are fewer.
  std::vector<std::string> missing;

  // Known in memory only; read_run leaves them empty.
  /// Into summary.json, such as chi2 and dof of a smoother. Keys with dots nest: ("closures.pending", 2) becomes
  /// {"closures": {"pending": 2}}.
  std::vector<std::pair<std::string, double>> numbers;
  std::vector<std::pair<std::string, double>> timing;  ///< wall clock, into summary.json under "timing"
  std::optional<SmoothedRun> smoothed;
  std::optional<core::JointMap> joint_map;          ///< into map.bin
  std::map<int, core::JointMap> parts_apart;        ///< [part] into part_0/map.csv …, see core::CarriedDecision
  std::vector<std::vector<Eigen::Vector2f>> scans;  ///< [step][observation] in the robot's frame [m]; NaN: no point
  std::vector<MapChange> map_changes;
  std::optional<ParticleEnd> particle_end;
};

/// Makes the final path of what was solved of the drive, or of each of its parts: between the poses given the motion of the
/// steps stands, after the last one of a part the steps.
/// Without poses the path is that of the steps where a session found its place, and none elsewhere. Test: runs/final_path_test.cpp.
void correct_path(Run& run, const std::vector<core::StampedPose>& solved);

/// Whether it began somewhere unknown on an earlier map and looked for its place there.
bool began_off_earlier_map(const Run& run);

/// Whether a session that looked for its place on an earlier map found it.
bool is_on_earlier_map(const Run& run);

/// Brings true poses and landmarks of a run that found its place on an earlier map into the frame of that map, which its poses
/// are in; where nobody knows how that lies in the frame of the truth, says that they are not in the map frame.
/// Test: runs/truth_frame_test.cpp.
void bring_truth_into_map(Run& run);

/// The step with which the part began that the run ended in, where its place on the map of before was not found: map.csv is in a frame
/// of that part's own, and not in that of the true poses. Nothing where the map is in their frame.
std::optional<std::size_t> begin_of_last_part(const Run& run);

/// Where map.csv lies in the frame in which the truth was given, for who goes on in it; of a part that was not found, by the truth within
/// its first scan. Nothing where nobody knows. Test: runs/truth_frame_test.cpp.
std::optional<core::Pose2> T_truth_of_map(const Run& run);

/// Takes truth into the map frame that lies at T_truth_map in the frame in which the truth was given. Where either is not known,
/// the truth is in a frame of its own from now on.
void move_truth(const std::optional<core::Pose2>& T_truth_map, core::TruthFrame& frame,
                std::vector<core::TruePose>& poses, std::vector<core::TrueLandmark>& landmarks);

/// Adds what a smoother made of the run. Where it ran alone, its poses are the run's from now on.
void add_smoothed(Run& run, SmoothedRun smoothed);

}  // namespace helixnav::runs
