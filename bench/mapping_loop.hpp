// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <variant>
#include <vector>

#include <time.h>

#include "helixnav/association/associate.hpp"
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/odometry.hpp"
#include "helixnav/core/step_report.hpp"
#include "measures.hpp"

namespace helixnav::bench {

/// EKF-SLAM as the association papers run it: no landmark is ever removed, every observation far from all landmarks
/// begins one, nothing else decides. The results are then due to the methods alone.
struct MappingOptions {
  association::Method method = association::Method::likelihood_ratio;
  association::Options association;
  association::Gates gates;
  double extraneous_per_scan = 1.0;
  cekf::FilterOptions filter;
};

struct MappingRun {
  std::vector<core::StepReport> steps;  ///< with pose and associations
  std::vector<double> association_us;   ///< processor time of associate() alone, by scan
  core::PoseGaussian pose;              ///< at the end
  std::vector<core::MapLandmark> map;
};

/// Called with the problem of each scan before it is solved.
using SeesProblem = std::function<void(const association::InnovationProblem&)>;

class MappingLoop {
 public:
  MappingLoop(const core::PoseGaussian& start, MappingOptions options, SeesProblem sees_problem = {})
      : options_(std::move(options)), filter_(start, options_.filter), sees_problem_(std::move(sees_problem)) {}

  void take(const core::Event& event) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) filter_.predict(*odometry);
    if (const auto* scan = std::get_if<core::Scan>(&event)) take_scan(*scan);
  }

  MappingRun finish() {
    run_.pose = filter_.pose();
    for (const core::LandmarkId id : filter_.landmarks()) {
      run_.map.push_back({id, filter_.landmark(id), 0, core::LandmarkState::mature});
    }
    return std::move(run_);
  }

 private:
  void take_scan(const core::Scan& scan) {
    constexpr double beyond_view_m = 10.0;
    const Eigen::Vector2d sensor_m = core::transform(filter_.pose().mean, scan.T_robot_sensor.position_m());
    const double reach_m = std::min(1e4, scan.field_of_view.max_range_m + beyond_view_m);
    const core::JointGaussian joint = filter_.joint(filter_.landmarks_within(sensor_m, reach_m));
    const association::InnovationProblem problem = association::make_innovation_problem(joint, scan, options_.gates);
    if (sees_problem_) sees_problem_(problem);
    association::Options how = options_.association;
    if (std::isfinite(scan.field_of_view.max_range_m)) {
      how.extraneous = association::uniform_density(scan.field_of_view, options_.extraneous_per_scan);
    }
    const double begin_s = seconds_of_this_thread();
    const association::Assignment assignment = association::associate(options_.method, problem, how);
    run_.association_us.push_back(1e6 * (seconds_of_this_thread() - begin_s));
    apply(scan, assignment);
  }

  void apply(const core::Scan& scan, const association::Assignment& assignment) {
    core::StepReport report;
    report.step = static_cast<std::int64_t>(run_.steps.size());
    report.t_ns = scan.t_ns;
    std::vector<cekf::Match> matches;
    for (const association::ObservationOutcome& outcome : assignment.observations) {
      core::AssociationReport& association = report.associations.emplace_back();
      association.observation = static_cast<int>(report.associations.size()) - 1;
      association.landmark = outcome.landmark;
      if (outcome.outcome == association::Outcome::ambiguous) continue;
      const core::Observation& observation = scan.observations[static_cast<std::size_t>(association.observation)];
      const bool matched = outcome.outcome == association::Outcome::matched;
      association.outcome = matched ? core::Outcome::matched : core::Outcome::augmented;
      if (matched) matches.push_back({outcome.landmark, observation, scan.T_robot_sensor});
    }
    if (!matches.empty()) filter_.update(matches);
    for (core::AssociationReport& association : report.associations) {
      if (association.outcome != core::Outcome::augmented) continue;
      association.landmark =
          filter_.augment(scan.observations[static_cast<std::size_t>(association.observation)], scan.T_robot_sensor);
    }
    filter_.switch_region_if_due();
    report.pose = filter_.pose();
    run_.steps.push_back(std::move(report));
  }

  MappingOptions options_;
  cekf::CompressedEkf filter_;
  SeesProblem sees_problem_;
  MappingRun run_;
};

inline MappingRun map_along(const core::PoseGaussian& start, const std::vector<core::Event>& events,
                            const MappingOptions& options, const SeesProblem& sees_problem = {}) {
  MappingLoop loop(start, options, sees_problem);
  for (const core::Event& event : events) loop.take(event);
  return loop.finish();
}

}  // namespace helixnav::bench
