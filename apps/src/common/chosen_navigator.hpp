// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <variant>
#include <vector>

#include "helixnav/core/recording.hpp"
#include "helixnav/supervisor/named_navigator.hpp"
#include "helixnav/supervisor/navigator.hpp"

namespace helixnav::apps {

/// The navigator of a recording, as core::EventLoop wants it: by its labels when association is known, else without. The
/// recording must outlive it.
class ChosenNavigator {
 public:
  ChosenNavigator(const core::Recording& recording, const supervisor::NavigatorOptions& options, bool known_association)
      : recording_(&recording), navigator_(chosen(recording, options, known_association)) {}

  /// The recording's events in order. The report of a scan.
  std::optional<core::StepReport> take(const core::Event& event) {
    if (auto* unnamed = std::get_if<supervisor::Navigator>(&navigator_)) return unnamed->take(event);
    auto& named = std::get<supervisor::NamedNavigator>(navigator_);
    if (std::holds_alternative<core::Scan>(event)) return named.take(event, recording_->labels.at(scans_++));
    return named.take(event, {});
  }

  core::PoseGaussian pose() const {
    return std::visit([](const auto& navigator) { return navigator.pose(); }, navigator_);
  }
  std::vector<core::MapLandmark> map() const {
    return std::visit([](const auto& navigator) { return navigator.map(); }, navigator_);
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

  const core::Recording* recording_;
  std::size_t scans_ = 0;
  Either navigator_;
};

}  // namespace helixnav::apps
