// SPDX-License-Identifier: BSD-3-Clause
#include "kept_inputs.hpp"

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>
#include <system_error>

#include "helixnav/core/errors.hpp"
#include "helixnav/runs/run_writer.hpp"

namespace helixnav::apps {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse_replacing(const std::string& input, const std::string& out) {
  throw core::InputError(out + ": " + input +
                         " is read, and would be lost by writing there; give --out another folder");
}

/// Names that join and runs of several robots write in addition to those of a run.
bool is_written(const std::string& name) {
  constexpr std::array<std::string_view, 4> others{"joins.csv", "changes.csv", "joined_from.csv", "sightings.csv"};
  return runs::is_run_file(name) || std::find(others.begin(), others.end(), name) != others.end();
}

/// Folders of parts, components and robots below a run folder.
bool is_written_below(const std::string& name) {
  constexpr std::array<std::string_view, 3> beginnings{"part_", "component_", "robot_"};
  return std::any_of(beginnings.begin(), beginnings.end(),
                     [&](std::string_view beginning) { return name.rfind(beginning, 0) == 0; });
}

/// Whether this folder is one that a run in `out` writes into.
bool is_folder_of(const fs::path& folder, const fs::path& out) {
  return folder == out || (folder.parent_path() == out && is_written_below(folder.filename().string()));
}

void check_file(const fs::path& file, const std::string& input, const fs::path& out, const std::string& name_of_out) {
  std::error_code error;
  const fs::path target = fs::canonical(file, error);
  if (!error && is_written(target.filename().string()) && is_folder_of(target.parent_path(), out)) {
    refuse_replacing(input, name_of_out);
  }
}

}  // namespace

void refuse_to_replace(const std::vector<std::string>& inputs, const std::string& out) {
  std::error_code none;  // a folder that does not exist yet holds nothing
  const fs::path folder = out.empty() ? fs::path() : fs::canonical(out, none);
  if (out.empty() || none) return;
  for (const std::string& input : inputs) {
    std::error_code error;
    const fs::path path = input.empty() ? fs::path() : fs::canonical(input, error);
    if (input.empty() || error) continue;
    if (!fs::is_directory(path)) {
      check_file(path, input, folder, out);
      continue;
    }
    if (is_folder_of(path, folder)) refuse_replacing(input, out);
    for (const auto& entry : fs::directory_iterator(path, error)) check_file(entry.path(), input, folder, out);
  }
}

}  // namespace helixnav::apps
