// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "helixnav/smoothing/optimize.hpp"

namespace helixnav::smoothing {

/// A problem that optimize() has taken to its minimum, with the factorisation that it ended with.
class Minimum {
 public:
  /// As optimize(). The problem must outlive the object.
  explicit Minimum(Problem& problem, const Options& options = {});
  ~Minimum();
  Minimum(Minimum&&) noexcept;
  Minimum& operator=(Minimum&&) noexcept;

  const Report& report() const;

  /// smoothing::joint_covariance() at the minimum, without another factorisation. Test: smoothing/marginals_test.cpp.
  Eigen::MatrixXd joint_covariance(const std::vector<int>& poses, const std::vector<int>& landmarks) const;

 private:
  struct Solved;
  std::unique_ptr<Solved> solved_;
};

}  // namespace helixnav::smoothing
