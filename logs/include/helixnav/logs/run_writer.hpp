// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "helixnav/core/recording.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/logs/evaluation.hpp"
#include "helixnav/logs/run_manifest.hpp"
#include "helixnav/logs/smoothed_run.hpp"

namespace helixnav::logs {

/// What only the caller knows at the end of a run. Keys with dots nest: ("closures.pending", 2) becomes
/// {"closures": {"pending": 2}}.
struct RunEnd {
  std::vector<std::pair<std::string, double>> numbers;  ///< into summary.json, such as chi2 and dof of a smoother
  std::vector<std::pair<std::string, double>> timing;   ///< wall clock, into summary.json under "timing"
  std::optional<SmoothedRun> smoothed;                  ///< into trajectory_final.tum and the report
};

/// Writes a run folder (docs/run-folder.md) as the run goes. After the constructor the manifest, the headers and the
/// truth are on disk; after each `write` the step is. A process killed at any instant leaves a folder that read_run
/// reads up to the last complete step. Numbers are the shortest text that reads back as the same double. Everything
/// but wall-clock figures is a function of the arguments, byte for byte.
/// Throws InputError when the file system refuses (the message names the file and the reason).
/// Test: logs/run_writer_test.cpp, logs/run_folder_test.cpp.
class RunWriter {
 public:
  enum class IfNotEmpty {
    refuse,     ///< InputError when the folder holds anything
    overwrite,  ///< removes the files of an earlier run, and no others
  };

  /// Makes `folder` (and its parents) and writes the manifest and the truth of `recording`, whose events are not looked
  /// at.
  RunWriter(const std::string& folder, const RunManifest& manifest, const core::Recording& recording,
            IfNotEmpty if_not_empty = IfNotEmpty::refuse);
  ~RunWriter();
  RunWriter(const RunWriter&) = delete;
  RunWriter& operator=(const RunWriter&) = delete;

  /// Appends one step and hands it to the operating system. What it revises replaces the rows with the same (step,
  /// observation) when read. `microseconds` is the wall-clock cost of the step.
  /// Cost: about 5 µs.
  void write(const core::StepReport& report, double microseconds);

  /// Writes map.csv, trajectory_final.tum when a smoother ran, evaluates, writes summary.json and report.html. Each
  /// appears whole or not at all. Evaluated is what the steps say; where a smoother ran alone, its final poses.
  Evaluation finish(const std::vector<core::MapLandmark>& map, const RunEnd& end = {});

 private:
  struct Files;
  std::string folder_;
  std::unique_ptr<Files> files_;
};

}  // namespace helixnav::logs
