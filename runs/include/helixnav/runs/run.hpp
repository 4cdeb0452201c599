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

/// What is known about a run from other sources; any part may be empty.
struct RunTruth {
  std::vector<core::TruePose> poses;          ///< of the reference point, in the map frame, if `frame` says so
  std::vector<core::TruePosition> positions;  ///< of the antenna, in a frame of their own
  Eigen::Vector2d antenna_robot_m = Eigen::Vector2d::Zero();
  core::TruthFrame frame;  ///< of the poses
  std::optional<core::TruthFrame>
      frame_when_placed;                      ///< the frame they are in once the run finds its place on an earlier map
  std::vector<core::TrueLandmark> landmarks;  ///< in the frame of the poses, or of the positions if there are any
  std::vector<std::vector<core::Label>> labels;  ///< [step][observation]
};

/// What a recording knows about the truth.
RunTruth truth_of(const core::Recording& recording);

/// What a particle-cloud estimator knows at the end of a drive, for paths.csv, mixture.csv and the report.
struct ParticleEnd {
  std::vector<core::PathPoint> paths;
  std::vector<core::MixedLandmark> mixture;
};

/// What changed in the map with a step, for the player of the report.
struct MapChange {
  std::int64_t step = 0;
  std::vector<core::MapLandmark> changed;  ///< started, or visibly moved
  std::vector<core::LandmarkId> removed;   ///< merged or dead
};

/// A drive as a value: what an estimator reported step by step, what came of it, and what is known from other sources.
/// It is made by RunRecorder while the drive goes on, or read from a folder by read_run.
struct Run {
  std::string path;  ///< of its folder
  RunManifest manifest;
  /// In time order; revisions applied; only the clouds that were kept; all in one frame, including those before a
  /// session found its place on an earlier map.
  std::vector<core::StepReport> steps;
  std::vector<double> microseconds;    ///< [step] wall clock
  std::vector<core::MapLandmark> map;  ///< empty unless the run finished
  /// The user's names of landmarks that were known by name; empty unless association was known.
  std::map<core::LandmarkId, std::string> names;
  /// [step] as known at the end; empty unless a closing or a smoother corrected it, or a session found its place.
  std::vector<core::Pose2> final_path;
  RunTruth truth;
  bool finished = false;  ///< the run finished
  /// What a finished run wrote and read_run did not find, one sentence each with file and numbers: there are fewer
  /// steps.
  std::vector<std::string> missing;

  // Known in memory only; read_run leaves them empty.
  std::vector<std::string> remarks;   ///< of the log's reader, into the report
  std::vector<std::string> warnings;  ///< of whoever made it, about what the run itself does not show; into the report
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

/// Makes the final path from what was solved of the drive, or of each of its parts: between the given poses the motion
/// of the steps is used, after the last pose of a part the steps. Without poses the path is that of the steps if a
/// session found its place, otherwise there is none. Test: runs/final_path_test.cpp.
void correct_path(Run& run, const std::vector<core::StampedPose>& solved);

/// Whether it started somewhere unknown on an earlier map and looked for its place there.
bool began_off_earlier_map(const Run& run);

/// Whether a session that looked for its place on an earlier map found it.
bool is_on_earlier_map(const Run& run);

/// Brings true poses and landmarks of a run that found its place on an earlier map into the frame of that map, which
/// its poses are in; if the relation of that to the truth's frame is unknown, marks them as not in the map frame. Test:
/// runs/truth_frame_test.cpp.
void bring_truth_into_map(Run& run);

/// The first step of the part in which the run ended, if its place on the earlier map was not found: map.csv is then in
/// that part's own frame, and not in that of the true poses. Nothing if the map is in their frame.
std::optional<std::size_t> begin_of_last_part(const Run& run);

/// Pose of map.csv in the frame in which the truth was given, for whoever goes on in it; for a part that was not found,
/// by the truth within its first scan. Nothing if unknown. Test: runs/truth_frame_test.cpp.
std::optional<core::Pose2> T_truth_of_map(const Run& run);

/// Takes truth into the map frame whose pose is T_truth_map in the frame in which the truth was given. If either is
/// unknown, the truth is in a frame of its own from now on.
void move_truth(const std::optional<core::Pose2>& T_truth_map, core::TruthFrame& frame,
                std::vector<core::TruePose>& poses, std::vector<core::TrueLandmark>& landmarks);

/// Adds what a smoother made of the run. If it ran alone, its poses are the run's from now on.
void add_smoothed(Run& run, SmoothedRun smoothed);

}  // namespace helixnav::runs
