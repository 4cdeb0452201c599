// SPDX-License-Identifier: BSD-3-Clause
#include "report_player.hpp"

#include <algorithm>
#include <cmath>

#include "helixnav/core/angle.hpp"
#include "packed.hpp"
#include "packed_ellipse.hpp"
#include "player_landmarks.hpp"
#include "report_clouds.hpp"
#include "stride_for.hpp"

namespace helixnav::reports {
namespace {

using Numbers = std::vector<std::int64_t>;

constexpr double unit_m = 0.01;
constexpr double unit_rad = 1e-3;

std::int64_t milliseconds_since(core::Nanoseconds begin_ns, core::Nanoseconds t_ns) {
  return (t_ns - begin_ns) / 1'000'000;
}

/// Columns of poses; headings continue beyond half a turn.
class PackedPoses {
 public:
  void add(const core::Pose2& pose) {
    x_.push_back(quantised(pose.x_m, unit_m));
    y_.push_back(quantised(pose.y_m, unit_m));
    heading_rad_ += std::isfinite(pose.heading_rad) ? core::wrap_to_pi(pose.heading_rad - heading_rad_) : 0.0;
    heading_.push_back(quantised(heading_rad_, unit_rad));
  }
  Json json() const { return {{"x", packed(x_, 1)}, {"y", packed(y_, 1)}, {"heading", packed(heading_, 1)}}; }

 private:
  Numbers x_, y_, heading_;
  double heading_rad_ = 0.0;
};

Json path_data(const runs::Run& run) {
  Numbers t;
  PackedPoses poses;
  PackedEllipses ellipses;
  for (const core::StepReport& step : run.steps) {
    t.push_back(milliseconds_since(run.steps.front().t_ns, step.t_ns));
    poses.add(step.pose.mean);
    ellipses.add(step.pose.covariance.topLeftCorner<2, 2>());
  }
  Json json = poses.json();
  json["t"] = packed(t, 2);
  json.update(ellipses.json());
  return json;
}

Json final_path_data(const runs::Run& run) {
  if (run.final_path.size() != run.steps.size()) return nullptr;
  PackedPoses poses;
  for (const core::Pose2& pose : run.final_path) poses.add(pose);
  return poses.json();
}

/// [step, mode] where it changes.
Json modes_data(const runs::Run& run) {
  Json modes = Json::array();
  for (std::size_t k = 0; k < run.steps.size(); ++k) {
    if (k > 0 && run.steps[k].mode == run.steps[k - 1].mode) continue;
    modes.push_back({k, static_cast<int>(run.steps[k].mode)});
  }
  return modes;
}

/// Observations, scan by scan: landmark and outcome in one number (difference of the landmark's id times 8, plus 4 if the
/// observation is a point, plus the outcome), and the points in the robot's frame.
class PackedScans {
 public:
  void add(const core::StepReport& step, const std::vector<Eigen::Vector2f>* points_m) {
    count_.push_back(static_cast<std::int64_t>(step.associations.size()));
    for (const core::AssociationReport& a : step.associations) {
      const auto i = static_cast<std::size_t>(a.observation);
      const bool has_point = points_m != nullptr && i < points_m->size() && (*points_m)[i].allFinite();
      who_.push_back((a.landmark - landmark_) * 8 + (has_point ? 4 : 0) + static_cast<std::int64_t>(a.outcome));
      landmark_ = a.landmark;
      if (!has_point) continue;
      x_.push_back(quantised((*points_m)[i].x(), unit_m));
      y_.push_back(quantised((*points_m)[i].y(), unit_m));
    }
  }
  Json json() const {
    return {{"count", packed(count_, 0)}, {"who", packed(who_, 0)}, {"x", packed(x_, 0)}, {"y", packed(y_, 0)}};
  }

