// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::cekf {

void CompressedEkf::replace_pose(const core::PoseGaussian& pose) {
  if (!pose.mean.vector().allFinite() || !core::is_symmetric_positive_semidefinite(pose.covariance)) {
    throw core::PreconditionError("replace_pose: the pose must be finite with a positive semidefinite covariance");
  }
  active_.pose = pose.mean;
  active_.P.view().topRows(3).setZero();
  active_.P.view().leftCols(3).setZero();
  active_.P.view().topLeftCorner<3, 3>() = 0.5 * (pose.covariance + pose.covariance.transpose());
  active_.A.view().leftCols(3).setZero();
}

}  // namespace helixnav::cekf
