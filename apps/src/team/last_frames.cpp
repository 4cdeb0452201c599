// SPDX-License-Identifier: BSD-3-Clause
#include "team/last_frames.hpp"

#include <algorithm>
#include <limits>

namespace helixnav::apps {
namespace {

bool is_same(const team::TeamJoin& a, const team::TeamJoin& b) {
  return a.by == b.by && a.t_ns == b.t_ns && a.robot == b.robot && a.other == b.other &&
         a.T_component_other.vector() == b.T_component_other.vector();
}

bool is_same(const Joins& a, const Joins& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const team::TeamJoin& one, const team::TeamJoin& other) { return is_same(one, other); });
}

/// The length of their common beginning.
std::size_t common_joins(const Joins& a, const Joins& b) {
  std::size_t common = 0;
  while (common < a.size() && common < b.size() && is_same(a[common], b[common])) ++common;
  return common;
}

}  // namespace

std::size_t LastFrames::note(const Joins& joins) {
  if (noted_.empty() || !is_same(noted_.back(), joins)) noted_.push_back(joins);
  return noted_.size() - 1;
}

Joins LastFrames::that_moved(int robot, const Joins& joins) const {
  std::vector<int> component = first_component_;
  Joins moved;
  for (const team::TeamJoin& join : joins) {
    const int from = component[static_cast<std::size_t>(join.other)];
    if (component[static_cast<std::size_t>(robot)] == from) moved.push_back(join);
    std::replace(component.begin(), component.end(), from, component[static_cast<std::size_t>(join.robot)]);
  }
  return moved;
}

core::Pose2 LastFrames::T_end_then(int robot, std::size_t then) const {
  const Joins before = that_moved(robot, noted_[then]);
  const Joins last = that_moved(robot, noted_.back());
  const std::size_t common = common_joins(before, last);
  core::Pose2 T;
  for (std::size_t j = before.size(); j-- > common;) T = core::compose(core::inverse(before[j].T_component_other), T);
  for (std::size_t j = common; j < last.size(); ++j) T = core::compose(last[j].T_component_other, T);
  return T;
}

core::Nanoseconds LastFrames::since_ns(int robot) const {
  const Joins last = that_moved(robot, noted_.back());
  return last.empty() ? std::numeric_limits<core::Nanoseconds>::min() : last.back().t_ns;
}

bool LastFrames::was_taken_back(int robot, std::size_t then) const {
  const Joins before = that_moved(robot, noted_[then]);
  const Joins last = that_moved(robot, noted_.back());
  return std::any_of(before.begin() + static_cast<std::ptrdiff_t>(common_joins(before, last)), before.end(),
                     [&](const team::TeamJoin& join) {
                       return std::none_of(last.begin(), last.end(), [&](const team::TeamJoin& stays) {
                         return stays.by == join.by && stays.robot == join.robot && stays.other == join.other;
                       });
                     });
}

}  // namespace helixnav::apps
