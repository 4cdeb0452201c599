// SPDX-License-Identifier: BSD-3-Clause
#include "plausible.hpp"

#include "helixnav/core/gaussian.hpp"

namespace helixnav::logs {

std::optional<std::string> fault_of_covariance(const Eigen::Ref<const Eigen::MatrixXd>& covariance) {
  const auto variances = covariance.diagonal().array();
  if (!core::is_symmetric_positive_definite(covariance)) return "is not positive definite";
  if ((variances < least_variance).any() || (variances > most_variance).any()) {
    return "has variances outside of 1e-20 … 1e12";
  }
  return std::nullopt;
}

}  // namespace helixnav::logs
