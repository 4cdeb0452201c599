// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <exception>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/event_loop.hpp"
#include "helixnav/core/joint_map.hpp"
#include "helixnav/core/recording.hpp"
#include "helixnav/logs/own_stream.hpp"
#include "helixnav/runs/drive_digest.hpp"
#include "helixnav/supervisor/named_navigator.hpp"
#include "helixnav/supervisor/navigator.hpp"
#include "settings/settings.hpp"

namespace helixnav::apps {

/// The navigator of an ongoing drive, as core::EventLoop expects it: the same result as replay of the same events. It
/// begins with the first events, whose sensor determines its lengths.
class LiveNavigator {
 public:
  explicit LiveNavigator(const Settings& settings) : settings_(settings) {}

  /// The next events, with their labels; sensor and covariance settings are applied to them.
  void prepare(core::Recording& next);

  /// An earlier drive, as it was fed: its events come next, unchanged.
  void begin_with(core::Recording& before);

  /// Events of the last recording prepared, in order. Returns the report of a scan.
  std::optional<core::StepReport> take(const core::Event& event);

  bool has_begun() const { return navigator_.has_value(); }
  std::vector<core::MapLandmark> map() const;
  /// What the drive leaves to the next session; nothing before it has begun, or if the map is too large.
  std::optional<core::JointMap> joint_map() const;
  /// [part] of the drive before the vehicle was carried.
  std::map<int, core::JointMap> maps_apart() const;
  /// Lengths in force, for the manifest.
  const std::string& lengths_text() const { return lengths_text_; }

 private:
  void begin(const core::Recording& next);

  using Either = std::variant<supervisor::Navigator, supervisor::NamedNavigator>;

  const Settings& settings_;
  std::optional<Either> navigator_;
  std::string lengths_text_;
  double reach_m_ = 0.0;  ///< 0: unknown
  runs::DriveDigest drive_;
  const std::vector<std::vector<core::Label>>* labels_ = nullptr;
  std::size_t scan_ = 0;
};

/// Feeds the estimator with the new events, numbering steps on from `steps`. on_step(report, line) for each scan;
/// on_refused(line, error, is_numerical) for one that is left out: the estimator is in its state before that scan.
/// Test: apps/stream_test.cpp, python/test_same_result.py.
template <class Estimator, class OnStep, class OnRefused>
void feed_live(const logs::StreamedEvents& next, Estimator& estimator, std::int64_t& steps, const OnStep& on_step,
               const OnRefused& on_refused) {
  const std::vector<core::Event>& events = next.recording.events;
  core::EventLoop loop(events, estimator, steps);
  std::size_t scan = 0;
  for (std::size_t fed = 0; fed < events.size(); fed = loop.fed()) {
    std::optional<core::StepReport> step;
    try {
      step = loop.next();
    } catch (const core::NumericalError& error) {
      on_refused(next.lines[scan], error, true);
    } catch (const core::PreconditionError& error) {
      on_refused(next.lines[scan], error, false);
    }
    if (step) on_step(*std::move(step), next.lines[scan]);
    if (std::holds_alternative<core::Scan>(events[loop.fed() - 1])) ++scan;
    steps = loop.steps();
  }
}

}  // namespace helixnav::apps
