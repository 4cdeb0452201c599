// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/logs/shipped_vehicle.hpp"

#include <filesystem>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/nearest_name.hpp"
#include "shipped_vehicle_texts.hpp"

namespace helixnav::logs {
namespace {

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

}  // namespace

std::vector<std::string> shipped_vehicle_names() {
  std::vector<std::string> names;
  for (const auto& [name, text] : shipped_vehicle_texts()) names.push_back(name);
  return names;
}

std::string_view shipped_vehicle_text(const std::string& name) {
  const auto found = shipped_vehicle_texts().find(name);
  if (found != shipped_vehicle_texts().end()) return found->second;
  const std::vector<std::string> names = shipped_vehicle_names();
  const std::string near = core::near_name(name, names);
  throw core::InputError(name + ": no such file, and no vehicle of that name ships" +
                         (near.empty() ? "." : "; did you mean '" + near + "'?") +
                         " Those that ship: " + listed(names));
}

std::optional<std::string> shipped_vehicle_of(LogFormat format) {
  switch (format) {
    case LogFormat::acfr_ascii:
    case LogFormat::victoria_park_mat:
      return "victoria_park";
    case LogFormat::car_park_mat:
      return "car_park";
    case LogFormat::plaza:
      return "plaza";
    case LogFormat::dlr:
      return "dlr";
    default:
      return std::nullopt;
  }
}

Vehicle shipped_vehicle(const std::string& name) {
  return read_vehicle_text(shipped_vehicle_text(name), name + ".toml (ships with helixnav)");
}

Vehicle find_vehicle(const std::string& file_or_name) {
  const bool is_file = file_or_name.find_first_of("./") != std::string::npos || std::filesystem::exists(file_or_name);
  return is_file ? read_vehicle(file_or_name) : shipped_vehicle(file_or_name);
}

}  // namespace helixnav::logs
