// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/run_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "as_kept.hpp"
#include "bring_into_map.hpp"
#include "cloud_choice.hpp"
#include "map_changes.hpp"
#include "points_of_scan.hpp"
#include "tables/put_association.hpp"

namespace helixnav::runs {
namespace {

template <typename Matrix>
void mirror_upper_triangle(Matrix& matrix) {
  for (Eigen::Index row = 1; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column < row; ++column) matrix(row, column) = matrix(column, row);
  }
}

/// With its memory, which it would hold for as long as the run if it were cleared.
template <typename Element>
void drop(std::vector<Element>& elements) {
  elements = std::vector<Element>();
}

core::PoseGaussian gaussian_as_kept(core::PoseGaussian pose) {
  pose.mean = as_kept(pose.mean);
  mirror_upper_triangle(pose.covariance);
  return pose;
}

}  // namespace

struct RunRecorder::Book {
  Run run;
  CloudChoice cloud_choice;
  std::vector<core::StampedPose> solved;         ///< the last time
  std::vector<core::StampedPose> solved_before;  ///< for the parts of the drive before the vehicle was carried
  MapChanges map_changes;
  bool wants_map = false;  ///< after the step last added
};

RunRecorder::RunRecorder(const std::string& path, const RunManifest& manifest, const core::Recording& recording)
    : book_(std::make_unique<Book>()) {
  book_->run.path = path;
  book_->run.manifest = manifest;
  book_->run.truth = truth_of(recording);
  for (const core::Event& event : recording.events) {
    if (const auto* scan = std::get_if<core::Scan>(&event)) book_->run.scans.push_back(points_of_scan(*scan));
  }
  book_->run.steps.reserve(book_->run.scans.size());
  book_->map_changes = MapChanges(book_->run.scans.size());
}

RunRecorder::~RunRecorder() = default;

void RunRecorder::add(const core::StepReport& report, double microseconds) {
  Run& run = book_->run;
  core::StepReport& step = run.steps.emplace_back(report);
  run.microseconds.push_back(std::round(microseconds * 10.0) / 10.0);
  step.pose = gaussian_as_kept(report.pose);
  if (!book_->cloud_choice.keeps(report)) {
    drop(step.cloud);
  } else if (!report.drawn.empty()) {
    step.cloud = report.drawn;
  }
  drop(step.drawn);
  book_->wants_map = book_->map_changes.wants(report);
  if (std::any_of(report.decisions.begin(), report.decisions.end(), core::begins_part)) {
    book_->solved_before.insert(book_->solved_before.end(), book_->solved.begin(), book_->solved.end());
    book_->solved.clear();
  }
  if (!report.solved.empty()) book_->solved = std::move(step.solved);
  drop(step.solved);
  drop(step.revised);
  step.associations.clear();
  for (const core::RevisedScan& scan : report.revised) {
    for (const core::AssociationReport& a : scan.associations) put_association(scan.step, a, run.steps);
  }
  for (const core::AssociationReport& a : report.associations) put_association(report.step, a, run.steps);
}

bool RunRecorder::wants_map() const { return book_->wants_map; }

void RunRecorder::add_map(const std::vector<core::MapLandmark>& map) {
  book_->run.map_changes.push_back(book_->map_changes.since_last(book_->run.steps.back().step, map));
}

Run RunRecorder::finish(const std::vector<core::MapLandmark>& map) {
  Run run = std::move(book_->run);
  if (!run.steps.empty()) run.map_changes.push_back(book_->map_changes.since_last(run.steps.back().step, map));
  run.map = map;
  for (core::MapLandmark& landmark : run.map) mirror_upper_triangle(landmark.point.covariance_m2);
  run.finished = true;
  bring_into_map(run);
  bring_truth_into_map(run);
  std::vector<core::StampedPose>& solved = book_->solved_before;
  solved.insert(solved.end(), book_->solved.begin(), book_->solved.end());
  correct_path(run, solved);
  return run;
}

}  // namespace helixnav::runs
