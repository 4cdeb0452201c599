// SPDX-License-Identifier: BSD-3-Clause
#include "fit_to_recording.hpp"

#include <sstream>
#include <variant>

#include "helixnav/logs/field_of_view.hpp"
#include "helixnav/supervisor/lengths.hpp"

namespace helixnav::apps {
namespace {

double in_degrees(double angle_rad) { return angle_rad * 180.0 / core::pi; }

std::string view_text(const core::FieldOfView& view) {
  std::ostringstream text;
  text.precision(6);
  text << "\n# Field of view: " << view.min_range_m << " to " << view.max_range_m << " m, "
       << in_degrees(view.min_bearing_rad) << " to " << in_degrees(view.max_bearing_rad) << " deg; reach ";
  if (view.reach()) {
    text << *view.reach() << " m";
  } else {
    text << "unknown";
  }
  return text.str();
}

}  // namespace

void scale_covariances(core::Recording& recording, double of_odometry, double of_observations) {
  for (core::Event& event : recording.events) {
    if (auto* odometry = std::get_if<core::Odometry>(&event)) odometry->covariance *= of_odometry;
    if (auto* scan = std::get_if<core::Scan>(&event)) {
      for (core::Observation& observation : scan->observations) observation.R *= of_observations;
    }
  }
}

void apply_log_settings(core::Recording& recording, const Settings& settings) {
  logs::set_field_of_view(recording, settings.field_of_view);
  scale_covariances(recording, settings.covariance_scale, settings.covariance_scale);
}

supervisor::NavigatorOptions fit_to_sensor(const Settings& settings, const core::FieldOfView& view) {
  supervisor::NavigatorOptions options = supervisor::fit_lengths(settings.navigator, view);
  for (const auto& [name, length_m] : settings.given_lengths_m) supervisor::set_length(options, name, length_m);
  options.fit_lengths = false;
  if (settings.names_wrong) options.names.wrong = *settings.names_wrong;
  return options;
}

supervisor::NavigatorOptions fit_to_recording(const Settings& settings, const core::Recording& recording) {
  supervisor::NavigatorOptions options = fit_to_sensor(settings, logs::field_of_view_of(recording));
  if (recording.extraneous_per_scan && *recording.extraneous_per_scan > 0.0) {
    options.search.extraneous_per_scan = *recording.extraneous_per_scan;
  } else if (recording.extraneous_per_scan) {
    options.search.learn_extraneous = true;
  }
  if (recording.labels_are_given && !settings.names_wrong) options.names.wrong = 0.0;
  return options;
}

std::string lengths_text(const supervisor::NavigatorOptions& options, const core::FieldOfView& view) {
  std::ostringstream text;
  text.precision(6);
  text << view_text(view);
  if (!view.reach()) text << ", taken for " << supervisor::reference_reach_m << " m";
  text << "\n# Lengths in force, by the reach unless given:\n";
  for (const supervisor::LengthInForce& length : supervisor::lengths_in_force(options)) {
    text << "# " << length.name << " = " << length.value << '\n';
  }
  text << "# search.extraneous_per_scan = ";
  if (options.search.learn_extraneous) {
    text << "learnt: landmarks begun in a scan\n";
  } else {
    text << options.search.extraneous_per_scan << '\n';
  }
  return text.str();
}

std::string in_force_text(const Settings& settings, const supervisor::NavigatorOptions& options,
                          const core::Recording& recording) {
  const core::FieldOfView view = logs::field_of_view_of(recording);
  return settings.fastslam.chosen ? view_text(view) + '\n' : lengths_text(options, view);
}

}  // namespace helixnav::apps
