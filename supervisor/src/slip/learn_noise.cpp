// SPDX-License-Identifier: BSD-3-Clause
// Noise that is learnt: what a scan says of it, and a drive told anew once it is known.
#include <algorithm>
#include <utility>
#include <vector>

#include "loop/navigation_loop.hpp"
#include "smoothing/smooth_drive.hpp"

namespace helixnav::supervisor {
namespace {

constexpr std::size_t most_observations = 24;

/// Pose and the landmarks of these pairs alone.
core::JointGaussian joint_of(const core::JointGaussian& all, const std::vector<std::size_t>& landmarks) {
  std::vector<Eigen::Index> rows{0, 1, 2};
  core::JointGaussian some;
  some.pose = all.pose;
  for (const std::size_t l : landmarks) {
    some.ids.push_back(all.ids[l]);
    some.points_m.push_back(all.points_m[l]);
    rows.push_back(3 + 2 * static_cast<Eigen::Index>(l));
    rows.push_back(4 + 2 * static_cast<Eigen::Index>(l));
  }
  some.covariance = all.covariance(rows, rows);
  return some;
}

}  // namespace

/// The joint estimate is that before the scan's update.
void NavigationLoop::learn_noise(const core::Scan& scan, const core::JointGaussian& joint,
                                 const std::vector<core::AssociationReport>& fate) {
  if (!options_.noise.adapt || searching() != nullptr) return;
  const std::vector<SeenPoint> seen = seen_points(scan, most_observations);
  std::vector<PointPair> pairs;
  std::vector<std::size_t> landmarks;
  for (std::size_t s = 0; s < seen.size(); ++s) {
    const core::AssociationReport& one = fate[static_cast<std::size_t>(seen[s].observation)];
    if (one.outcome != core::Outcome::matched) continue;
    const auto at = std::find(joint.ids.begin(), joint.ids.end(), one.landmark);
    if (at == joint.ids.end()) return;
    pairs.push_back({s, landmarks.size()});
    landmarks.push_back(static_cast<std::size_t>(at - joint.ids.begin()));
  }
  constexpr std::size_t least_pairs = 3;
  if (pairs.size() < least_pairs) return;
  const RelativeGeometry geometry(joint_of(joint, landmarks));
  belief_.noise.observe(PairEquations(geometry, seen, pairs, Eigen::Vector3d::Zero()), belief_.moved);
}

/// What was told with too little noise before that was known is told once more: the drive is solved with the noise as it is
/// known now, or else stays as it was told.
void NavigationLoop::tell_again() {
  constexpr double worth_it = 1.25;
  Mapping* mapping = std::get_if<Mapping>(&mode_);
  const double observations = belief_.noise.observations() / belief_.noise.told_observations;
  const double odometry = belief_.noise.odometry() / belief_.noise.told_odometry;
  if (mapping == nullptr || std::max({observations, 1.0 / observations, odometry, 1.0 / odometry}) < worth_it) return;
  belief_.noise.told_observations = belief_.noise.observations();
  belief_.noise.told_odometry = belief_.noise.odometry();
  if (!tape_.holds_drive()) return;
  Tape again = tape_.rescaled(observations, odometry);
  Smoothing smoothing = smooth_drive(belief_.filter, start_, again);
  if (!smoothing.solved) return;
  again.append(Tape::Solved{smoothing.chi2});
  Checkpoint trusted = take_checkpoint(belief_, again);
  trusted.filter = smoothing.solved->snapshot();
  std::swap(belief_.filter, *smoothing.solved);
  std::swap(tape_, again);
  mapping->trust(std::move(trusted));
}

}  // namespace helixnav::supervisor
