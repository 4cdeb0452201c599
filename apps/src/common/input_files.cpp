// SPDX-License-Identifier: BSD-3-Clause
#include "input_files.hpp"

#include <algorithm>
#include <filesystem>

namespace helixnav::apps {

std::vector<runs::InputFile> input_files(const std::string& path) {
  std::vector<std::string> names;
  if (std::filesystem::is_directory(path)) {
    for (const auto& entry : std::filesystem::directory_iterator(path)) {
      if (entry.is_regular_file()) names.push_back(entry.path().string());
    }
    std::sort(names.begin(), names.end());
  } else {
    names.push_back(path);
  }
  std::vector<runs::InputFile> inputs;
  for (const std::string& name : names) inputs.push_back({name, runs::sha256_of_file(name)});
  return inputs;
}

}  // namespace helixnav::apps
