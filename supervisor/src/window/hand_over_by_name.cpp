// SPDX-License-Identifier: BSD-3-Clause
// The filter of a large map of landmarks known by name begins anew where the vehicle is, from the atlas of the drive.
#include <algorithm>
#include <utility>
#include <vector>

#include "association/association_report.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/se2.hpp"
#include "helixnav/supervisor/named_navigator.hpp"
#include "named/named_drive.hpp"
#include "window/window.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;

/// With names nothing is looked for far away, and a region switch costs the square of what the filter holds: on a road of 4000
/// landmarks 99 % of the steps take less than 3.6 ms with 400, less than 0.9 ms with 150 (bench named_scaling).
int landmarks_wanted(const MapOptions& map) {
  constexpr int enough = 150;
  return std::min(map.window, enough);
}

/// Everything within three times the sensor's reach of the last clone, more while there are few.
std::vector<LandmarkId> landmarks_about(const atlas::Atlas& atlas, double reach_m, int mapped, const MapOptions& map) {
  const WindowNeeds needs{3.0 * reach_m, landmarks_wanted(map), map.most};
  const auto wanted = static_cast<std::size_t>(std::min(needs.landmarks, mapped));
  const Eigen::Vector2d center_m = atlas.pose().position_m();
  double radius_m = needs.least_radius_m;
  std::vector<atlas::Place> places = atlas.near(center_m, radius_m);
  while (places.size() < wanted) {
    radius_m *= 1.5;
    places = atlas.near(center_m, radius_m);
  }
  return choose_window(places, center_m, needs).ids;
}

/// Active landmarks in the frame of a pose that is behind the filter's own by `T_entry_robot`.
template <class NameInMap>
atlas::PointPrior active_from(const cekf::CompressedEkf& filter, const core::Pose2& T_entry_robot,
                              const NameInMap& name_in_map) {
  const core::Pose2 T_entry_world = core::compose(T_entry_robot, core::inverse(filter.pose().mean));
  atlas::PointPrior known;
  for (const LandmarkId name : filter.active_landmarks()) {
    known.ids.push_back(name_in_map(name));
    known.points_m.push_back(core::transform(T_entry_world, filter.landmark_mean(name)));
  }
  return known;
}

std::vector<cekf::Match> used(const core::Scan& scan, const std::vector<core::AssociationReport>& associations) {
  std::vector<cekf::Match> seen = matches(scan, associations);
  for (const core::AssociationReport& one : associations) {
    if (one.outcome != core::Outcome::augmented) continue;
    seen.push_back({one.landmark, scan.observations[static_cast<std::size_t>(one.observation)], scan.T_robot_sensor});
  }
  return seen;
}

bool has_one_row(const core::Observation& observation) { return core::dimension(observation.kind) == 1; }

}  // namespace

LandmarkId NamedNavigator::FilterNames::in_filter(LandmarkId id) const {
  if (!is_part) return id;
  if (id >= next) return id - next + static_cast<LandmarkId>(first.size());
  const auto found = std::lower_bound(first.begin(), first.end(), id);
  if (found == first.end() || *found != id) return core::no_landmark;
  return static_cast<LandmarkId>(found - first.begin());
}

LandmarkId NamedNavigator::FilterNames::in_map(LandmarkId name) const {
  if (!is_part) return name;
  const auto began_with = static_cast<LandmarkId>(first.size());
  return name < began_with ? first[static_cast<std::size_t>(name)] : name - began_with + next;
}

/// Known landmarks that the filter does not hold: it begins anew with everything that the scan sees. If it cannot, they
/// are left out of this scan.
void NamedNavigator::bring_into_filter(std::vector<core::AssociationReport>& associations) {
  if (!names_.is_part) return;
  const auto is_missing = [&](const core::AssociationReport& one) {
    return one.outcome == core::Outcome::matched && names_.in_filter(one.landmark) == core::no_landmark;
  };
  if (std::none_of(associations.begin(), associations.end(), is_missing)) return;
  if (!recovering_ && hand_over(landmarks_with(core::Outcome::matched, associations))) return;
  for (core::AssociationReport& one : associations) {
    if (!is_missing(one)) continue;
    one.outcome = core::Outcome::ambiguous;
    one.landmark = core::no_landmark;
  }
}

/// No phase determines points that the filter finds from several looks at a range or a bearing: if there are any, one
/// filter holds the whole map.
void NamedNavigator::record(const core::Scan& scan, const core::StepReport& report) {
  if (recovering_ || !drive_->is_kept()) return;
  if (!names_.is_part && std::any_of(scan.observations.begin(), scan.observations.end(), has_one_row)) {
    drive_->drop();
    return;
  }
  Stop stop;
  stop.t_ns = scan.t_ns;
  stop.seen = used(scan, report.associations);
  drive_->stop(std::move(stop));
}

