// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <memory>
#include <utility>
#include <variant>

#include "estimator.hpp"
#include "helixnav/fastslam/fast_slam.hpp"
#include "helixnav/fastslam/observe.hpp"
#include "helixnav/fastslam/path_tree.hpp"

namespace helixnav::apps {
namespace {

constexpr double points_a_loop = 50.0;  ///< marked on the paths along genealogy_m of drive

fastslam::Options options_of(const Drive& job) {
  fastslam::Options options = job.fastslam.options;
  if (job.known_association) options.existence.remove = false;  // named landmarks exist
  return options;
}

/// [scan fed] its step; withheld scans have one, too.
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
    return known_ ? fastslam::observe_known(slam_, scan, labels_.at(scans_)) : fastslam::observe(slam_, scan);
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
