// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>
#include <string>

#include "helixnav/core/decision_row.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/core/recording.hpp"
#include "helixnav/core/step_report.hpp"
#include "helixnav/reports/finish_run.hpp"
#include "helixnav/runs/run_recorder.hpp"
#include "helixnav/runs/run_writer.hpp"

namespace helixnav::runs {

inline RunManifest example_manifest() {
  RunManifest manifest;
  manifest.version = "0.1.0";
  manifest.commit = "0123456789abcdef";
  manifest.command = "helixnav replay 'a log' --seed 7";
  manifest.recording = "example <loop> & \"quotes\"";
  manifest.config = R"({"cekf": {"cell_m": 40.0}})";
  manifest.seed = 18446744073709551615U;
  manifest.inputs = {{"a log", std::string(64, 'a')}};
  return manifest;
}

/// A step on a circle of 50 m with numbers that are awkward to print.
inline core::StepReport example_step(std::int64_t k) {
  core::RandomStream random(static_cast<std::uint64_t>(k), "example");
  core::StepReport step;
  step.step = k;
  step.t_ns = 21'820'000'001 + k * 214'000'007;
  step.mode = k % 50 == 49 ? core::Mode::searching : core::Mode::mapping;
  const double angle = 0.01 * static_cast<double>(k);
  step.pose.mean = core::Pose2(50.0 * std::sin(angle), 50.0 * (1.0 - std::cos(angle)), angle);
  step.pose.covariance << 0.01, 0.001, 1.0 / 3e4, 0.001, 0.02, 1e-5, 1.0 / 3e4, 1e-5, 1e-4;
  const int observations = static_cast<int>(k % 8);
  for (int i = 0; i < observations; ++i) {
    const bool alone = i == 7;
    step.associations.push_back({i, alone ? core::Outcome::rejected : core::Outcome::matched,
                                 alone ? core::no_landmark : i, random.uniform(0.0, 6.0), 2,
                                 alone ? std::numeric_limits<double>::infinity() : random.uniform()});
  }
  step.joint_dof = 2 * observations;
  step.joint_nis = step.joint_dof * random.uniform(0.5, 1.5);
  step.numerics = {1.0 / (3.0 + static_cast<double>(k)), 1e-17 / 3.0, k % 90 == 11 ? 1 : 0, k % 90 == 12 ? 2 : 0};
  step.active_landmarks = 20;
  step.mapped_landmarks = static_cast<int>(k / 10);
  step.switched_region = k % 100 == 3;
  if (k % 40 == 11) {
    step.decisions.push_back(
        core::decision_of({"trigger", "raised", {{"sigma_m", 0.1 + 0.2}, {"foreign_expected", 1.0 / 3.0}}}));
    step.decisions.push_back(core::decision_of({"closure", k % 80 == 11 ? "accepted" : "refused", {}}));
  }
  if (k % 80 == 11) step.merged = {{4, 17}, {5, 18 + static_cast<int>(k)}};
  const std::int64_t since_trigger = k % 40 - 11;  // a search of seven scans
  if (since_trigger == 0) step.decisions.push_back(core::decision_of({"search", "started", {{"attempt", 1.0}}}));
  if (since_trigger >= 0 && since_trigger < 7) {
    for (int i = 0; i < 3; ++i) step.cloud.emplace_back(random.uniform(), -1.0 / 3.0, 0.1 * i);
    if (since_trigger == 0) step.drawn = {{9.0, -1.0 / 3.0, 0.0}, {-9.0, 2.0, 0.5}, {0.1, -1.0 / 3.0, 1.0}};
  }
  return step;
}

inline std::vector<core::MapLandmark> example_map() {
  std::vector<core::MapLandmark> map(3);
  for (int i = 0; i < 3; ++i) {
    map[static_cast<std::size_t>(i)].id = 2 * i;
    map[static_cast<std::size_t>(i)].point = {{10.0 * i, 1.0 / 3.0}, Eigen::Matrix2d::Identity() * 0.01};
    map[static_cast<std::size_t>(i)].observations = 5 + i;
    map[static_cast<std::size_t>(i)].state = i == 2 ? core::LandmarkState::tentative : core::LandmarkState::mature;
  }
  return map;
}

/// Truth of `steps` steps: the circle itself, two landmarks, a label on each observation.
inline core::Recording example_recording(std::int64_t steps) {
  core::Recording recording;
  recording.name = "example";
  for (std::int64_t k = 0; k < steps; ++k) {
    const core::StepReport step = example_step(k);
    recording.true_poses.push_back({step.t_ns, step.pose.mean});
    recording.labels.emplace_back(step.associations.size(), 4);
  }
  recording.true_landmarks = {{4, {0.0, 0.5}}, {9, {10.0, 1.0 / 7.0}}};
  return recording;
}

/// The example as a value, with its numbers and timings.
inline Run example_run(std::int64_t steps, double microseconds = 12.3) {
  RunRecorder recorder("run", example_manifest(), example_recording(steps));
  for (std::int64_t k = 0; k < steps; ++k) recorder.add(example_step(k), microseconds);
  Run run = recorder.finish(example_map());
  run.numbers = {{"chi2", 12.5}, {"closures.pending", 2.0}};
  run.timing = {{"total_s", microseconds}};
  return run;
}

inline void write_example(const std::string& folder, std::int64_t steps, double microseconds = 12.3) {
  RunWriter writer(folder, example_manifest(), example_recording(steps));
  for (std::int64_t k = 0; k < steps; ++k) writer.write(example_step(k), microseconds);
  reports::finish_run(example_run(steps, microseconds), writer);
}

}  // namespace helixnav::runs
