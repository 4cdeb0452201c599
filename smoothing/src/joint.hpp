// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "session.hpp"

namespace helixnav::smoothing {

/// Where each column of a factorised session's H is in the elimination order.
std::vector<int> positions(const Session& session);

/// Columns of H that the chosen variables occupy, poses first, −1 for each coordinate of a fixed pose. PreconditionError
/// if there is no such variable.
std::vector<int> columns_of(const Session& session, const std::vector<int>& poses, const std::vector<int>& landmarks);

/// Blocks of H⁻¹ of a factorised session, all pairs of the variables chosen; zero for fixed poses.
Eigen::MatrixXd joint_covariance(const Session& session, const std::vector<int>& poses,
                                 const std::vector<int>& landmarks);

}  // namespace helixnav::smoothing
