// SPDX-License-Identifier: BSD-3-Clause
#include "live_navigator.hpp"

#include "common/fit_to_recording.hpp"
#include "common/joint_map_of.hpp"
#include "helixnav/logs/field_of_view.hpp"

namespace helixnav::apps {

void LiveNavigator::prepare(core::Recording& next) {
  apply_log_settings(next, settings_);
  labels_ = &next.labels;
  scan_ = 0;
  if (!navigator_ && !next.events.empty()) begin(next);
}

void LiveNavigator::begin_with(core::Recording& before) {
  labels_ = &before.labels;
  scan_ = 0;
  begin(before);
}

void LiveNavigator::begin(const core::Recording& next) {
  const supervisor::NavigatorOptions options = fit_to_recording(settings_, next);
  const core::FieldOfView view = logs::field_of_view_of(next);
  lengths_text_ = apps::lengths_text(options, view);
  reach_m_ = view.reach().value_or(0.0);
  if (settings_.known_association) {
    navigator_.emplace(std::in_place_type<supervisor::NamedNavigator>, next.start, options);
  } else {
    navigator_.emplace(std::in_place_type<supervisor::Navigator>, next.start, options);
  }
}

std::optional<core::StepReport> LiveNavigator::take(const core::Event& event) {
  const auto* seen = std::get_if<core::Scan>(&event);
  const bool is_scan = seen != nullptr;
  if (is_scan) drive_.add(*seen);
  const std::size_t scan = is_scan ? scan_++ : 0;
  if (auto* unnamed = std::get_if<supervisor::Navigator>(&*navigator_)) return unnamed->take(event);
  auto& named = std::get<supervisor::NamedNavigator>(*navigator_);
  return is_scan ? named.take(event, labels_->at(scan)) : named.take(event, {});
}

std::vector<core::MapLandmark> LiveNavigator::map() const {
  if (!navigator_) return {};
  return std::visit([](const auto& navigator) { return navigator.map(); }, *navigator_);
}

std::map<int, core::JointMap> LiveNavigator::maps_apart() const {
  const auto* unnamed = navigator_ ? std::get_if<supervisor::Navigator>(&*navigator_) : nullptr;
  return unnamed != nullptr ? unnamed->maps_apart() : std::map<int, core::JointMap>();
}

std::optional<core::JointMap> LiveNavigator::joint_map() const {
  if (!navigator_) return std::nullopt;
  std::optional<core::JointMap> map =
      std::visit([this](const auto& navigator) { return joint_map_of(navigator, reach_m_); }, *navigator_);
  if (const std::string drive = drive_.text(); map && !drive.empty()) map->drives = {drive};
  return map;
}

}  // namespace helixnav::apps
