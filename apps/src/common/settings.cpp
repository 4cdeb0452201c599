// SPDX-License-Identifier: BSD-3-Clause
#include "settings.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "help_pages.hpp"
#include "validators.hpp"

namespace helixnav::apps {
namespace {

const char* const by_reach = "auto";
const char* const group = settings_group;

template <typename T>
CLI::Option* add_number(CLI::App& command, const char* name, T& value, T low, T high, const char* help) {
  return command.add_option(name, value, help)->capture_default_str()->check(number_between(low, high))->group(group);
}

/// "auto", or metres.
CLI::Validator length_between(double low, double high) {
  const CLI::Validator number = number_between(low, high);
  const auto objection = [number](std::string& word) { return word == by_reach ? std::string() : number(word); };
  return CLI::Validator(objection, number.get_description() + " or auto");
}

/// A length that is a multiple of the sensor's reach unless it is given.
CLI::Option* add_length(CLI::App& command, Settings& settings, const std::string& key, double low, double high,
                        const std::string& help) {
  const auto set = [&settings, key](const std::string& word) {
    settings.given_lengths_m.erase(key);
    if (word != by_reach) settings.given_lengths_m[key] = std::stod(word);
  };
  return command.add_option_function<std::string>("--" + key, set, help)
      ->check(length_between(low, high))
      ->default_str(by_reach)
      ->group(group);
}

void choose_method(const std::string& chosen, Settings& settings) {
  settings.known_association = chosen == "known";
  for (const association::Method method : association_methods()) {
    if (association::name(method) == chosen) settings.navigator.method = method;
  }
}

std::vector<std::string> decorrelations() {
  using pf_relocalize::Decorrelation;
  std::vector<std::string> names;
  for (const Decorrelation decorrelation :
       {Decorrelation::relative_marginals, Decorrelation::scalar_bound, Decorrelation::trace_bound,
        Decorrelation::whitened_bound, Decorrelation::constellations, Decorrelation::latent_modes}) {
    names.emplace_back(pf_relocalize::name_of(decorrelation));
  }
  return names;
}

void add_filter(CLI::App& command, Settings& settings) {
  cekf::FilterOptions& filter = settings.navigator.filter;
  const auto set_retraction = [&filter](const std::string& word) {
    filter.retraction = word == "standard" ? cekf::Retraction::standard : cekf::Retraction::right_invariant;
  };
  command.add_option_function<std::string>("--filter.retraction", set_retraction, "How a correction is applied")
      ->check(one_of({"right-invariant", "standard"}))
      ->default_str("right-invariant")
      ->group(group);
  add_length(
      command, settings, "filter.cell_side_m", 1e-3, 1e6,
      "Side of a cell; the cell of the vehicle and its 8 neighbours are active; auto: 2/3 of the sensor's reach");
  add_length(command, settings, "filter.hysteresis_m", 0.0, 1e6,
             "So far beyond its cell the vehicle goes before the region switches; auto: 2/3 of the reach");
  add_number(command, "--filter.max_active_landmarks", filter.max_active_landmarks, 1, 100000,
             "More active landmarks than this make a switch due");
}

void add_association(CLI::App& command, Settings& settings) {
  std::vector<std::string> names{"known"};
  for (const association::Method method : association_methods()) names.emplace_back(association::name(method));
  command
      .add_option_function<std::string>(
          "--association.method,--association", [&settings](const std::string& word) { choose_method(word, settings); },
          "Which observation belongs to which landmark; known: by the log's labels")
      ->check(one_of(names))
      ->default_str(std::string(association::name(settings.navigator.method)))
      ->group(group);
  supervisor::NavigatorOptions& navigator = settings.navigator;
  add_number(command, "--association.detection_probability", navigator.association.detection_probability, 0.01, 0.999,
             "P_D that a landmark in view is seen in one scan");
  add_number(command, "--association.extraneous_per_scan", navigator.extraneous_per_scan, 0.01, 100.0,
             "Expected observations of no mapped landmark in a scan: clutter and new ones");
  add_number(command, "--association.match_probability", navigator.gates.match_probability, 0.5, 0.999999,
             "Gate within which an observation may be matched, as the probability that a right pair is inside");
  add_number(command, "--association.new_probability", navigator.gates.new_probability, 0.5, 0.99999999,
             "Gate beyond which, from every landmark, an observation begins a new one");
  add_number(command, "--association.joint_probability", navigator.association.joint_probability, 0.5, 0.999999,
             "Gate of the joint NIS of all pairs of a scan");
  add_number(command, "--association.min_margin_nats", navigator.association.min_margin_nats, 0.0, 100.0,
             "A match whose best alternative is nearer than this is ambiguous and not used");
}

void add_landmarks(CLI::App& command, Settings& settings) {
  association::LifeOptions& life = settings.navigator.life;
  add_number(command, "--landmarks.mature_looks", life.mature_looks, 1, 1000,
             "Looks from different places that make a landmark mature");
  add_length(command, settings, "landmarks.tentative_patience_m", 1e-3, 1e6,
             "A tentative landmark unseen over so long a drive dies; auto: the sensor's reach");
  add_number(command, "--landmarks.detection_probability", life.detection_probability, 0.01, 0.999,
             "That an expected landmark is seen in one look, occlusion included");
}

void add_particle_filter(CLI::App& command, supervisor::SearchOptions& search) {
  pf_relocalize::RelocalizerOptions& relocalizer = search.relocalizer;
  const auto set_particles = [&relocalizer](std::size_t most) {
    relocalizer.most_particles = most;
    relocalizer.least_particles = std::min(pf_relocalize::RelocalizerOptions{}.least_particles, most);
  };
  command
      .add_option_function<std::size_t>("--search.particles", set_particles,
                                        "Particles of an attempt at its start; later fewer where that is enough")
      ->check(number_between(std::size_t{100}, std::size_t{10'000'000}))
      ->default_str(std::to_string(relocalizer.most_particles))
      ->group(group);
  const auto set_start = [&relocalizer](const std::string& word) {
    relocalizer.helix.prior_share = word == "gaussian" ? 1.0 : pf_relocalize::HelixOptions{}.prior_share;
  };
  command
      .add_option_function<std::string>("--search.init", set_start,
                                        "Where particles start; helix: where an observation meets a landmark; "
                                        "gaussian: all over the prior (baseline)")
      ->check(one_of({"helix", "gaussian"}))
      ->default_str("helix")
      ->group(group);
  const auto set_decorrelation = [&search](const std::string& word) {
    search.reference.decorrelation = pf_relocalize::decorrelation_from(word);
  };
  command
      .add_option_function<std::string>("--search.decorrelation", set_decorrelation,
                                        "What becomes of the errors that old landmarks share, before the particle "
                                        "filter, which knows independent ones, sees them")
      ->check(one_of(decorrelations()))
      ->default_str(std::string(pf_relocalize::name_of(search.reference.decorrelation)))
      ->group(group);
  add_number(command, "--search.threads", relocalizer.threads, 1u, 256u,
             "Threads of the particle filter; results do not depend on it, and montecarlo, whose runs fill the cores, "
             "uses one");
}

void add_acceptance(CLI::App& command, supervisor::SearchOptions& search) {
  const auto set_acceptance = [&search](const std::string& word) {
    search.acceptance = word == "paper" ? supervisor::Acceptance::paper_rule : supervisor::Acceptance::constellation;
    if (word == "paper") search.closing = supervisor::ClosingMethod::restart;
  };
  command
      .add_option_function<std::string>("--search.acceptance", set_acceptance,
                                        "What is believed; constellation: new landmarks that stand on old ones as "
                                        "nowhere else; paper: a cloud no wider than twice the odometry's noise "
                                        "(baseline, which closes by restart)")
      ->check(one_of({"constellation", "paper"}))
      ->default_str("constellation")
      ->group(group);
  add_number(command, "--search.passes", search.passes, 1, 1000,
             "So many constellation tests in a row must be passed before a loop is closed");
  add_number(command, "--search.least_matches", search.constellation.least_matches, 3, 1000,
             "New landmarks that must stand on old ones for a constellation test to be passed");
  add_number(command, "--search.rival_ratio", search.constellation.rival_ratio, 0.01, 1.0,
             "A test is not passed when another pose explains this share of what the best pose does");
}

void add_search(CLI::App& command, Settings& settings) {
  supervisor::SearchOptions& search = settings.navigator.search;
  command
      .add_option_function<std::string>(
          "--search.enabled", [&search](const std::string& word) { search.enabled = word == "true"; },
          "Search with particles where a return is ambiguous; false: associate scan by scan, whatever may come")
      ->check(one_of({"true", "false"}))
      ->default_str("true")
      ->group(group);
  command
      .add_option_function<std::string>(
          "--search.integrity_monitor,--search.missing_spawn",
          [&search](const std::string& word) { search.integrity.enabled = word == "true"; },
          "A search also begins, from before, where old landmarks are missing and new ones spawn instead")
      ->check(one_of({"true", "false"}))
      ->default_str("true")
      ->group(group);
  add_number(command, "--search.seed", search.seed, std::uint64_t{0}, std::numeric_limits<std::uint64_t>::max(),
             "Seed of the particle filter and of the rivals tried; apart from the seed of a simulated world");
  add_length(command, settings, "search.old_after_m", 1e-3, 1e6,
             "A mature landmark unseen over so long a drive is old: met again, it may begin a search; auto: twice the "
             "sensor's reach");
  add_number(command, "--search.expected_confusers,--search.foreign_objects", search.expected_confusers, 1e-6, 1e3,
             "A search begins when so many objects other than the old landmark may be what was observed");
  const auto set_closing = [&search](const std::string& word) {
    using supervisor::ClosingMethod;
    search.closing = word == "merge"     ? ClosingMethod::merge
                     : word == "restart" ? ClosingMethod::restart
                                         : ClosingMethod::replay;
  };
  command
      .add_option_function<std::string>("--search.closing", set_closing,
                                        "How a loop is closed; replay: the scans since the search began are driven "
                                        "again with the associations found, or merged where that costs too much; "
                                        "merge: new landmarks become the old ones; restart: the pose is the "
                                        "particles', what was mapped since is forgotten (baseline)")
      ->check(one_of({"replay", "merge", "restart"}))
      ->default_str("replay")
      ->group(group);
  add_length(command, settings, "search.undecided_m", 1e-3, 1e6,
             "After so long a drive without a closing the question is left open; auto: 11 times the reach");
  add_number(command, "--search.smooth_up_to_scans", search.smooth_up_to_scans, 0, 100'000'000,
             "After a closing the whole drive is solved by least squares, unless it has more scans; 0: never");
  add_particle_filter(command, search);
  add_acceptance(command, search);
}

void add_slip(CLI::App& command, supervisor::SlipOptions& slip) {
  command
      .add_option_function<std::string>(
          "--slip.enabled", [&slip](const std::string& word) { slip.enabled = word == "true"; },
          "Landmarks beside where they are expected may say that the vehicle slipped; false: odometry is believed")
      ->check(one_of({"true", "false"}))
      ->default_str("true")
      ->group(group);
  add_number(command, "--slip.nats", slip.nats, 0.0, 1e6,
             "By so much a slip must explain a scan better than no slip does");
}

void add_noise(CLI::App& command, supervisor::NoiseOptions& noise) {
  command
      .add_option_function<std::string>(
          "--noise.adapt", [&noise](const std::string& word) { noise.adapt = word == "true"; },
          "Factors on the covariances of odometry and observations are learnt while driving, 1 at least; false: they "
          "are "
          "believed as they are claimed")
      ->check(one_of({"true", "false"}))
      ->default_str("false")
      ->group(group);
}

void add_truck(CLI::App& command, const std::string& section, logs::AcfrSettings& truck) {
  const auto name = [&section](const char* key) { return "--" + section + "." + key; };
  add_number(command, name("sigma_speed_mps").c_str(), truck.noise.sigma_speed_mps, 1e-3, 10.0,
             "Noise of one sample of the wheel's speed");
  add_number(command, name("sigma_steering_rad").c_str(), truck.noise.sigma_steering_rad, 1e-4, 1.0,
             "Noise of one sample of the steering angle");
  add_number(command, name("steering_offset_rad").c_str(), truck.steering_offset_rad, -0.5, 0.5,
             "Added to every recorded steering angle");
  add_number(command, name("steering_scale").c_str(), truck.steering_scale, 0.5, 2.0,
             "Every recorded steering angle is multiplied by this first");
  add_number(command, name("laser_heading_rad").c_str(), truck.T_robot_laser.heading_rad, -core::pi, core::pi,
             "Where the laser looks, from straight ahead to the left");
  add_number(command, name("laser_delay_s").c_str(), truck.laser_delay_s, 0.0, 1.0,
             "A scan was taken so long before its stamp");
  add_number(command, name("sigma_range_m").c_str(), truck.sigma_range_m, 1e-3, 100.0, "Noise of a detection's range");
  add_number(command, name("sigma_bearing_rad").c_str(), truck.sigma_bearing_rad, 1e-4, 1.0,
             "Noise of a detection's bearing");
}

void add_plaza(CLI::App& command, Settings& settings) {
  add_number(command, "--plaza.range_scale", settings.plaza_range_scale, 0.0, 2.0,
             "Recorded range over true one; 0: estimated from the log by the least innovations (known association)");
  add_number(command, "--plaza.sigma_range_m", settings.logs.plaza.sigma_range_m, 1e-3, 100.0, "Noise of a range");
}

void add_sensor(CLI::App& command, logs::ToldFieldOfView& told) {
  add_number(command, "--log.max_range_m", told.max_range_m, 0.0, 1e5,
             "The sensor sees so far; 0: as the log says, or estimated from its observations (DLR)");
  const auto set_width = [&told](double width_deg) { told.width_rad = width_deg * core::pi / 180.0; };
  command
      .add_option_function<double>("--log.view_deg", set_width,
                                   "Width of the field of view about straight ahead; 0: likewise")
      ->check(number_between(0.0, 360.0))
      ->default_str("0")
      ->group(group);
}

void add_gps(CLI::App& command, Settings& settings) {
  GpsSettings& gps = settings.gps;
  command
      .add_option_function<std::string>(
          "--gps.use,--gps", [&gps](const std::string& word) { gps.fuse = word == "fuse"; },
          "truth: GPS is only compared with; fuse: it updates the pose, and the map frame is that of the GPS, the "
          "start "
          "pose being aligned with the fixes of the first gps.start_m metres. Errors against GPS are then no truth")
      ->check(one_of({"truth", "fuse"}))
      ->default_str("truth")
      ->group(group);
  add_number(command, "--gps.sigma_m", gps.sigma_m, 1e-3, 1000.0, "Noise of a fix in x and in y (fuse)");
  add_number(command, "--gps.start_m", gps.start_m, 1.0, 1e5, "Drive that aligns the start with the GPS frame (fuse)");
  add_number(command, "--gps.gate_probability", settings.navigator.fix_probability, 0.5, 0.999999,
             "Gate of a fix, as the probability that a right one is inside (fuse)");
}

}  // namespace

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
  add_number(command, "--log.covariance_scale", settings.covariance_scale, 1e-6, 1e6,
             "Factor on every covariance of odometry and observations; DLR run e is right with 2.07");
  add_sensor(command, settings.field_of_view);
  add_filter(command, settings);
  add_association(command, settings);
  add_landmarks(command, settings);
  add_search(command, settings);
  add_slip(command, settings.navigator.slip);
  add_noise(command, settings.navigator.noise);
  add_truck(command, "victoria_park", settings.logs.victoria_park);
  add_truck(command, "car_park", settings.logs.car_park);
  add_plaza(command, settings);
  add_gps(command, settings);
}

}  // namespace helixnav::apps
