// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include <mrpt/poses/CPose3DPDF.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include "estimator.hpp"
#include "helixnav/core/gaussian.hpp"

namespace helixnav::mrpt_adapter {

mrpt::poses::CPosePDFGaussian planar_pdf(const core::PoseGaussian& pose);

/// CPose3DPDFGaussian in the plane z = 0.
mrpt::poses::CPose3DPDF::Ptr gaussian_pdf(const core::PoseGaussian& pose);

/// CPose3DPDFParticles in the plane z = 0, of equal weight unless weights are given.
mrpt::poses::CPose3DPDF::Ptr particle_pdf(const std::vector<core::Pose2>& cloud);
mrpt::poses::CPose3DPDF::Ptr particle_pdf(const std::vector<WeightedPose>& particles);

/// InputError when mean or covariance is not that of a Gaussian.
core::PoseGaussian gaussian_of(const mrpt::poses::CPosePDF& pdf);

}  // namespace helixnav::mrpt_adapter
