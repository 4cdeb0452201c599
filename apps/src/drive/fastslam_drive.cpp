// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstddef>
#include <memory>
#include <set>
#include <utility>
#include <variant>

#include "estimator.hpp"
#include "helixnav/core/thin_scan.hpp"
#include "helixnav/fastslam/fast_slam.hpp"
#include "helixnav/fastslam/path_tree.hpp"

namespace helixnav::apps {
namespace {

using fastslam::KnownName;

constexpr double points_a_loop = 50.0;  ///< marked on the paths along genealogy_m of drive

fastslam::Options options_of(const Drive& job) {
  fastslam::Options options = job.fastslam.options;
  if (job.known_association) options.existence.remove = false;  // what has a name is there
  return options;
}

/// Names as FastSLAM takes them: of a label that is there twice, the first counts.
std::vector<KnownName> names_of(const std::vector<core::Label>& labels) {
  std::vector<KnownName> names;
  std::set<core::Label> seen;
  for (const core::Label label : labels) {
    const bool counts = label >= 0 && seen.insert(label).second;
    names.push_back(counts ? KnownName{label} : fastslam::no_name);
  }
  return names;
}

/// [scan fed] its step: those withheld have one, too.
std::vector<std::int64_t> steps_fed(const Drive& job) {
  std::vector<std::int64_t> steps;
  std::size_t step = 0;
  for (const core::Event& event : job.recording.events) {
    if (!std::holds_alternative<core::Scan>(event)) continue;
    if (job.withheld.empty() || !job.withheld[step]) steps.push_back(static_cast<std::int64_t>(step));
    ++step;
  }
  return steps;
}

/// FastSLAM as core::EventLoop wants it.
class FastSlamDrive {
 public:
  explicit FastSlamDrive(const Drive& job)
      : steps_(steps_fed(job)),
        labels_(labels_fed(job)),
        known_(job.known_association),
        mark_m_(job.fastslam.options.genealogy_m / points_a_loop),
        slam_(job.recording.start, options_of(job), job.fastslam.seed),
        pose_(job.recording.start) {}

  std::optional<core::StepReport> take(const core::Event& event) {
    if (const auto* odometry = std::get_if<core::Odometry>(&event)) move(*odometry);
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) return std::nullopt;
    core::StepReport report = observe(*scan);
    report.active_landmarks = report.mapped_landmarks;  // any may be matched
    pose_ = report.pose;
    paths_.descend(slam_.parents());
    if (scans_ == 0 || since_mark_m_ >= mark_m_) mark_paths(scans_);
    ++scans_;
    return report;
  }

  core::PoseGaussian pose() const { return pose_; }
  std::vector<core::MapLandmark> map() const { return slam_.map(); }
  runs::ParticleEnd end() {
    if (scans_ > 0 && since_mark_m_ > 0.0) mark_paths(scans_ - 1);  // up to where the particles are now
    return {paths_.points(slam_.weights()), slam_.mixture()};
  }

 private:
  void move(const core::Odometry& odometry) {
    slam_.predict(odometry);
    since_mark_m_ += odometry.T_before_after.position_m().norm();
  }

  core::StepReport observe(const core::Scan& scan) {
    if (scan.observations.size() <= core::most_observations_used) return update(scan, all_of(scan));
    const std::vector<std::size_t> used = core::observations_to_use(scan);
    core::StepReport report = update(core::thinned(scan, used), used);
    std::vector<core::AssociationReport> all = core::reports_of_none(scan.observations.size());
    core::name_in_whole_scan(used, all, report.associations);
    report.decisions.push_back(core::thinning_decision(scan.observations.size(), used.size()));
    return report;
  }

  static std::vector<std::size_t> all_of(const core::Scan& scan) {
    std::vector<std::size_t> places(scan.observations.size());
    for (std::size_t i = 0; i < places.size(); ++i) places[i] = i;
    return places;
  }

  /// `used`: places of the observations among the labels of the scan.
  core::StepReport update(const core::Scan& scan, const std::vector<std::size_t>& used) {
    if (!known_) return slam_.update(scan);
    std::vector<core::Label> labels;
    for (const std::size_t i : used) labels.push_back(labels_.at(scans_).at(i));
    const std::vector<KnownName> names = names_of(labels);
    core::StepReport report = slam_.update_known(scan, names);
    for (std::size_t j = 0; j < names.size(); ++j) {
      if (names[j] == fastslam::no_name) report.associations[j].outcome = core::Outcome::rejected;
    }
    return report;
  }

  void mark_paths(std::size_t scan) {
    since_mark_m_ = 0.0;
    paths_.mark(steps_.at(scan), slam_.poses());
  }

  std::vector<std::int64_t> steps_;               ///< [scan fed]
  std::vector<std::vector<core::Label>> labels_;  ///< [scan fed]
  bool known_;
  double mark_m_, since_mark_m_ = 0.0;
  fastslam::FastSlam slam_;
  fastslam::PathTree paths_;
  core::PoseGaussian pose_;
  std::size_t scans_ = 0;  ///< fed
};

}  // namespace

Estimator fastslam_of(const Drive& job) {
  const auto drive = std::make_shared<FastSlamDrive>(job);
  return {[drive](const core::Event& event) { return drive->take(event); }, [drive] { return drive->pose(); },
          [drive] { return drive->map(); }, [] { return std::nullopt; }, [drive] { return drive->end(); }};
}

}  // namespace helixnav::apps
