// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/navigator.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "association_report.hpp"
#include "candidates.hpp"
#include "helixnav/core/chi2.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/odometry.hpp"

namespace helixnav::supervisor {

using core::AssociationReport;
using core::LandmarkId;
using core::Outcome;
using core::Scan;
using core::StepReport;

Navigator::Navigator(const core::PoseGaussian& start, const NavigatorOptions& options)
    : options_(options), filter_(start, options.filter), life_(options.life), delayed_(options.delayed) {}

void Navigator::move(const core::Odometry& odometry) { motion_ = motion_ ? core::chain(*motion_, odometry) : odometry; }

StepReport Navigator::observe(const Scan& scan) {
  predict();
  StepReport report;
  report.associations = associate(scan);
  update(scan, report);
  augment(scan, report);
  live_and_let_die(scan, report);
  report.switched_region = filter_.switch_region_if_due();
  return close_step(scan, report);
}

StepReport Navigator::observe(const Scan& scan, const std::vector<std::int64_t>& identities) {
  StepReport report;
  report.associations = known_associations(scan, identities);
  predict();
  update(scan, report);
  augment_known(scan, identities, report);
  remember(identities, report);
  report.switched_region = filter_.switch_region_if_due();
  return close_step(scan, report);
}

bool Navigator::fix(const core::AbsoluteFix& fix) {
  predict();
  const double nis = filter_.position_innovation(fix).nis;
  const double limit = core::chi2_quantile(options_.fix_probability, 2);
  const bool accepted = nis <= limit;
  if (accepted) filter_.update_position(fix);
  const core::PoseGaussian now = filter_.pose();
  decisions_.push_back({"fix",
                        accepted ? "accepted" : "refused",
                        {{"nis", nis},
                         {"gate", limit},
                         {"x_m", fix.position_world_m.x()},
                         {"y_m", fix.position_world_m.y()},
                         {"pose_sigma_m", std::sqrt(now.covariance.topLeftCorner<2, 2>().trace())}}});
  return accepted;
}

void Navigator::predict() {
  if (!motion_) return;
  filter_.predict(*motion_);
  motion_.reset();
}

std::vector<AssociationReport> Navigator::associate(const Scan& scan) const {
  const core::JointGaussian joint = filter_.joint(candidates(filter_, scan, options_.candidate_sigmas));
  const association::InnovationProblem problem = association::make_innovation_problem(joint, scan, options_.gates);
  association::Options how = options_.association;
  if (std::isfinite(scan.field_of_view.max_range_m)) {
    how.extraneous = association::uniform_density(scan.field_of_view, options_.extraneous_per_scan);
  }
  return association_reports(association::associate(options_.method, problem, how));
}

std::vector<AssociationReport> Navigator::known_associations(const Scan& scan,
                                                             const std::vector<std::int64_t>& identities) const {
  if (identities.size() != scan.observations.size()) {
    throw core::PreconditionError("observe: " + std::to_string(identities.size()) + " identities for " +
                                  std::to_string(scan.observations.size()) + " observations");
  }
  std::vector<AssociationReport> reports(identities.size());
  std::set<std::int64_t> born;
  for (std::size_t i = 0; i < identities.size(); ++i) {
    reports[i].observation = static_cast<int>(i);
    const auto known = landmark_of_identity_.find(identities[i]);
    if (identities[i] < 0) {
      reports[i].outcome = Outcome::rejected;
    } else if (known == landmark_of_identity_.end()) {
      const bool first = born.insert(identities[i]).second;
      reports[i].outcome = first ? Outcome::augmented : Outcome::rejected;
    } else {
      reports[i].outcome = Outcome::matched;
      reports[i].landmark = known->second;
    }
  }
  return reports;
}

void Navigator::update(const Scan& scan, StepReport& report) {
  const std::vector<cekf::Match> matched = matches(scan, report.associations);
  if (matched.empty()) return;
  const cekf::UpdateResult result = filter_.update(matched);
  report.joint_nis = result.nis;
  report.joint_dof = result.dof;
}

void Navigator::augment(const Scan& scan, StepReport& report) {
  for (AssociationReport& association : report.associations) {
    if (association.outcome != Outcome::augmented) continue;
    const core::Observation& observation = scan.observations[static_cast<std::size_t>(association.observation)];
    if (core::dimension(observation.kind) == 1) {
      association.outcome = Outcome::ambiguous;  // without a name nobody can gather its sightings
      continue;
    }
    association.landmark = filter_.augment(observation, scan.T_robot_sensor);
  }
}

void Navigator::augment_known(const Scan& scan, const std::vector<std::int64_t>& identities, StepReport& report) {
  for (AssociationReport& association : report.associations) {
    if (association.outcome != Outcome::augmented) continue;
    const auto index = static_cast<std::size_t>(association.observation);
    const core::Observation& observation = scan.observations[index];
    if (core::dimension(observation.kind) == 2) {
      association.landmark = filter_.augment(observation, scan.T_robot_sensor);
      continue;
    }
    const auto entered = delayed_.sight(filter_, identities[index], observation, scan.T_robot_sensor);
    if (entered) {
      association.landmark = *entered;
    } else {
      association.outcome = Outcome::ambiguous;
    }
  }
}

void Navigator::live_and_let_die(const Scan& scan, StepReport& report) {
  const std::vector<LandmarkId> seen = landmarks_with(Outcome::matched, report.associations);
  const std::vector<LandmarkId> born = landmarks_with(Outcome::augmented, report.associations);
  std::vector<LandmarkId> expected = expected_in_view(filter_, scan, options_.view_margin_m);
  for (const Outcome no_miss : {Outcome::ambiguous, Outcome::rejected, Outcome::augmented}) {
    for (const LandmarkId id : landmarks_with(no_miss, report.associations)) {
      expected.erase(std::remove(expected.begin(), expected.end(), id), expected.end());
    }
  }
  const Eigen::Vector2d sensor_m = core::transform(filter_.pose().mean, scan.T_robot_sensor.position_m());
  const association::LifeChanges changes = life_.observe(sensor_m, seen, born, expected);
  for (const LandmarkId id : changes.died) filter_.remove(id);
}

void Navigator::remember(const std::vector<std::int64_t>& identities, const StepReport& report) {
  for (const AssociationReport& association : report.associations) {
    const std::int64_t identity = identities[static_cast<std::size_t>(association.observation)];
    if (association.outcome == Outcome::augmented) landmark_of_identity_[identity] = association.landmark;
    if (association.landmark != core::no_landmark) ++observations_of_known_[association.landmark];
  }
}

StepReport Navigator::close_step(const Scan& scan, StepReport report) {
  report.step = step_++;
  report.t_ns = scan.t_ns;
  report.pose = filter_.pose();
  report.active_landmarks = filter_.active_count();
  report.mapped_landmarks = filter_.mapped_count() - delayed_.clones();
  report.decisions.insert(report.decisions.begin(), decisions_.begin(), decisions_.end());
  decisions_.clear();
  return report;
}

std::vector<core::MapLandmark> Navigator::map() const {
  std::vector<core::MapLandmark> landmarks;
  for (const LandmarkId id : filter_.landmarks()) {
    if (delayed_.is_clone(id)) continue;
    core::MapLandmark landmark;
    landmark.id = id;
    landmark.point = filter_.landmark(id);
    const auto known = observations_of_known_.find(id);
    if (known != observations_of_known_.end()) {
      landmark.observations = known->second;
      landmark.state = core::LandmarkState::mature;
    } else if (life_.contains(id)) {
      landmark.observations = life_.record(id).observations;
      landmark.state = life_.state(id);
    }
    landmarks.push_back(landmark);
  }
  return landmarks;
}

}  // namespace helixnav::supervisor
