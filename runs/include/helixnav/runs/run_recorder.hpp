// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "helixnav/runs/run.hpp"

namespace helixnav::runs {

/// Makes a run from the reports of a drive. The run is, number by number, the one that read_run finds in a folder whose
/// RunWriter was given the same, so that a run is evaluated identically at its end and later: rows that a later step
/// revises are replaced, covariances are made symmetric from their upper triangle, headings go through a quaternion.
/// Cost per step: a copy of its report. Test: runs/run_recorder_test.cpp.
class RunRecorder {
 public:
  /// `path` is where the run's folder is, or will be.
  RunRecorder(const std::string& path, const RunManifest& manifest, const core::Recording& recording);
  ~RunRecorder();
  RunRecorder(const RunRecorder&) = delete;
  RunRecorder& operator=(const RunRecorder&) = delete;

  void add(const core::StepReport& report, double microseconds);

  /// Whether a picture of the drive needs the map after the step last added: some hundred times per drive, and after
  /// every closing.
  bool wants_map() const;

  /// The map after the step last added. Only visible changes are kept.
  void add_map(const std::vector<core::MapLandmark>& map);

  /// The run with its map, at its end. Nothing may be added afterwards.
  Run finish(const std::vector<core::MapLandmark>& map);

 private:
  struct Book;
  std::unique_ptr<Book> book_;
};

}  // namespace helixnav::runs