void NamedNavigator::record(const core::AbsoluteFix& fix) {
  if (recovering_ || !drive_->is_kept()) return;
  Stop stop;
  stop.t_ns = fix.t_ns;
  stop.fix = fix;
  drive_->stop(std::move(stop));
}

/// At most one phase per scan goes into the atlas, once half of what one filter may hold is mapped.
void NamedNavigator::go_on_with_drive() {
  const auto mapped = static_cast<int>(observations_.size());
  if (recovering_ || !drive_->is_kept() || 2 * mapped <= options_.map.whole) return;
  const double length_m = phase_length_m(reach_m_);
  if (drive_->has_phase(length_m)) {
    const atlas::PointPrior known =
        active_from(filter_, drive_->T_entry_exit(length_m), [this](LandmarkId name) { return names_.in_map(name); });
    drive_->close_phase(length_m, names_.is_part ? &known : nullptr);
  }
  const int held = filter_.mapped_count();
  const bool is_too_large = names_.is_part ? 2 * held > 3 * std::max(landmarks_wanted(options_.map), begun_with_)
                                           : mapped > options_.map.whole && 2 * held > 3 * begun_with_;
  if (is_too_large && !hand_over({})) begun_with_ = held;
}

bool NamedNavigator::hand_over(const std::vector<LandmarkId>& wanted) {
  if (step_ < next_try_) return false;
  try {
    begin_window(wanted);
    return true;
  } catch (const core::NumericalError&) {  // what cannot be solved leaves the filter as it is
    constexpr std::int64_t pause = 50;     // a solution that is not found costs more than one that is
    next_try_ = step_ + pause;
    ++pending_.numerics.refused;
    pending_.decisions.emplace_back(core::PostponedDecision{core::PostponedDecision::Work::window,
                                                            static_cast<double>(filter_.mapped_count()),
                                                            static_cast<double>(landmarks_wanted(options_.map))});
    return false;
  }
}

/// The filter becomes the joint estimate of the pose and of the landmarks near it and wanted.
void NamedNavigator::begin_window(const std::vector<LandmarkId>& wanted) {
  const double length_m = phase_length_m(reach_m_);
  const auto mapped = static_cast<int>(observations_.size());
  const auto next = static_cast<LandmarkId>(mapped);  // none is ever removed
  OwnDrive drive(drive_);
  const atlas::PointPrior known =
      active_from(filter_, drive->T_entry_exit(length_m), [this](LandmarkId name) { return names_.in_map(name); });
  drive->settle(length_m, names_.is_part ? &known : nullptr);
  FilterNames names{landmarks_about(drive->atlas(), reach_m_, mapped, options_.map), next, true};
  names.first.insert(names.first.end(), wanted.begin(), wanted.end());
  std::sort(names.first.begin(), names.first.end());
  names.first.erase(std::unique(names.first.begin(), names.first.end()), names.first.end());
  core::JointGaussian joint = drive->atlas().joint(names.first);
  const auto count = static_cast<int>(names.first.size());
  for (int name = 0; name < count; ++name) joint.ids[static_cast<std::size_t>(name)] = name;
  cekf::CompressedEkf filter(joint, count, filter_.options());
  remember_covariances();
  pending_.numerics.note(filter_.take_health());
  if (before_) {  // a second one in this call: what was before the call stays what was before the first
    std::swap(filter, filter_);
    std::swap(drive, drive_);
  } else {
    before_.emplace(BeforeHandOver{std::move(filter), names_, std::move(drive), begun_with_});
    std::swap(before_->filter, filter_);
    std::swap(before_->drive, drive_);
  }
  names_ = std::move(names);
  begun_with_ = count;
}

void NamedNavigator::take_back_hand_over() noexcept {
  if (!before_) return;
  std::swap(filter_, before_->filter);
  std::swap(drive_, before_->drive);
  std::swap(names_, before_->names);
  begun_with_ = before_->begun_with;
  before_.reset();
}

/// For sketches: of landmarks that the filter may leave out now.
void NamedNavigator::remember_covariances() {
  remembered_m2_.resize(observations_.size(), Eigen::Matrix2d::Zero());
  for (const LandmarkId name : filter_.landmarks()) {
    remembered_m2_[static_cast<std::size_t>(names_.in_map(name))] = filter_.landmark(name).covariance_m2;
  }
}

NamedNavigator::OwnDrive::OwnDrive(NamedDrive drive) : drive_(std::make_unique<NamedDrive>(std::move(drive))) {}
NamedNavigator::OwnDrive::OwnDrive(const OwnDrive& other) : drive_(std::make_unique<NamedDrive>(*other.drive_)) {}
NamedNavigator::OwnDrive::OwnDrive(OwnDrive&& other) noexcept = default;
NamedNavigator::OwnDrive& NamedNavigator::OwnDrive::operator=(OwnDrive other) noexcept {
  std::swap(drive_, other.drive_);
  return *this;
}
NamedNavigator::OwnDrive::~OwnDrive() = default;

}  // namespace helixnav::supervisor
