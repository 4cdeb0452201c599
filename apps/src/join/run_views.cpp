// SPDX-License-Identifier: BSD-3-Clause
#include "run_views.hpp"

#include <algorithm>
#include <filesystem>
#include <utility>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/merged_ids.hpp"
#include "helixnav/runs/run_folder.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

std::vector<core::LandmarkId> seen_in(const core::StepReport& step, const core::MergedIds& names) {
  std::vector<core::LandmarkId> seen;
  for (const core::AssociationReport& one : step.associations) {
    const bool used = one.outcome == core::Outcome::matched || one.outcome == core::Outcome::augmented;
    if (used && one.landmark != core::no_landmark) seen.push_back(names.now(one.landmark));
  }
  std::sort(seen.begin(), seen.end());
  return seen;
}

bool has_parts(const std::string& folder) {
  const auto is_part = [](const fs::directory_entry& entry) {
    return entry.path().filename().string().rfind("part_", 0) == 0;
  };
  return std::any_of(fs::directory_iterator(folder), fs::directory_iterator(), is_part);
}

/// Joining needs the map alone: a drive that cannot be read any more only leaves open what was looked at.
runs::Run read_if_whole(const std::string& folder) {
  try {
    return runs::read_run(folder);
  } catch (const core::InputError&) {
    return {};
  }
}

}  // namespace

std::optional<SessionViews> views_in(const std::string& folder, const core::JointMap& map) {
  if (!fs::exists(fs::path(folder) / "manifest.json") || has_parts(folder)) return std::nullopt;
  const runs::Run run = read_if_whole(folder);
  if (run.steps.empty() || runs::begin_of_last_part(run)) return std::nullopt;
  const core::MergedIds names(run.steps);
  std::vector<Look> looks;
  for (std::size_t k = 0; k < run.steps.size(); ++k) {
    const bool corrected = run.final_path.size() == run.steps.size();
    looks.push_back({corrected ? run.final_path[k] : run.steps[k].pose.mean, seen_in(run.steps[k], names)});
  }
  return SessionViews(std::move(looks), map);
}

}  // namespace helixnav::apps
