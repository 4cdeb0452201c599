// SPDX-License-Identifier: BSD-3-Clause
#include "association/expected_landmarks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "association/association_report.hpp"
#include "association/candidates.hpp"

namespace helixnav::supervisor {

using core::LandmarkId;
using core::Outcome;

namespace {

/// Where on the drive the second most recently seen of the old landmarks was last seen; those in `seen` are seen now.
double second_last_old_m(const association::LandmarkLife& existence, double old_before_m,
                         const std::vector<LandmarkId>& seen) {
  double last_m = -std::numeric_limits<double>::infinity();
  double second_m = last_m;
  for (const association::LandmarkRecord& record : existence.records()) {
    if (record.born_path_m >= old_before_m) continue;
    const bool is_seen = std::find(seen.begin(), seen.end(), record.id) != seen.end();
    const double at_m = is_seen ? existence.path_m() : record.last_seen_path_m;
    second_m = std::max(second_m, std::min(last_m, at_m));
    last_m = std::max(last_m, at_m);
  }
  return second_m;
}

/// Standard deviation of the landmark's position relative to the vehicle (root of the trace).
double relative_sigma_m(const cekf::CompressedEkf& filter, LandmarkId id) {
  const core::PoseGaussian pose = filter.pose();
  const core::PointGaussian landmark = filter.landmark(id);
  const Eigen::Vector2d arm_m = landmark.mean_m - pose.mean.position_m();
  Eigen::Matrix<double, 2, 3> J;
  J << 1.0, 0.0, -arm_m.y(), 0.0, 1.0, arm_m.x();
  const Eigen::Matrix2d cross = filter.covariance_with_pose(id) * J.transpose();
  const Eigen::Matrix2d relative =
      landmark.covariance_m2 + J * pose.covariance * J.transpose() - cross - cross.transpose();
  return std::sqrt(std::max(0.0, relative.trace()));
}

}  // namespace

std::vector<LandmarkId> expected_unseen(const cekf::CompressedEkf& filter, const core::Scan& scan, double margin_m,
                                        const std::vector<core::AssociationReport>& associations) {
  std::vector<LandmarkId> expected = expected_in_view(filter, scan, margin_m);
  for (const Outcome no_miss : {Outcome::ambiguous, Outcome::rejected, Outcome::augmented}) {
    for (const LandmarkId id : landmarks_with(no_miss, associations)) {
      expected.erase(std::remove(expected.begin(), expected.end(), id), expected.end());
    }
  }
  return expected;
}

std::vector<LandmarkId> unseen_at_rim(const cekf::CompressedEkf& filter, const core::Scan& scan,
                                      const std::vector<core::AssociationReport>& associations,
                                      const std::vector<LandmarkId>& expected) {
  std::vector<LandmarkId> unseen = expected_unseen(filter, scan, 0.0, associations);
  const std::vector<LandmarkId> seen = landmarks_with(Outcome::matched, associations);
  for (const std::vector<LandmarkId>* others : {&expected, &seen}) {
    for (const LandmarkId id : *others) unseen.erase(std::remove(unseen.begin(), unseen.end(), id), unseen.end());
  }
  return unseen;
}

void drop_what_may_be_elsewhere(const cekf::CompressedEkf& filter, const association::LandmarkLife& existence,
                                const Search* open, const OldGround& ground, const std::vector<LandmarkId>& seen,
                                std::vector<LandmarkId>& expected) {
  const double old_before_m = existence.path_m() - ground.old_after_m;
  const double second_m = second_last_old_m(existence, old_before_m, seen);
  const auto recognised = std::count_if(seen.begin(), seen.end(),
                                        [&](LandmarkId id) { return existence.record(id).born_path_m < old_before_m; });
  constexpr int enough = 2;
  const bool still_there = std::any_of(seen.begin(), seen.end(), [&](LandmarkId id) {
    return existence.state(id) == core::LandmarkState::mature && existence.record(id).born_path_m <= second_m;
  });
  const bool is_known = still_there && second_m >= existence.path_m() - ground.lately_m;
  const double known_m = ground.margin_m / 3.0;  // three standard deviations within the margin
  const auto may_be_elsewhere = [&](LandmarkId id) {
    if (open != nullptr && open->excludes(id)) return true;
    if (recognised >= enough || existence.record(id).last_seen_path_m >= old_before_m) return false;
    return !is_known || relative_sigma_m(filter, id) > known_m;
  };
  expected.erase(std::remove_if(expected.begin(), expected.end(), may_be_elsewhere), expected.end());
}

}  // namespace helixnav::supervisor
