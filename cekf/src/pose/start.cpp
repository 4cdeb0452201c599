// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

#include "helixnav/cekf/compressed_ekf.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::cekf {

// Code that swaps filters relies on it: half a move that throws would leave neither.
static_assert(std::is_nothrow_move_constructible_v<CompressedEkf> && std::is_nothrow_move_assignable_v<CompressedEkf>);

namespace {

void check_pose(const core::PoseGaussian& start) {
  if (start.mean.vector().allFinite() && core::is_symmetric_positive_semidefinite(start.covariance)) return;
  throw core::PreconditionError("CompressedEkf: the start must be finite with a positive semidefinite covariance");
}

void check_landmarks(const core::JointGaussian& start, core::LandmarkId next_name) {
  const auto n = static_cast<Eigen::Index>(start.ids.size());
  const Eigen::MatrixXd& P = start.covariance;
  if (start.points_m.size() != start.ids.size() || P.rows() != 3 + 2 * n || P.cols() != P.rows()) {
    throw core::PreconditionError("CompressedEkf: a joint start needs a point and two rows of covariance a landmark");
  }
  const auto is_finite = [](const Eigen::Vector2d& point_m) { return point_m.allFinite(); };
  const bool finite = std::all_of(start.points_m.begin(), start.points_m.end(), is_finite) && P.allFinite();
  if (!finite || P.diagonal().minCoeff() < 0.0) {
    throw core::PreconditionError("CompressedEkf: a joint start must be finite, with no variance below zero");
  }
  std::vector<core::LandmarkId> ids = start.ids;
  std::sort(ids.begin(), ids.end());
  const bool twice = std::adjacent_find(ids.begin(), ids.end()) != ids.end();
  if (twice || next_name < 0 || (n > 0 && (ids.front() < 0 || ids.back() >= next_name))) {
    throw core::PreconditionError(
        "CompressedEkf: landmarks of a joint start need different names from 0 on and below the next one");
  }
}

}  // namespace

CompressedEkf::CompressedEkf(const core::PoseGaussian& start, const FilterOptions& options)
    : options_(options), keep_since_(std::numeric_limits<long>::max()) {
  check_options();
  begin_at(start);
  Phase first;
  first.start_m = start.mean.position_m();
  first.start_heading_variance_rad2 = start.covariance(2, 2);
  open_phase(std::move(first), Eigen::MatrixXd(0, 3), {});
}

CompressedEkf::CompressedEkf(const core::JointGaussian& start, core::LandmarkId next_name, const FilterOptions& options)
    : options_(options), keep_since_(std::numeric_limits<long>::max()) {
  check_options();
  check_landmarks(start, next_name);
  begin_at({start.pose, start.covariance.topLeftCorner<3, 3>()});
  Phase first;
  first.start_m = start.pose.position_m();
  first.start_heading_variance_rad2 = start.covariance(2, 2);
  name_from(next_name);
  take_in_passive(start, first);
  open_phase(std::move(first), start.covariance.bottomLeftCorner(start.covariance.rows() - 3, 3), {});
  switch_region();
}

void CompressedEkf::check_options() const {
  if (options_.cell_side_m > 0.0 && options_.hysteresis_m >= 0.0 && options_.max_active_landmarks >= 1) return;
  throw core::PreconditionError(
      "CompressedEkf: options need cell_side_m > 0, hysteresis_m >= 0, max_active_landmarks >= 1");
}

void CompressedEkf::begin_at(const core::PoseGaussian& pose) {
  check_pose(pose);
  active_.pose = pose.mean;
  active_.P.resize(3, 3);
  active_.P.view() = 0.5 * (pose.covariance + pose.covariance.transpose());
  active_.A.resize(0, 3);
}

/// Every landmark gets a slot, in the order given.
void CompressedEkf::take_in_passive(const core::JointGaussian& start, Phase& first) {
  first.slots = static_cast<int>(start.ids.size());
  first.mean_m.resize(2 * first.slots);
  first.own_covariance_m2.resize(2 * first.slots, 2);
  for (int slot = 0; slot < first.slots; ++slot) {
    const core::LandmarkId id = start.ids[static_cast<std::size_t>(slot)];
    set_place(id, {Whereabouts::passive, slot});
    first.mean_m.segment<2>(2 * slot) = start.points_m[static_cast<std::size_t>(slot)];
    first.own_covariance_m2.middleRows<2>(2 * slot) = start.covariance.block<2, 2>(3 + 2 * slot, 3 + 2 * slot);
  }
  absorbed_->assign(start.covariance.bottomRightCorner(2 * first.slots, 2 * first.slots));
}

}  // namespace helixnav::cekf
