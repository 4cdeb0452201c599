// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/run_recorder.hpp"

#include <cmath>
#include <utility>

#include "bring_into_map.hpp"
#include "cloud_choice.hpp"
#include "put_association.hpp"

namespace helixnav::runs {
namespace {

/// As a quaternion about z holds it.
double heading_by_quaternion(double heading_rad) {
  return 2.0 * std::atan2(std::sin(0.5 * heading_rad), std::cos(0.5 * heading_rad));
}

template <typename Matrix>
void mirror_upper_triangle(Matrix& matrix) {
  for (Eigen::Index row = 1; row < matrix.rows(); ++row) {
    for (Eigen::Index column = 0; column < row; ++column) matrix(row, column) = matrix(column, row);
  }
}

core::PoseGaussian as_kept(core::PoseGaussian pose) {
  const core::Pose2& mean = pose.mean;
  pose.mean = core::Pose2(mean.x_m, mean.y_m, heading_by_quaternion(mean.heading_rad));
  mirror_upper_triangle(pose.covariance);
  return pose;
}

}  // namespace

struct RunRecorder::Book {
  Run run;
  CloudChoice cloud_choice;
};

RunRecorder::RunRecorder(const std::string& path, const RunManifest& manifest, const core::Recording& recording)
    : book_(std::make_unique<Book>()) {
  book_->run.path = path;
  book_->run.manifest = manifest;
  book_->run.truth = truth_of(recording);
}

RunRecorder::~RunRecorder() = default;

void RunRecorder::add(const core::StepReport& report, double microseconds) {
  Run& run = book_->run;
  core::StepReport& step = run.steps.emplace_back(report);
  run.microseconds.push_back(std::round(microseconds * 10.0) / 10.0);
  step.pose = as_kept(report.pose);
  if (!book_->cloud_choice.keeps(report)) {
    step.cloud.clear();
  } else if (!report.drawn.empty()) {
    step.cloud = report.drawn;
  }
  step.drawn.clear();
  step.revised.clear();
  step.associations.clear();
  for (const core::RevisedScan& scan : report.revised) {
    for (const core::AssociationReport& a : scan.associations) put_association(scan.step, a, run.steps);
  }
  for (const core::AssociationReport& a : report.associations) put_association(report.step, a, run.steps);
}

Run RunRecorder::finish(const std::vector<core::MapLandmark>& map) {
  Run run = std::move(book_->run);
  run.map = map;
  for (core::MapLandmark& landmark : run.map) mirror_upper_triangle(landmark.point.covariance_m2);
  run.finished = true;
  bring_into_map(run);
  return run;
}

}  // namespace helixnav::runs
