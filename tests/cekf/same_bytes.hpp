// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstring>
#include <string>

#include "helixnav/cekf/compressed_ekf.hpp"

namespace helixnav::cekf {

enum class Passive { with_covariances, means_only };

/// Everything a caller can learn about the filter, and its weights, as bytes.
inline std::string bytes_of(const CompressedEkf& filter, Passive passive = Passive::with_covariances) {
  std::string bytes;
  const auto add = [&](const void* data, std::size_t size) { bytes.append(static_cast<const char*>(data), size); };
  const auto add_matrix = [&](const Eigen::MatrixXd& m) { add(m.data(), static_cast<std::size_t>(m.size()) * 8); };
  const std::vector<core::LandmarkId> ids = filter.landmarks();
  const core::JointGaussian joint = filter.joint(ids);
  add(ids.data(), ids.size() * sizeof(core::LandmarkId));
  add(filter.active_landmarks().data(), filter.active_landmarks().size() * sizeof(core::LandmarkId));
  add_matrix(joint.pose.vector());
  for (const Eigen::Vector2d& p : joint.points_m) add_matrix(p);
  if (passive == Passive::with_covariances) add_matrix(joint.covariance);
  const ActivePart active = filter.snapshot().active;
  add_matrix(active.P.view());
  add_matrix(active.A.view());
  add_matrix(Eigen::MatrixXd(active.M.view().triangularView<Eigen::Lower>()));
  add_matrix(active.theta);
  add(active.late_anchors.data(), active.late_anchors.size() * sizeof(int));
  add(active.left_passive.data(), active.left_passive.size() * sizeof(core::LandmarkId));
  add(&active.next_id, sizeof active.next_id);
  return bytes;
}

}  // namespace helixnav::cekf
