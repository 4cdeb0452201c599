// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/fastslam/path_tree.hpp"

#include <algorithm>
#include <string>

#include "helixnav/core/errors.hpp"

namespace helixnav::fastslam {
namespace {

/// Only what is on some path, with new indices; `last` are the ends of the paths.
std::vector<core::PathPoint> living(const std::vector<core::PathPoint>& points, std::vector<std::ptrdiff_t>& last) {
  std::vector<bool> lives(points.size(), false);
  for (const std::ptrdiff_t end : last) lives[static_cast<std::size_t>(end)] = true;
  for (std::size_t i = points.size(); i-- > 0;) {
    if (lives[i] && points[i].before >= 0) lives[static_cast<std::size_t>(points[i].before)] = true;
  }
  std::vector<core::PathPoint> left;
  std::vector<std::ptrdiff_t> now_at(points.size(), -1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!lives[i]) continue;
    now_at[i] = static_cast<std::ptrdiff_t>(left.size());
    core::PathPoint& point = left.emplace_back(points[i]);
    if (point.before >= 0) point.before = now_at[static_cast<std::size_t>(point.before)];
  }
  for (std::ptrdiff_t& end : last) end = now_at[static_cast<std::size_t>(end)];
  return left;
}

}  // namespace

void PathTree::descend(const std::vector<std::uint32_t>& parents) {
  if (last_.empty()) return;
  std::vector<std::ptrdiff_t> last;
  last.reserve(parents.size());
  for (const std::uint32_t parent : parents) last.push_back(last_.at(parent));
  last_ = std::move(last);
}

void PathTree::mark(std::int64_t step, const std::vector<core::Pose2>& poses) {
  if (!last_.empty() && last_.size() != poses.size()) {
    throw core::PreconditionError("PathTree: " + std::to_string(poses.size()) + " poses of " +
                                  std::to_string(last_.size()) + " particles");
  }
  if (last_.empty()) last_.assign(poses.size(), -1);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    points_.push_back({step, last_[k], poses[k], 0.0});
    last_[k] = static_cast<std::ptrdiff_t>(points_.size()) - 1;
  }
  if (points_.size() > least_to_look_) forget_the_dead();
}

void PathTree::forget_the_dead() {
  points_ = living(points_, last_);
  least_to_look_ = 2 * points_.size() + 1000;
}

std::vector<core::PathPoint> PathTree::points(const std::vector<double>& weights) const {
  if (weights.size() != last_.size() && !last_.empty()) {
    throw core::PreconditionError("PathTree: " + std::to_string(weights.size()) + " weights of " +
                                  std::to_string(last_.size()) + " particles");
  }
  std::vector<std::ptrdiff_t> last = last_;
  std::vector<core::PathPoint> points = living(points_, last);
  for (std::size_t k = 0; k < last.size(); ++k) points[static_cast<std::size_t>(last[k])].share += weights[k];
  for (std::size_t i = points.size(); i-- > 0;) {
    if (points[i].before >= 0) points[static_cast<std::size_t>(points[i].before)].share += points[i].share;
  }
  return points;
}

}  // namespace helixnav::fastslam
