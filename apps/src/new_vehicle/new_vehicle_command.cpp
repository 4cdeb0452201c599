// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/commands.hpp"
#include "example_log.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/logs/shipped_vehicle.hpp"
#include "settings/validators.hpp"

namespace helixnav::apps {
namespace {

/// Whether the folder did not exist before.
bool make_folder(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::error_code error;
  const bool is_there = fs::exists(folder);
  if (is_there && (!fs::is_directory(folder) || !fs::is_empty(folder))) {
    throw core::InputError(folder.string() + ": expected a folder that is empty or not there");
  }
  fs::create_directories(folder, error);
  if (error) throw core::InputError(folder.string() + ": " + error.message());
  return !is_there;
}

using NamedFiles = std::vector<std::pair<const char*, std::string>>;

/// All of them or none, and then no folder that did not exist before.
void write_files(const std::filesystem::path& folder, const NamedFiles& texts) {
  const bool is_new = make_folder(folder);
  try {
    for (const auto& [name, text] : texts) files::write_whole_file((folder / name).string(), text);
  } catch (const core::InputError&) {
    std::error_code ignored;
    for (const auto& named : texts) std::filesystem::remove(folder / named.first, ignored);
    if (is_new) std::filesystem::remove(folder, ignored);
    throw;
  }
}

void write_example(const std::filesystem::path& folder) {
  ExampleLog example = make_example_log();
  write_files(folder, {{"vehicle.toml", std::move(example.vehicle)},
                       {"odometry.csv", std::move(example.odometry)},
                       {"detections.csv", std::move(example.detections)},
                       {"truth_poses.csv", std::move(example.truth_poses)},
                       {"truth_landmarks.csv", std::move(example.truth_landmarks)}});
}

}  // namespace

void add_new_vehicle_command(CLI::App& app, ExitCode&) {
  CLI::App* command = app.add_subcommand("new-vehicle", "Write an example log with its vehicle.toml, to start from");
  const auto folder = std::make_shared<std::string>();
  command->add_option("DIR", *folder, "Folder to write; must be empty or new")->required();
  command->footer(
      "vehicle.toml is commented, and the log runs as it is.\n\n"
      "Example:\n"
      "  helixnav new-vehicle my_robot\n"
      "  helixnav check my_robot\n"
      "  helixnav replay my_robot --out runs/first\n"
      "  helixnav new-vehicle truck --like victoria_park\n");
  const auto like = std::make_shared<std::string>();
  command->add_option("--like", *like, "Write the vehicle.toml of a published log alone, for replay LOG --vehicle FILE")
      ->check(one_of(logs::shipped_vehicle_names()));
  command->callback([folder, like] {
    if (!like->empty()) {
      write_files(*folder, {{"vehicle.toml", std::string(logs::shipped_vehicle_text(*like))}});
      std::printf("%s/vehicle.toml: as replay takes it for such a log\n", folder->c_str());
      return;
    }
    write_example(*folder);
    std::printf(
        "%s: vehicle.toml, odometry.csv, detections.csv and truth_*.csv of an example\n"
        "next:   helixnav check %s\n"
        "        helixnav replay %s --out runs/first\n"
        "then put your own odometry.csv and detections.csv in their place and edit vehicle.toml\n",
        folder->c_str(), folder->c_str(), folder->c_str());
  });
}

}  // namespace helixnav::apps
