// SPDX-License-Identifier: BSD-3-Clause
#include "association_trial.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <sstream>
#include <utility>

#include "common/interrupt.hpp"
#include "common/timed.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/event_loop.hpp"
#include "helixnav/evaluation/evaluation.hpp"
#include "helixnav/evaluation/nees.hpp"

namespace helixnav::apps {
namespace {

bool is_consistent(const core::PoseGaussian& pose, const core::Pose2& truth) {
  return evaluation::nees(pose, truth) <= core::chi2_quantile(0.999, 3);  // false for NaN
}

/// "97.5 % [94.3, 98.9]", or "-" without runs.
std::string share_text(std::size_t good, std::size_t all) {
  if (all == 0) return "-";
  const double n = static_cast<double>(all);
  const double p = static_cast<double>(good) / n;
  constexpr double z = 1.96;
  const double middle = (p + z * z / (2.0 * n)) / (1.0 + z * z / n);
  const double half = z / (1.0 + z * z / n) * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
  char text[64];
  std::snprintf(text, sizeof text, "%.1f %% [%.1f, %.1f]", 100.0 * p, 100.0 * std::max(0.0, middle - half),
                100.0 * std::min(1.0, middle + half));
  return text;
}

std::string table_row(const std::string& method, const AssociationTrial& trial) {
  std::vector<double> times_us = trial.step_us;
  std::sort(times_us.begin(), times_us.end());
  const evaluation::AssociationScore& s = trial.score;
  char text[256];
  std::snprintf(text, sizeof text, "%-25s %7zu %7zu %8zu  %-21s %-21s %9.3f %9.3f %9.3f %8.3f %8.0f %8.0f\n",
                method.c_str(), s.wrong, s.missed, s.spurious, share_text(trial.runs_without_wrong, trial.runs).c_str(),
                share_text(trial.runs_consistent, trial.runs_with_truth).c_str(), 100.0 * s.precision(),
                100.0 * s.recall(), 100.0 * s.recall_in_visit(), s.landmarks_per_true_one(),
                evaluation::quantile_of_sorted(times_us, 0.5), evaluation::quantile_of_sorted(times_us, 0.99));
  return text;
}

}  // namespace

void try_association(const core::Recording& recording, const supervisor::NavigatorOptions& options,
                     AssociationTrial& trial) {
  supervisor::Navigator navigator(recording.start, options);
  Timed timed(navigator);
  core::EventLoop loop(recording.events, timed);
  std::vector<core::StepReport> steps;
  while (!interrupted()) {
    std::optional<core::StepReport> step = loop.next();
    if (!step) break;
    steps.push_back(std::move(*step));
    trial.step_us.push_back(1e6 * timed.last_s());
  }
  const evaluation::AssociationScore score = evaluation::score_associations(steps, recording.labels, navigator.map());
  trial.score += score;
  ++trial.runs;
  trial.runs_without_wrong += score.wrong == 0;
  if (recording.true_poses.size() < steps.size() || steps.empty()) return;
  ++trial.runs_with_truth;
  trial.runs_consistent += is_consistent(navigator.pose(), recording.true_poses[steps.size() - 1].T_world_robot);
}

std::string association_table(const std::vector<std::string>& methods, const std::vector<AssociationTrial>& trials) {
  char text[256];
  std::snprintf(text, sizeof text, "%-25s %7s %7s %8s  %-21s %-21s %9s %9s %9s %8s %8s %8s\n", "method", "wrong",
                "missed", "spurious", "runs without wrong", "runs consistent", "precision", "recall", "in visit",
                "lm/true", "us", "us p99");
  std::string table = text;
  for (std::size_t i = 0; i < trials.size(); ++i) table += table_row(methods[i], trials[i]);
  return table;
}

std::string matching_matrix(const core::StepReport& report, const std::vector<core::LandmarkId>& landmarks_before) {
  std::vector<core::LandmarkId> columns = landmarks_before;
  std::sort(columns.begin(), columns.end());
  std::vector<char> seen(columns.size(), 0);
  std::ostringstream text;
  const auto cell = [&](const auto& value) {
    text.width(5);
    text << value;
  };
  cell("");
  for (const core::LandmarkId id : columns) cell(id + 1);
  cell(0);
  for (const core::AssociationReport& association : report.associations) {
    text << '\n';
    cell(association.observation + 1);
    const bool matched = association.outcome == core::Outcome::matched;
    for (std::size_t n = 0; n < columns.size(); ++n) {
      const bool here = matched && columns[n] == association.landmark;
      seen[n] = seen[n] || here;
      cell(here ? 1 : 0);
    }
    cell(matched ? 0 : 1);
  }
  text << '\n';
  cell(0);
  for (const char one : seen) cell(one ? 0 : 1);
  cell(0);
  text << '\n';
  return text.str();
}

}  // namespace helixnav::apps
