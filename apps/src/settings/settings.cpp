// SPDX-License-Identifier: BSD-3-Clause
#include "settings.hpp"

#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "setting_options.hpp"
#include "validators.hpp"

namespace helixnav::apps {
namespace {

void choose_method(const std::string& chosen, Settings& settings) {
  settings.known_association = chosen == "known";
  settings.unknown_association = chosen == "unknown";
  for (const association::Method method : association_methods()) {
    if (association::name(method) == chosen) settings.navigator.method = method;
  }
}

void add_filter(CLI::App& command, Settings& settings) {
  command
      .add_option_function<std::string>(
          "--filter.method,--filter",
          [&settings](const std::string& word) { settings.fastslam.chosen = word == "fastslam"; },
          "Filter that navigates; fastslam: particles, each with its own map (replay and simulate; docs/fastslam.md)")
      ->check(one_of({"compressed-ekf", "fastslam"}))
      ->default_str("compressed-ekf")
      ->group(settings_group);
  cekf::FilterOptions& filter = settings.navigator.filter;
  const auto set_retraction = [&filter](const std::string& word) {
    filter.retraction = word == "standard" ? cekf::Retraction::standard : cekf::Retraction::right_invariant;
  };
  command.add_option_function<std::string>("--filter.retraction", set_retraction, "How a correction is applied")
      ->check(one_of({"right-invariant", "standard"}))
      ->default_str("right-invariant")
      ->group(settings_group);
  add_length(
      command, settings, "filter.cell_side_m", 1e-3, 1e6,
      "Side of a cell; the cell of the vehicle and its 8 neighbours are active; auto: 2/3 of the sensor's reach");
  add_length(command, settings, "filter.hysteresis_m", 0.0, 1e6,
             "How far beyond its cell the vehicle drives before the region switches; auto: 2/3 of the reach");
  add_number(command, "--filter.max_active_landmarks", filter.max_active_landmarks, 1, 100000,
             "A region switch is due beyond this number of active landmarks (three times it where all are active)");
  supervisor::MapOptions& map = settings.navigator.map;
  add_number(command, "--map.whole", map.whole, 0, 1'000'000,
             "The filter holds the whole map up to this many landmarks; without names, up to 20 times what a scan sees "
             "if that is more");
  add_number(command, "--map.window", map.window, 50, 1'000'000,
             "How many landmarks around the vehicle the filter of a larger map holds");
  add_number(command, "--map.most_in_filter", map.most, 50, 1'000'000,
             "Most landmarks that it holds if the vehicle may have drifted farther than that");
  add_number(command, "--map.memory_mb", settings.memory_mb, 0.0, 1e9,
             "When the process has used this much memory, replay and simulate end the drive and write map and report; "
             "0: no limit");
}

void add_association(CLI::App& command, Settings& settings) {
  std::vector<std::string> names{"known"};
  for (const association::Method method : association_methods()) names.emplace_back(association::name(method));
  if (command.get_name() == "replay" || command.get_name() == "simulate") names.emplace_back("unknown");
  command
      .add_option_function<std::string>(
          "--association.method,--association", [&settings](const std::string& word) { choose_method(word, settings); },
          "Which observation belongs to which landmark; known: by the log's labels. For a log of several robots: known "
          "or unknown")
      ->check(one_of(names))
      ->default_str(std::string(association::name(settings.navigator.method)))
      ->group(settings_group);
  supervisor::NavigatorOptions& navigator = settings.navigator;
  add_number(command, "--association.detection_probability", navigator.association.detection_probability, 0.01, 0.999,
             "P_D that a landmark in view is seen in one scan");
  add_automatic(command, "--names.wrong", settings.names_wrong, 0.0, 0.5,
                "With --association known: share of sightings that carry the name of another landmark; 0: none; auto: "
                "0.001, or 0 if names are part of the problem (graphs, DLR)");
  add_number(command, "--association.extraneous_per_scan", navigator.extraneous_per_scan, 0.01, 100.0,
             "Expected number of observations in a scan that are of no mapped landmark: clutter and new landmarks");
  add_number(command, "--association.match_probability", navigator.gates.match_probability, 0.5, 0.999999,
             "Gate within which an observation may be matched, as the probability that a correct pair is inside");
  add_number(command, "--association.new_probability", navigator.gates.new_probability, 0.5, 0.99999999,
             "An observation outside this gate of every landmark starts a new one");
  add_number(command, "--association.joint_probability", navigator.association.joint_probability, 0.5, 0.999999,
             "Gate of the joint NIS of all pairs of a scan");
  add_number(command, "--association.min_margin_nats", navigator.association.min_margin_nats, 0.0, 100.0,
             "A match whose best alternative is closer than this in log-likelihood is ambiguous and not used");
}

void add_landmarks(CLI::App& command, Settings& settings) {
  association::LifeOptions& life = settings.navigator.life;
  add_number(command, "--landmarks.mature_looks", life.mature_looks, 1, 1000,
             "Sightings from different places that make a landmark mature");
  add_length(command, settings, "landmarks.tentative_patience_m", 1e-3, 1e6,
             "A tentative landmark that stays unseen over this distance is deleted; auto: the sensor's reach");
  add_number(command, "--landmarks.detection_probability", life.detection_probability, 0.01, 0.999,
             "Probability that an expected landmark is seen in one look, occlusion included");
}

}  // namespace

bool goes_by_identities(const Settings& settings) {
  const FastSlamSettings& fastslam = settings.fastslam;
  return fastslam.chosen ? fastslam.options.association == fastslam::Association::known : settings.known_association;
}

std::vector<association::Method> association_methods() {
  using association::Method;
  return {Method::nearest_neighbour,
          Method::nearest_neighbour_unique,
          Method::likelihood_ratio,
          Method::joint_likelihood_ratio,
          Method::jcbb,
          Method::ihgr_published,
          Method::ihgr_likelihood_ratio};
}

void add_settings(CLI::App& command, Settings& settings) {
  add_sensor_settings(command, settings);
  add_filter(command, settings);
  add_association(command, settings);
  add_landmarks(command, settings);
  add_search_settings(command, settings);
  add_slip_settings(command, settings);
  add_fastslam_settings(command, settings.fastslam);
  add_log_settings(command, settings);
}

}  // namespace helixnav::apps
