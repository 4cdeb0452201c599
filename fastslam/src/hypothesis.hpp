// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "scan_model.hpp"

namespace helixnav::fastslam {

/// What an observation was taken for: a lineage, or one of these.
using Choice = std::int32_t;
inline constexpr Choice begins_landmark = -1;
inline constexpr Choice of_nothing = -2;  ///< spurious, ambiguous, or not looked at yet

/// A particle in the middle of a scan: its pose is known to N(x, P), P = 0 when it was drawn from the motion already.
struct Hypothesis {
  Eigen::Vector3d x = Eigen::Vector3d::Zero();
  Eigen::Matrix3d P = Eigen::Matrix3d::Zero();
  TurnedPose pose;  ///< of x
  double log_weight = 0.0;
  std::uint32_t parent = 0;
};

/// Hypotheses with a choice for every observation of the scan.
struct HypothesisSet {
  std::vector<Hypothesis> all;
  std::vector<Choice> choices;  ///< [hypothesis · observations + observation]
  std::size_t observations = 0;

  std::size_t size() const { return all.size(); }
  Choice* choices_of(std::size_t h) { return choices.data() + h * observations; }
  const Choice* choices_of(std::size_t h) const { return choices.data() + h * observations; }
  void clear() { all.clear(), choices.clear(); }
  void append(const Hypothesis& hypothesis, const Choice* of) {
    all.push_back(hypothesis);
    choices.insert(choices.end(), of, of + observations);
  }
};

}  // namespace helixnav::fastslam
