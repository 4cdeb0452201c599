// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "setting_options.hpp"
#include "validators.hpp"

namespace helixnav::apps {
namespace {

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

void add_decorrelation(CLI::App& command, supervisor::SearchOptions& search) {
  const auto set_decorrelation = [&search](const std::string& word) {
    search.reference.decorrelation = pf_relocalize::decorrelation_from(word);
  };
  command
      .add_option_function<std::string>("--search.decorrelation", set_decorrelation,
                                        "How the correlations of the old landmarks are removed for the particle "
                                        "filter, which treats their errors as independent")
      ->check(one_of(decorrelations()))
      ->default_str(std::string(pf_relocalize::name_of(search.reference.decorrelation)))
      ->group(settings_group);
}

void add_particle_filter(CLI::App& command, supervisor::SearchOptions& search) {
  pf_relocalize::RelocalizerOptions& relocalizer = search.relocalizer;
  const auto set_particles = [&relocalizer](std::size_t most) {
    relocalizer.most_particles = most;
    relocalizer.least_particles = std::min(pf_relocalize::RelocalizerOptions{}.least_particles, most);
  };
  command
      .add_option_function<std::size_t>("--search.particles", set_particles,
                                        "Particles at the start of an attempt; later fewer if that is enough")
      ->check(number_between(std::size_t{100}, std::size_t{10'000'000}))
      ->default_str(std::to_string(relocalizer.most_particles))
      ->group(settings_group);
  const auto set_start = [&relocalizer](const std::string& word) {
    relocalizer.helix.prior_share = word == "gaussian" ? 1.0 : pf_relocalize::HelixOptions{}.prior_share;
  };
  command
      .add_option_function<std::string>("--search.init", set_start,
                                        "Where particles start; helix: where an observation meets a landmark; "
                                        "gaussian: drawn from the prior (baseline)")
      ->check(one_of({"helix", "gaussian"}))
      ->default_str("helix")
      ->group(settings_group);
  add_decorrelation(command, search);
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
                                        "Evidence for a closing; constellation: new landmarks that match old ones "
                                        "there and nowhere else; paper: a cloud no wider than twice the odometry's "
                                        "noise (baseline, which closes by restart)")
      ->check(one_of({"constellation", "paper"}))
      ->default_str("constellation")
      ->group(settings_group);
  add_number(command, "--search.passes", search.passes, 1, 1000,
             "Constellation tests to pass in a row before a loop is closed");
  add_number(command, "--search.least_matches", search.constellation.least_matches, 3, 1000,
             "New landmarks that must match old ones for a constellation test to be passed");
  add_number(command, "--search.rival_ratio", search.constellation.rival_ratio, 0.01, 1.0,
             "A test fails when a rival pose explains at least this share of what the best pose explains");
}

void add_trigger(CLI::App& command, Settings& settings) {
  supervisor::SearchOptions& search = settings.navigator.search;
  command
      .add_option_function<std::string>(
          "--search.enabled", [&search](const std::string& word) { search.enabled = word == "true"; },
          "Search with particles if a return is ambiguous; false: always associate scan by scan")
      ->check(one_of({"true", "false"}))
      ->default_str("true")
      ->group(settings_group);
  command
      .add_option_function<std::string>(
          "--search.integrity_monitor,--search.missing_spawn",
          [&search](const std::string& word) { search.integrity.enabled = word == "true"; },
          "Roll back and search if old landmarks go missing while new ones are mapped in their place")
      ->check(one_of({"true", "false"}))
      ->default_str("true")
      ->group(settings_group);
  add_number(command, "--search.seed", search.seed, std::uint64_t{0}, std::numeric_limits<std::uint64_t>::max(),
             "Seed of the particle filter and of the rivals tried; independent of the seed of a simulated world");
  add_length(command, settings, "search.old_after_m", 1e-3, 1e6,
             "A mature landmark that stays unseen over this driven distance is old, and so is one whose direction from "
             "the vehicle has become uncertain: seeing it again may start a search; auto: twice the sensor's reach");
  add_number(command, "--search.expected_confusers,--search.foreign_objects", search.expected_confusers, 1e-6, 1e3,
             "A search starts at this expected number of other objects that may have caused the observation");
}

void add_closing(CLI::App& command, Settings& settings) {
  supervisor::SearchOptions& search = settings.navigator.search;
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
      ->group(settings_group);
  add_length(command, settings, "search.undecided_m", 1e-3, 1e6,
             "A search without a closing is abandoned after this distance; auto: 11 times the reach");
  command
      .add_option_function<std::string>(
          "--search.whole_map", [&search](const std::string& word) { search.whole_map = word == "true"; },
          "Before a search ends undecided, and if odometry contradicts the closing that it found, search the whole map "
          "for the place; false: do not")
      ->check(one_of({"true", "false"}))
      ->default_str("true")
      ->group(settings_group);
  add_number(command, "--search.smooth_up_to_scans", search.smooth_up_to_scans, 0, 100'000'000,
             "Keep the raw measurements of up to this many scans, so that the drive can be solved again with other "
             "noise. After a closing a drive of any length is solved; with 0, none is");
}

}  // namespace

void add_search_settings(CLI::App& command, Settings& settings) {
  supervisor::SearchOptions& search = settings.navigator.search;
  add_trigger(command, settings);
  add_closing(command, settings);
  add_particle_filter(command, search);
  add_acceptance(command, search);
}

}  // namespace helixnav::apps
