// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/odometry.hpp"

namespace helixnav::core {

Odometry chain(const Odometry& first, const Odometry& second) {
  const ComposeJacobians J = compose_jacobians(first.T_before_after, second.T_before_after);
  Odometry chained;
  chained.t_ns = second.t_ns;
  chained.T_before_after = compose(first.T_before_after, second.T_before_after);
  chained.covariance =
      J.J_first * first.covariance * J.J_first.transpose() + J.J_second * second.covariance * J.J_second.transpose();
  return chained;
}

}  // namespace helixnav::core
