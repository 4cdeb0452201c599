// SPDX-License-Identifier: BSD-3-Clause
#include "player_landmarks.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "packed.hpp"
#include "packed_ellipse.hpp"

namespace helixnav::reports {
namespace {

struct Place {
  std::int64_t step = 0;
  core::PointGaussian point;
  core::LandmarkState state = core::LandmarkState::tentative;
};

struct History {
  std::int64_t until = -1;
  std::vector<Place> places;
};

using Histories = std::map<core::LandmarkId, History>;

/// Where the scan that began a landmark saw it.
void put_births(const runs::Run& run, Histories& histories) {
  for (std::size_t k = 0; k < run.steps.size() && k < run.scans.size(); ++k) {
    const core::StepReport& step = run.steps[k];
    for (const core::AssociationReport& a : step.associations) {
      const auto observation = static_cast<std::size_t>(a.observation);
      if (a.outcome != core::Outcome::augmented || observation >= run.scans[k].size()) continue;
      const Eigen::Vector2d seen_m = run.scans[k][observation].cast<double>();
      if (!seen_m.allFinite()) continue;
      const core::PointGaussian point{core::transform(step.pose.mean, seen_m), Eigen::Matrix2d::Zero()};
      histories[a.landmark].places.push_back({step.step, point, core::LandmarkState::tentative});
    }
  }
}

void put_changes(const runs::Run& run, Histories& histories) {
  for (const runs::MapChange& change : run.map_changes) {
    for (const core::MapLandmark& landmark : change.changed) {
      histories[landmark.id].places.push_back({change.step, landmark.point, landmark.state});
    }
    for (const core::LandmarkId id : change.removed) histories[id].until = change.step;
  }
}

std::map<core::LandmarkId, std::int64_t> last_sightings(const runs::Run& run) {
  std::map<core::LandmarkId, std::int64_t> last;
  for (const core::StepReport& step : run.steps) {
    for (const core::AssociationReport& a : step.associations) {
      if (a.outcome == core::Outcome::matched || a.outcome == core::Outcome::augmented) last[a.landmark] = step.step;
    }
  }
  return last;
}

/// Landmarks that the next look at the map no longer found were removed in between: soon after they were last seen.
void end_short_lives(const runs::Run& run, Histories& histories) {
  constexpr std::int64_t soon = 20;
  const std::map<core::LandmarkId, std::int64_t> last = last_sightings(run);
  std::set<core::LandmarkId> known;
  for (const runs::MapChange& change : run.map_changes) {
    for (const core::MapLandmark& landmark : change.changed) known.insert(landmark.id);
  }
  for (auto& [id, history] : histories) {
    if (history.places.empty() || known.count(id) > 0) continue;
    const std::int64_t born = history.places.front().step;
    const auto next = std::find_if(run.map_changes.begin(), run.map_changes.end(),
                                   [&](const runs::MapChange& change) { return change.step >= born; });
    if (next == run.map_changes.end()) continue;
    const auto seen = last.find(id);
    const std::int64_t gone = (seen == last.end() ? born : seen->second) + soon;
    history.until = std::max(std::min(next->step, gone), born + 1);
  }
}

/// Only the last map is known: its landmarks are shown from the step that began them.
void put_map(const runs::Run& run, Histories& histories) {
  std::map<core::LandmarkId, std::int64_t> begun;
  for (const core::StepReport& step : run.steps) {
    for (const core::AssociationReport& a : step.associations) {
      if (a.outcome == core::Outcome::augmented) begun.emplace(a.landmark, step.step);
    }
  }
  for (const core::MapLandmark& landmark : run.map) {
    const auto found = begun.find(landmark.id);
    const std::int64_t step = found == begun.end() ? 0 : found->second;
    histories[landmark.id].places.push_back({step, landmark.point, landmark.state});
  }
}

void put_merges(const runs::Run& run, Histories& histories) {
  for (const core::StepReport& step : run.steps) {
    for (const core::MergedLandmarks& merge : step.merged) {
      const auto found = histories.find(merge.removed);
      if (found != histories.end()) found->second.until = merge.kept == merge.removed ? -1 : step.step;
    }
  }
}

Json packed_histories(const Histories& histories) {
  std::vector<std::int64_t> ids, until, count, step, x, y;
  PackedEllipses ellipses;
  for (const auto& [id, history] : histories) {
    if (history.places.empty()) continue;
    ids.push_back(id);
    until.push_back(history.until);
    count.push_back(static_cast<std::int64_t>(history.places.size()));
    for (const Place& place : history.places) {
      step.push_back(2 * place.step + (place.state == core::LandmarkState::mature ? 1 : 0));
      x.push_back(quantised(place.point.mean_m.x(), 0.01));
      y.push_back(quantised(place.point.mean_m.y(), 0.01));
      ellipses.add(place.point.covariance_m2);
    }
  }
  Json json = {{"id", packed(ids, 1)},    {"until", packed(until, 1)}, {"count", packed(count, 0)},
               {"step", packed(step, 1)}, {"x", packed(x, 1)},         {"y", packed(y, 1)}};
  json.update(ellipses.json());
  return json;
}

}  // namespace

Json player_landmarks(const runs::Run& run) {
  Histories histories;
  if (run.map_changes.empty()) {
    put_map(run, histories);
  } else {
    put_births(run, histories);
    put_changes(run, histories);
    end_short_lives(run, histories);
  }
  put_merges(run, histories);
  for (auto& [id, history] : histories) {
    std::stable_sort(history.places.begin(), history.places.end(),
                     [](const Place& a, const Place& b) { return a.step < b.step; });
  }
  return packed_histories(histories);
}

}  // namespace helixnav::reports