 private:
  Numbers count_, who_, x_, y_;
  std::int64_t landmark_ = 0;
};

Json scans_data(const runs::Run& run, std::size_t stride) {
  PackedScans scans;
  for (std::size_t k = 0; k < run.steps.size(); k += stride) {
    scans.add(run.steps[k], k < run.scans.size() ? &run.scans[k] : nullptr);
  }
  Json json = scans.json();
  json["stride"] = stride;
  return json;
}

/// Every scan, or as many as fit into `most_bytes`.
Json scans_within(const runs::Run& run, std::size_t most_bytes) {
  std::size_t observations = 0;
  for (const core::StepReport& step : run.steps) observations += step.associations.size();
  for (std::size_t stride = stride_for(observations, most_player_observations);; ++stride) {
    Json json = scans_data(run, stride);
    const std::size_t bytes = json.dump().size();
    if (bytes <= most_bytes || stride >= run.steps.size()) return json;
    stride = std::max(stride, stride * bytes / std::max<std::size_t>(most_bytes, 1) - 1);
  }
}

Json merges_data(const runs::Run& run) {
  Numbers at, kept, removed;
  for (std::size_t k = 0; k < run.steps.size(); ++k) {
    for (const core::MergedLandmarks& merge : run.steps[k].merged) {
      at.push_back(static_cast<std::int64_t>(k));
      kept.push_back(merge.kept);
      removed.push_back(merge.removed);
    }
  }
  return {{"step", packed(at, 1)}, {"kept", packed(kept, 1)}, {"removed", packed(removed, 1)}};
}

/// True positions in the map frame.
Json truth_data(const runs::Run& run, const evaluation::Evaluation& evaluation) {
  if (!evaluation.position) return nullptr;
  Numbers t, x, y;
  for (const evaluation::PositionError& error : evaluation.position->errors) {
    if (!error.used) continue;
    t.push_back(milliseconds_since(run.steps.front().t_ns, error.t_ns));
    x.push_back(quantised(error.true_map_m.x(), unit_m));
    y.push_back(quantised(error.true_map_m.y(), unit_m));
  }
  return {{"t", packed(t, 2)}, {"x", packed(x, 1)}, {"y", packed(y, 1)}, {"aligned", evaluation.position->aligned}};
}

/// Null if none is known.
Json true_landmarks_data(const runs::Run& run, const evaluation::Evaluation& evaluation) {
  if (run.truth.landmarks.empty()) return nullptr;
  Numbers x, y;
  for (const Eigen::Vector2d& point_m : true_landmarks_in_map(run, evaluation)) {
    x.push_back(quantised(point_m.x(), unit_m));
    y.push_back(quantised(point_m.y(), unit_m));
  }
  return {{"x", packed(x, 1)}, {"y", packed(y, 1)}};
}

}  // namespace

std::vector<Eigen::Vector2d> true_landmarks_in_map(const runs::Run& run, const evaluation::Evaluation& evaluation) {
  const core::Pose2 T_map_truth = core::inverse(evaluation.position ? evaluation.position->T_truth_map : core::Pose2{});
  std::vector<Eigen::Vector2d> points_m;
  for (const core::TrueLandmark& landmark : run.truth.landmarks) {
    points_m.push_back(core::transform(T_map_truth, landmark.point_m));
  }
  return points_m;
}

Json player_data(const runs::Run& run, const evaluation::Evaluation& evaluation) {
  if (run.steps.empty()) return nullptr;
  Json json = {{"begin_s", core::seconds(run.steps.front().t_ns)},
               {"first_step", run.steps.front().step},
               {"steps", run.steps.size()},
               {"path", path_data(run)},
               {"final", final_path_data(run)},
               {"modes", modes_data(run)},
               {"landmarks", player_landmarks(run)},
               {"merges", merges_data(run)},
               {"truth", truth_data(run, evaluation)},
               {"true_landmarks", true_landmarks_data(run, evaluation)},
               {"clouds", clouds_data(run)}};
  const std::size_t others = json.dump().size();
  json["scans"] = scans_within(run, most_player_bytes - std::min(most_player_bytes, others));
  return json;
}

}  // namespace helixnav::reports
