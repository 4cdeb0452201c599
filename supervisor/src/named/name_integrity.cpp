// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/supervisor/name_integrity.hpp"

#include <algorithm>

namespace helixnav::supervisor {
namespace {

/// Up if a value is above the estimate, down if it is below: equally often when the estimate is the median.
constexpr double median_step = 1.1;

}  // namespace

void NameIntegrity::agree(const std::vector<core::LandmarkId>& agreeing) {
  for (const core::LandmarkId id : agreeing) in_a_row_.erase(id);
  if (contradicting_.empty()) return;
  agreeing_.insert(agreeing.begin(), agreeing.end());
  if (agreeing_.size() > contradicting_.size()) confirm_motion();
}

void NameIntegrity::confirm_motion() {
  scans_ = 0;
  contradicting_.clear();
  agreeing_.clear();
}

bool NameIntegrity::blames_names(const std::vector<core::LandmarkId>& contradicting,
                                 const std::vector<core::LandmarkId>& agreeing, const AboutMotion& about_motion) {
  const std::set<core::LandmarkId> now(contradicting.begin(), contradicting.end());
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
  for (const core::LandmarkId id : contradicting) ++in_a_row_[id];
  return true;
}

void NameIntegrity::note_nis(double nis, int dof) {
  if (nis > noise_scale_ * dof) return note_unusual();
  noise_scale_ = std::max(1.0, noise_scale_ / median_step);
}

void NameIntegrity::note_unusual() { noise_scale_ *= median_step; }

bool NameIntegrity::is_misplaced(core::LandmarkId id) const {
  constexpr int sightings = 5;
  const auto found = in_a_row_.find(id);
  return found != in_a_row_.end() && found->second >= sightings;
}

void NameIntegrity::begin_anew(std::int64_t identity, core::LandmarkId from) {
  begun_anew_.push_back({identity, from});
  superseded_.insert(from);
  in_a_row_.erase(from);
}

}  // namespace helixnav::supervisor
