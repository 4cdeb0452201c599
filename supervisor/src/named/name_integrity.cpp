// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/name_integrity.hpp"

#include <algorithm>

#include <Eigen/LU>

#include "helixnav/core/chi2.hpp"

namespace helixnav::supervisor {
namespace {

/// Up if a value is above the estimate, down if it is below: equally often when the estimate is the median.
constexpr double median_step = 1.1;

/// The errors of the two are taken as independent: those of the pose, which they share, make the limit wider than need be.
bool are_one_place(const core::PointGaussian& one, const core::PointGaussian& other, double noise_scale) {
  constexpr double probability = 0.999;
  const Eigen::Vector2d apart_m = other.mean_m - one.mean_m;
  const Eigen::Matrix2d S = noise_scale * (one.covariance_m2 + other.covariance_m2);
  return apart_m.dot(S.inverse() * apart_m) <= core::chi2_quantile(probability, 2);
}

}  // namespace

void NameIntegrity::agree(const std::vector<core::LandmarkId>& agreeing) {
  for (const core::LandmarkId id : agreeing) elsewhere_.erase(id);
  if (contradicting_.empty()) return;
  agreeing_.insert(agreeing.begin(), agreeing.end());
  if (agreeing_.size() > contradicting_.size()) confirm_motion();
}

void NameIntegrity::confirm_motion() {
  scans_ = 0;
  contradicting_.clear();
  agreeing_.clear();
}

bool NameIntegrity::blames_names(const std::vector<ContradictedName>& contradicting,
                                 const std::vector<core::LandmarkId>& agreeing, const AboutMotion& about_motion) {
  std::set<core::LandmarkId> now;
  for (const ContradictedName& name : contradicting) now.insert(name.landmark);
  ++scans_;
  contradicting_.insert(now.begin(), now.end());
  agreeing_.insert(agreeing.begin(), agreeing.end());
  const bool outnumber = contradicting_.size() > agreeing_.size();
  const bool is_again = scans_ >= 2 && contradicting_.size() >= agreeing_.size();
  const bool is_slip = about_motion.nats_for_slip > 0.0 && (now.size() >= 2 || is_again);
  const bool is_other = about_motion.agree_about_a_pose && outnumber && (now.size() >= 2 || contradicting_.size() >= 6);
  if (is_slip || is_other) {
    confirm_motion();
    return false;
  }
  agree(agreeing);
  for (const ContradictedName& name : contradicting) note_elsewhere(name);
  return true;
}

void NameIntegrity::note_elsewhere(const ContradictedName& name) {
  if (!name.seen_at && !name.is_in_view) return;
  Elsewhere& elsewhere = elsewhere_[name.landmark];
  if (!name.seen_at || !elsewhere.at || are_one_place(*elsewhere.at, *name.seen_at, noise_scale_)) {
    ++elsewhere.sightings;
  } else {
    --elsewhere.sightings;
  }
  if (elsewhere.sightings <= 1) elsewhere = {1, name.seen_at};
}

void NameIntegrity::note_nis(double nis, int dof) {
  if (nis > noise_scale_ * dof) return note_unusual();
  noise_scale_ = std::max(1.0, noise_scale_ / median_step);
}

void NameIntegrity::note_unusual() { noise_scale_ *= median_step; }

bool NameIntegrity::is_misplaced(core::LandmarkId id) const {
  constexpr int sightings = 5;
  const auto found = elsewhere_.find(id);
  return found != elsewhere_.end() && found->second.sightings >= sightings;
}

void NameIntegrity::begin_anew(std::int64_t identity, core::LandmarkId from) {
  begun_anew_.push_back({identity, from});
  superseded_.insert(from);
  elsewhere_.erase(from);
}

}  // namespace helixnav::supervisor
