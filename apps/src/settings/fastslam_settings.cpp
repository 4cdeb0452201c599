// SPDX-License-Identifier: BSD-3-Clause
#include "fastslam_settings.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <vector>

#include <CLI/CLI.hpp>

#include "config_file.hpp"
#include "helixnav/fastslam/association_names.hpp"
#include "setting_options.hpp"
#include "validators.hpp"

namespace helixnav::apps {
namespace {

using fastslam::Association;

void choose_association(const std::string& word, fastslam::Options& options) {
  for (const auto& [name, association] : fastslam::association_names()) {
    if (name == word) options.association = association;
  }
}

void add_switch(CLI::App& command, const std::string& name, bool& value, const std::string& help) {
  command
      .add_option_function<std::string>(
          name, [&value](const std::string& word) { value = word == "true"; }, help)
      ->check(one_of({"true", "false"}))
      ->default_str(value ? "true" : "false")
      ->group(settings_group);
}

void add_cloud(CLI::App& command, FastSlamSettings& settings) {
  fastslam::Options& options = settings.options;
  add_number(command, "--fastslam.particles", options.particles, std::size_t{1}, std::size_t{1'000'000},
             "Number of particles, each with its own path and map");
  const auto set_version = [&options](int version) {
    options.proposal = version == 1 ? fastslam::Proposal::motion : fastslam::Proposal::motion_and_scan;
  };
  command
      .add_option_function<int>("--fastslam.version", set_version,
                                "Where poses are drawn from; 1: odometry (FastSLAM 1.0); 2: odometry corrected by the "
                                "landmarks matched (FastSLAM 2.0)")
      ->check(number_between(1, 2))
      ->default_str("2")
      ->group(settings_group);
  add_number(command, "--fastslam.seed", settings.seed, std::uint64_t{0}, std::numeric_limits<std::uint64_t>::max(),
             "Seed of the particles");
  add_number(command, "--fastslam.threads", options.threads, 1u, 256u, "Threads; results do not depend on it");
  add_number(command, "--fastslam.resample_below", options.resample_below, 0.0, 1.0,
             "Resample when the effective sample size falls below this share of the particles");
  add_number(command, "--fastslam.added_sigma_m", options.added_sigma_m, 0.0, 10.0,
             "Noise added to the odometry of each scan, in x and in y: keeps the particles apart");
  add_number(command, "--fastslam.added_sigma_rad", options.added_sigma_rad, 0.0, 1.0, "The same in heading");
  add_number(command, "--fastslam.genealogy_m", options.genealogy_m, 0.1, 1e6,
             "Loop length: the report states how many distinct ancestors the particles have this far back");
}

void add_association(CLI::App& command, fastslam::Options& options) {
  std::vector<std::string> names;
  for (const auto& association : fastslam::association_names()) names.push_back(association.first);
  command
      .add_option_function<std::string>(
          "--fastslam.association", [&options](const std::string& word) { choose_association(word, options); },
          "How each particle associates; known: by the log's labels; sampled: drawn with the probabilities of the "
          "alternatives; multiple-hypotheses: one child for each alternative")
      ->check(one_of(names))
      ->default_str("likelihood-ratio")
      ->group(settings_group);
  add_number(command, "--fastslam.match_gate", options.match_gate, 0.1, 1000.0,
             "NIS up to which a landmark may be matched; 13.82: 99.9 % of correct pairs are inside");
  add_number(command, "--fastslam.new_gate", options.new_gate, 0.1, 1000.0,
             "An observation with a larger NIS than this from every landmark starts a new one; between the gates it is "
             "ignored");
  add_switch(command, "--fastslam.exclusive", options.exclusive,
             "Two observations of one scan are never of the same landmark");
  add_number(command, "--fastslam.detection_probability", options.detection_probability, 0.01, 0.999,
             "P_D that a landmark in view is seen in one scan");
  add_switch(command, "--fastslam.weigh_unseen", options.weigh_unseen,
             "Weight particles by the landmarks that were in view but not seen; needs a log with known field of view, "
             "and a correct P_D");
  add_number(
      command, "--fastslam.new_density", options.new_density, 1e-9, 1e3,
      "Density of observations of new landmarks in a scan, per m rad of the view, or per m^2 for a sensor of points");
  add_number(command, "--fastslam.clutter_density", options.clutter_density, 1e-9, 1e3, "Density of clutter, likewise");
}

void add_hypotheses(CLI::App& command, fastslam::HypothesisOptions& hypotheses) {
  add_switch(command, "--fastslam.split_always", hypotheses.split_always,
             "multiple-hypotheses: split even if only one landmark is in the gate");
  add_number(command, "--fastslam.resample_every_scans", hypotheses.resample_every_scans, 1, 1'000'000,
             "multiple-hypotheses: scans with observations between resamplings, in place of resample_below");
  add_number(command, "--fastslam.most_children", hypotheses.most_children, std::size_t{1}, std::size_t{1000},
             "multiple-hypotheses: with more children than this times the particles, they are resampled at once");
}

void add_existence(CLI::App& command, fastslam::ExistenceOptions& existence) {
  add_switch(command, "--fastslam.remove", existence.remove,
             "A particle removes landmarks that it should see and does not; never with association known");
  add_number(command, "--fastslam.look_probability", existence.detection_probability, 0.11, 0.999,
             "Probability that an existing landmark is seen in one look, occlusion included; used by remove");
  add_number(command, "--fastslam.mature_looks", existence.mature_looks, 1, 1000,
             "Sightings from different places that make a landmark mature");
}

/// True if the option is not at its default.
bool is_changed(const CLI::Option& option) {
  return option.count() > 0 && option.results().back() != option.get_default_str();
}

std::string section_of(const CLI::Option& option) { return key_of(option).substr(0, key_of(option).find('.')); }

[[noreturn]] void refuse(const CLI::Option& option, const std::string& why) {
  throw CLI::ValidationError("--" + key_of(option), why);
}

void refuse_without_fastslam(const CLI::Option& option) {
  if (section_of(option) == "fastslam") refuse(option, "is of --filter fastslam, and the filter is compressed-ekf");
}

void refuse_with_fastslam(const CLI::Option& option) {
  const std::string section = section_of(option), key = key_of(option);
  if (section == "association")
    refuse(option, "--filter fastslam associates as --fastslam.association and the settings beside it say");
  if (section == "landmarks") refuse(option, "--filter fastslam has --fastslam.mature_looks and .look_probability");
  if (key == "gps.use" && is_changed(option))
    refuse(option, "--filter fastslam does not use GPS; it can be compared with it only (truth)");
  const bool of_navigator =
      section == "search" || section == "slip" || section == "moving" || section == "noise" || section == "filter";
  if (of_navigator && key != "filter.method") {
    refuse(option, "is of the compressed EKF and has no part in --filter fastslam");
  }
}

void refuse_contradictions(const CLI::App& command, const fastslam::Options& options) {
  if (options.new_gate < options.match_gate) {
    refuse(*command.get_option("--fastslam.new_gate"), "must not be less than fastslam.match_gate");
  }
  const bool splits = options.association == Association::multiple_hypotheses;
  for (const char* name : {"--fastslam.split_always", "--fastslam.resample_every_scans", "--fastslam.most_children"}) {
    const CLI::Option& option = *command.get_option(name);
    if (!splits && is_changed(option)) refuse(option, "is of --fastslam.association multiple-hypotheses");
  }
  const CLI::Option& below = *command.get_option("--fastslam.resample_below");
  if (splits && is_changed(below)) refuse(below, "multiple-hypotheses has --fastslam.resample_every_scans");
}

}  // namespace

void add_fastslam_settings(CLI::App& command, FastSlamSettings& settings) {
  add_cloud(command, settings);
  add_association(command, settings.options);
  add_hypotheses(command, settings.options.hypotheses);
  add_existence(command, settings.options.existence);
}

void check_filter(const CLI::App& command, const GivenOptions& given, const FastSlamSettings& settings) {
  for (const CLI::Option* option : configurable_options(command)) {
    if (given.count(option) == 0 && !is_changed(*option)) continue;
    settings.chosen ? refuse_with_fastslam(*option) : refuse_without_fastslam(*option);
  }
  if (settings.chosen) refuse_contradictions(command, settings.options);
}

std::string text_of(const FastSlamSettings& settings) {
  const fastslam::Options& options = settings.options;
  const auto is_chosen = [&](const auto& association) { return association.second == options.association; };
  const auto& names = fastslam::association_names();
  const auto chosen = std::find_if(names.begin(), names.end(), is_chosen);
  char text[200];
  std::snprintf(text, sizeof text, "FastSLAM %s, %zu particles, association %s, detection probability %.3g%s",
                options.proposal == fastslam::Proposal::motion ? "1.0" : "2.0", options.particles,
                chosen->first.c_str(), options.detection_probability,
                options.weigh_unseen ? "" : " (landmarks unseen are not weighed)");
  return text;
}

void require_compressed_ekf(const CLI::App& command, const GivenOptions& given, const FastSlamSettings& settings,
                            const std::string& why) {
  if (settings.chosen) throw CLI::ValidationError("--filter fastslam", why);
  check_filter(command, given, settings);
}

}  // namespace helixnav::apps
