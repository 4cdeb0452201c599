// SPDX-License-Identifier: BSD-3-Clause
#include "team/mapped_anew.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

namespace helixnav::apps {
namespace {

constexpr core::Nanoseconds lately_ns = 10'000'000'000;

/// The current landmark of those merged into another.
class LandmarksNow {
 public:
  explicit LandmarksNow(const TeamDrive& drive) {
    for (const TeamDrive::Robot& robot : drive.robots) {
      for (const core::StepReport& step : robot.steps) {
        for (const core::MergedLandmarks& one : step.merged) became_[one.removed] = one.kept;
      }
    }
  }
  core::LandmarkId operator()(core::LandmarkId id) const {
    // A merge may be taken back, and redone the other way round.
    for (std::size_t hops = 0; hops < became_.size(); ++hops) {
      const auto next = became_.find(id);
      if (next == became_.end()) break;
      id = next->second;
    }
    return id;
  }

 private:
  std::map<core::LandmarkId, core::LandmarkId> became_;
};

bool is_of_landmark(const core::AssociationReport& one) {
  return one.outcome == core::Outcome::matched || one.outcome == core::Outcome::augmented;
}

using Times = std::map<core::LandmarkId, core::Nanoseconds>;

/// When any robot saw each landmark first.
Times first_seen_ns(const TeamDrive& drive, const LandmarksNow& now) {
  Times first_ns;
  for (const TeamDrive::Robot& robot : drive.robots) {
    for (const core::StepReport& step : robot.steps) {
      for (const core::AssociationReport& one : step.associations) {
        if (!is_of_landmark(one)) continue;
        core::Nanoseconds& first = first_ns.emplace(now(one.landmark), step.t_ns).first->second;
        first = std::min(first, step.t_ns);
      }
    }
  }
  return first_ns;
}

struct Polar {
  double range_m = 0.0;
  double bearing_rad = 0.0;
};

Polar seen_from(const core::Pose2& T_frame_robot, const Eigen::Vector2d& point_m) {
  const Eigen::Vector2d at_m = core::transform(core::inverse(T_frame_robot), point_m);
  return {at_m.norm(), std::atan2(at_m.y(), at_m.x())};
}

/// The region in which the robot saw landmarks.
struct View {
  double reach_m = 0.0;
  double least_rad = 0.0, most_rad = 0.0;

  bool holds(const Polar& at) const {
    return at.range_m < reach_m && at.bearing_rad > least_rad && at.bearing_rad < most_rad;
  }
};

double quantile(std::vector<double>& values, double share) {
  const auto at = values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

using Points = std::map<core::LandmarkId, Eigen::Vector2d>;

Points known_points_m(const TeamDrive& drive, std::size_t robot) {
  constexpr int known_observations = 5;
  Points points_m;
  for (const core::MapLandmark& landmark : drive.team.map(static_cast<int>(robot))) {
    if (landmark.observations >= known_observations) points_m[landmark.id] = landmark.point.mean_m;
  }
  return points_m;
}

std::optional<View> view_of(const TeamDrive::Robot& robot, const Points& points_m, const LandmarksNow& now) {
  std::vector<double> ranges_m, bearings_rad;
  for (const core::StepReport& step : robot.steps) {
    for (const core::AssociationReport& one : step.associations) {
      const auto point = one.outcome == core::Outcome::matched ? points_m.find(now(one.landmark)) : points_m.end();
      if (point == points_m.end()) continue;
      const Polar at = seen_from(step.pose.mean, point->second);
      ranges_m.push_back(at.range_m);
      bearings_rad.push_back(at.bearing_rad);
    }
  }
  constexpr std::size_t enough = 50;
  if (ranges_m.size() < enough) return std::nullopt;
  return View{quantile(ranges_m, 0.9), quantile(bearings_rad, 0.05), quantile(bearings_rad, 0.95)};
}

struct Scan {
  core::Nanoseconds t_ns = 0;
  int expected = 0, missed = 0, seen = 0, begun = 0;
};

/// Counts over the scans in which anything was seen.
std::vector<Scan> count_scans(const TeamDrive::Robot& robot, const Points& points_m, const View& view,
                              const LandmarksNow& now, const Times& begun_ns) {
  Times since_ns;
  std::vector<Scan> scans;
  for (const core::StepReport& step : robot.steps) {
    if (step.associations.empty()) continue;
    Scan& scan = scans.emplace_back();
    scan.t_ns = step.t_ns;
    std::set<core::LandmarkId> matched;
    for (const core::AssociationReport& one : step.associations) {
      ++scan.seen;
      if (!is_of_landmark(one)) continue;
      const core::LandmarkId id = now(one.landmark);
      since_ns.emplace(id, step.t_ns);
      scan.begun += step.t_ns - begun_ns.at(id) < lately_ns ? 1 : 0;
      if (one.outcome == core::Outcome::matched) matched.insert(id);
    }
    for (const auto& [id, first_ns] : since_ns) {
      const auto point = step.t_ns - first_ns > lately_ns ? points_m.find(id) : points_m.end();
      if (point == points_m.end() || !view.holds(seen_from(step.pose.mean, point->second))) continue;
      ++scan.expected;
      scan.missed += matched.count(id) == 0 ? 1 : 0;
    }
  }
  return scans;
}

double share(int part, int all) { return all == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(all); }

}  // namespace

std::optional<MappedAnew> mapped_anew(const TeamDrive& drive, std::size_t robot) {
  constexpr std::size_t together = 20;
  constexpr int enough = 20;
  constexpr double most = 0.8;
  const LandmarksNow now(drive);
  const Points points_m = known_points_m(drive, robot);
  const std::optional<View> view = view_of(drive.robots[robot], points_m, now);
  if (!view) return std::nullopt;
  const std::vector<Scan> scans = count_scans(drive.robots[robot], points_m, *view, now, first_seen_ns(drive, now));
  std::optional<MappedAnew> worst;
  for (std::size_t first = 0; first + together <= scans.size(); ++first) {
    Scan sum;
    for (std::size_t k = first; k < first + together; ++k) {
      sum.expected += scans[k].expected;
      sum.missed += scans[k].missed;
      sum.seen += scans[k].seen;
      sum.begun += scans[k].begun;
    }
    const MappedAnew here{scans[first].t_ns, scans[first + together - 1].t_ns, share(sum.missed, sum.expected),
                          share(sum.begun, sum.seen)};
    const double both = std::min(here.missed, here.begun);
    if (sum.expected < enough || both < most) continue;
    if (!worst || both > std::min(worst->missed, worst->begun)) worst = here;
  }
  return worst;
}

}  // namespace helixnav::apps
