// SPDX-License-Identifier: BSD-3-Clause
#include "slam/slam_config.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <mrpt/config/CConfigFileMemory.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/nearest_name.hpp"

namespace helixnav::apps {
namespace {

using mrpt::config::CConfigFileMemory;
using Names = std::vector<std::string>;

constexpr const char* application = "MappingApplication";
constexpr const char* filter = "RangeBearingKFSLAM";
constexpr const char* kalman = "RangeBearingKFSLAM_KalmanFilter";
constexpr const char* ours = "HelixNav";

const Names& application_keys() {
  static const Names keys{"kf_implementation",
                          "rawlog_file",
                          "rawlog_offset",
                          "logOutput_dir",
                          "SAVE_LOG_FREQUENCY",
                          "SAVE_DA_LOG",
                          "SAVE_3D_SCENES",
                          "SHOW_3D_LIVE",
                          "CAMERA_3DSCENE_FOLLOWS_ROBOT",
                          "ground_truth_file",
                          "ground_truth_file_robot"};
  return keys;
}

bool contains(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

Names keys_of(const CConfigFileMemory& ini, const std::string& section) {
  Names keys;
  ini.getAllKeys(section, keys);
  return keys;
}

/// The keys that MapBuilderOptions reads.
Names builder_keys() {
  CConfigFileMemory ini;
  mrpt_adapter::MapBuilderOptions().saveToConfigFile(ini, "all");
  return keys_of(ini, "all");
}

std::string content_of(const std::string& path) {
  if (!std::filesystem::is_regular_file(path)) {
    throw core::InputError(path + ": expected a configuration file, found " +
                           (std::filesystem::exists(path) ? "a folder" : "nothing there"));
  }
  std::ifstream file(path, std::ios::binary);
  std::ostringstream content;
  content << file.rdbuf();
  if (!file) throw core::InputError(path + ": cannot be read");
  return content.str();
}

/// Values of one section; errors are reported with file, section and key.
class Section {
 public:
  Section(const CConfigFileMemory& ini, const std::string& path, const char* name)
      : ini_(ini), path_(path), name_(name) {}

  bool has(const char* key) const { return ini_.keyExists(name_, key); }

  void read(const char* key, std::string& value) const {
    if (has(key)) value = text(key);
  }

  void read(const char* key, std::size_t& value) const {
    if (!has(key)) return;
    const std::string word = text(key);
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) fail(key, word, "a whole number, 0 or more");
  }

  void read(const char* key, bool& value) const {
    if (!has(key)) return;
    std::string word = text(key);
    std::transform(word.begin(), word.end(), word.begin(), [](unsigned char c) { return std::tolower(c); });
    const bool yes = contains({"1", "true", "yes"}, word);
    if (!yes && !contains({"0", "false", "no"}, word)) fail(key, word, "true or false");
    value = yes;
  }

  [[noreturn]] void fail(const std::string& key, const std::string& found, const std::string& expected) const {
    throw core::InputError(path_ + ": [" + name_ + "] " + key + ": expected " + expected + ", found '" + found + "'");
  }

 private:
  /// Without the comment that may follow on the line, and without surrounding blanks.
  std::string text(const char* key) const {
    std::string word = ini_.read_string(name_, key, "");
    for (const char* comment : {" //", "\t//", " #", "\t#", " ;", "\t;"}) word = word.substr(0, word.find(comment));
    const std::size_t begin = word.find_first_not_of(" \t\r");
    if (begin == std::string::npos) return {};
    return word.substr(begin, word.find_last_not_of(" \t\r") - begin + 1);
  }

  const CConfigFileMemory& ini_;
  const std::string& path_;
  std::string name_;
};

void read_application(const Section& section, SlamConfig& config) {
  std::string implementation = "CRangeBearingKFSLAM2D";
  section.read("kf_implementation", implementation);
  if (!contains({"CRangeBearingKFSLAM", "CRangeBearingKFSLAM2D"}, implementation)) {
    section.fail("kf_implementation", implementation, "CRangeBearingKFSLAM or CRangeBearingKFSLAM2D");
  }
  section.read("rawlog_file", config.rawlog_file);
  section.read("rawlog_offset", config.rawlog_offset);
  section.read("logOutput_dir", config.logOutput_dir);
  section.read("SAVE_LOG_FREQUENCY", config.SAVE_LOG_FREQUENCY);
  section.read("SAVE_DA_LOG", config.SAVE_DA_LOG);
  section.read("SAVE_3D_SCENES", config.SAVE_3D_SCENES);
  section.read("SHOW_3D_LIVE", config.SHOW_3D_LIVE);
  section.read("CAMERA_3DSCENE_FOLLOWS_ROBOT", config.CAMERA_3DSCENE_FOLLOWS_ROBOT);
  section.read("ground_truth_file", config.ground_truth_file);
  section.read("ground_truth_file_robot", config.ground_truth_file_robot);
}

/// The filter that the file asks kf-slam for, by MRPT's names or numbers. Both plain ones are an EKF with the standard
/// retraction, the second of them scalar by scalar; a `retraction` in the file is read after this one. Iterated ones
/// have no successor here. True if the key took effect.
bool take_filter_of_kf_slam(const Section& section, mrpt_adapter::MapBuilderOptions& options) {
  constexpr const char* key = "method";
  if (!section.has(key)) return false;
  std::string method;
  section.read(key, method);
  if (contains({"2", "kfIKFFull", "3", "kfIKF"}, method)) return false;
  if (!contains({"0", "kfEKFNaive", "1", "kfEKFAlaDavison"}, method)) {
    section.fail(key, method, "kfEKFNaive (0), kfEKFAlaDavison (1), kfIKFFull (2) or kfIKF (3)");
  }
  options.retraction = "standard";
  return true;
}

void refuse_unknown_keys(const CConfigFileMemory& ini, const std::string& path) {
  Names known = builder_keys();
  known.insert(known.end(), {"save_png", "overwrite", "map"});
  const Names keys = keys_of(ini, ours);
  const auto unknown =
      std::find_if_not(keys.begin(), keys.end(), [&](const auto& key) { return contains(known, key); });
  if (unknown == keys.end()) return;
  throw core::InputError(path + ": [" + ours + "] " + *unknown + ": unknown key; did you mean '" +
                         core::nearest_name(*unknown, known) + "'?");
}

Names keys_without_effect(const CConfigFileMemory& ini, bool filter_taken) {
  Names names;
  const auto add = [&](const char* section, const Names& known) {
    for (const std::string& key : keys_of(ini, section)) {
      if (!contains(known, key)) names.push_back(std::string("[") + section + "] " + key);
    }
  };
  add(application, application_keys());
  add(filter, builder_keys());
  add(kalman, filter_taken ? Names{"method"} : Names{});
  return names;
}

}  // namespace

SlamConfig read_slam_config(const std::string& path) {
  const CConfigFileMemory ini(content_of(path));
  Names sections;
  ini.getAllSections(sections);
  const Names known{application, filter, kalman, ours};
  if (std::none_of(sections.begin(), sections.end(), [&](const std::string& name) { return contains(known, name); })) {
    throw core::InputError(path +
                           ": expected one of the sections [MappingApplication], [RangeBearingKFSLAM] and [HelixNav], "
                           "found none");
  }
  SlamConfig config;
  const bool filter_taken = take_filter_of_kf_slam(Section(ini, path, kalman), config.builder);
  try {
    config.builder.loadFromConfigFile(ini, filter);
    config.builder.loadFromConfigFile(ini, ours);
  } catch (const core::InputError& error) {
    throw core::InputError(path + ": " + error.what());
  }
  read_application(Section(ini, path, application), config);
  const Section own(ini, path, ours);
  own.read("save_png", config.save_png);
  own.read("overwrite", config.overwrite);
  own.read("map", config.map);
  refuse_unknown_keys(ini, path);
  config.without_effect = keys_without_effect(ini, filter_taken);
  return config;
}

}  // namespace helixnav::apps
