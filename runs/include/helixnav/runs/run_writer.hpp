// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "helixnav/core/recording.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/runs/run.hpp"

namespace helixnav::runs {

/// Whether a run folder may hold a file of this name, which a run that overwrites the folder replaces or removes. Test:
/// apps/kept_inputs_test.cpp.
bool is_run_file(std::string_view name);

/// Writes a run folder (docs/run-folder.md) as the run goes. After the constructor the manifest, the headers and the
/// truth are on disk; after each `write` the step is. A process killed at any instant leaves a folder that read_run
/// reads up to the last complete step. Numbers are the shortest text that reads back as the same double. Everything
/// but wall-clock figures is a function of the arguments, byte for byte.
/// Throws InputError naming file and reason when the file system refuses or another process writes there
/// (files::FolderLock).
/// Test: runs/run_writer_test.cpp, runs/run_folder_test.cpp.
class RunWriter {
 public:
  enum class IfNotEmpty {
    refuse,     ///< InputError when the folder holds anything
    overwrite,  ///< removes the files of an earlier run, and no others
  };

  /// Makes `folder` (and its parents) and writes the manifest and the truth of `recording`, whose events are not used.
  RunWriter(const std::string& folder, const RunManifest& manifest, const core::Recording& recording,
            IfNotEmpty if_not_empty = IfNotEmpty::refuse);
  ~RunWriter();
  RunWriter(const RunWriter&) = delete;
  RunWriter& operator=(const RunWriter&) = delete;

  /// Appends one step and hands it to the operating system. What it revises replaces the rows with the same (step,
  /// observation) when read. `microseconds` is the wall-clock cost of the step.
  /// Cost: about 5 µs.
  void write(const core::StepReport& report, double microseconds);

  /// Writes what exists at the end of a run: map.csv, map.bin unless the map is too large, both for separate parts in
  /// folders part_0 …, trajectory_final.tum if the path was corrected or the session found its place on an earlier map,
  /// and the texts of report.html and, last of all, summary.json. Each appears whole or not at all.
  void finish(const Run& run, const std::string& report_page, const std::string& summary);

 private:
  struct Files;
  std::string folder_;
  std::unique_ptr<Files> files_;
};

/// Makes a folder for the results of one drive or one map, as RunWriter does.
void make_run_folder(const std::string& folder, RunWriter::IfNotEmpty if_not_empty);

}  // namespace helixnav::runs
