// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "helixnav/core/recording.hpp"
#include "helixnav/supervisor/named_navigator.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace helixnav::apps {

/// The navigator of a recording, as core::EventLoop expects it: by its labels if association is known, else without. The
/// labels must outlive it.
class ChosenNavigator {
 public:
  using Labels = std::vector<std::vector<core::Label>>;

  ChosenNavigator(const core::Recording& recording, const supervisor::NavigatorOptions& options, bool known_association)
      : ChosenNavigator(recording, options, known_association, recording.labels) {}
  /// With the labels of the scans that are fed, if these are not all of the recording's.
  ChosenNavigator(const core::Recording& recording, const supervisor::NavigatorOptions& options, bool known_association,
                  const Labels& labels)
      : labels_(&labels), navigator_(chosen(recording, options, known_association)) {}
  /// Begun elsewhere.
  template <class Begun>
  ChosenNavigator(Begun&& navigator, const Labels& labels)
      : labels_(&labels), navigator_(std::forward<Begun>(navigator)) {}

  /// Events in order. Returns the report of a scan.
  std::optional<core::StepReport> take(const core::Event& event) {
    if (auto* unnamed = std::get_if<supervisor::Navigator>(&navigator_)) return unnamed->take(event);
    auto& named = std::get<supervisor::NamedNavigator>(navigator_);
    if (std::holds_alternative<core::Scan>(event)) return named.take(event, labels_->at(scans_++));
    return named.take(event, {});
  }

  core::PoseGaussian pose() const {
    return std::visit([](const auto& navigator) { return navigator.pose(); }, navigator_);
  }
  std::vector<core::MapLandmark> map() const {
    return std::visit([](const auto& navigator) { return navigator.map(); }, navigator_);
  }
  std::vector<core::MapLandmark> sketch() const {
    return std::visit([](const auto& navigator) { return navigator.sketch(); }, navigator_);
  }
  core::JointGaussian joint(const std::vector<core::LandmarkId>& ids) const {
    return std::visit([&](const auto& navigator) { return navigator.joint(ids); }, navigator_);
  }
  std::optional<core::JointMap> factored_map(supervisor::FactoredMap how) const {
    return std::visit([how](const auto& navigator) { return navigator.factored_map(how); }, navigator_);
  }
  /// [part] of the drive before the vehicle was carried, or the earlier map.
  std::map<int, core::JointMap> maps_apart() const {
    const auto* unnamed = std::get_if<supervisor::Navigator>(&navigator_);
    return unnamed != nullptr ? unnamed->maps_apart() : std::map<int, core::JointMap>();
  }
  const cekf::CompressedEkf& filter() const {
    return std::visit([](const auto& navigator) -> const cekf::CompressedEkf& { return navigator.filter(); },
                      navigator_);
  }

 private:
  using Either = std::variant<supervisor::Navigator, supervisor::NamedNavigator>;

  static Either chosen(const core::Recording& recording, const supervisor::NavigatorOptions& options, bool known) {
    if (known) return Either(std::in_place_type<supervisor::NamedNavigator>, recording.start, options);
    return Either(std::in_place_type<supervisor::Navigator>, recording.start, options);
  }

  const Labels* labels_;
  std::size_t scans_ = 0;
  Either navigator_;
};

}  // namespace helixnav::apps
