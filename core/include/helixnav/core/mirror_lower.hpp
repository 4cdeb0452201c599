// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace helixnav::core {

/// The upper triangle of a square matrix becomes that below. Tile by tile, because the elements of a row are far apart in
/// memory. O(n²). Test: core/gaussian_test.cpp.
void mirror_lower(Eigen::Ref<Eigen::MatrixXd> P);

}  // namespace helixnav::core
