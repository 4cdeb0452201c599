// SPDX-License-Identifier: BSD-3-Clause
#include "pose_pdf.hpp"

#include <cmath>
#include <memory>

#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/poses/CPose3DPDFParticles.h>

#include "helixnav/core/errors.hpp"
#include "matrices.hpp"

namespace helixnav::mrpt_adapter {

mrpt::poses::CPosePDFGaussian planar_pdf(const core::PoseGaussian& pose) {
  const mrpt::poses::CPose2D mean(pose.mean.x_m, pose.mean.y_m, pose.mean.heading_rad);
  return {mean, mrpt_of(pose.covariance)};
}

mrpt::poses::CPose3DPDF::Ptr gaussian_pdf(const core::PoseGaussian& pose) {
  auto pdf = std::make_shared<mrpt::poses::CPose3DPDFGaussian>();
  pdf->mean = mrpt::poses::CPose3D(pose.mean.x_m, pose.mean.y_m, 0.0, pose.mean.heading_rad, 0.0, 0.0);
  constexpr int planar[] = {0, 1, 3};  // of (x, y, z, yaw, pitch, roll)
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) pdf->cov(planar[r], planar[c]) = pose.covariance(r, c);
  }
  return pdf;
}

mrpt::poses::CPose3DPDF::Ptr particle_pdf(const std::vector<WeightedPose>& particles) {
  auto pdf = std::make_shared<mrpt::poses::CPose3DPDFParticles>(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    const core::Pose2& T = particles[i].T_world_robot;
    pdf->m_particles[i].d = mrpt::math::TPose3D(T.x_m, T.y_m, 0.0, T.heading_rad, 0.0, 0.0);
    pdf->m_particles[i].log_w = particles[i].log_weight;
  }
  return pdf;
}

mrpt::poses::CPose3DPDF::Ptr particle_pdf(const std::vector<core::Pose2>& cloud) {
  std::vector<WeightedPose> particles;
  for (const core::Pose2& T_world_robot : cloud) particles.push_back({T_world_robot, 0.0});
  return particle_pdf(particles);
}

core::PoseGaussian gaussian_of(const mrpt::poses::CPosePDF& pdf) {
  const auto [covariance, mean] = pdf.getCovarianceAndMean();
  core::PoseGaussian pose;
  pose.mean = core::Pose2(mean.x(), mean.y(), mean.phi());
  pose.covariance = eigen_of(covariance);
  if (!pose.mean.vector().allFinite() || !core::is_symmetric_positive_semidefinite(pose.covariance)) {
    throw core::InputError("start pose x0: mean or covariance is not that of a Gaussian");
  }
  return pose;
}

}  // namespace helixnav::mrpt_adapter
