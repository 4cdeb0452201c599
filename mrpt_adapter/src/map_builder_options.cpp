// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/mrpt_adapter/map_builder_options.hpp"

#include <cstdlib>
#include <limits>
#include <string>
#include <vector>

#include <mrpt/config/CConfigFileBase.h>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/nearest_name.hpp"
#include "option_names.hpp"

namespace helixnav::mrpt_adapter {
namespace {

constexpr double radians_per_degree = core::pi / 180.0;
constexpr double huge = 1e6;

/// One key whose value is a number: where it is kept, in which unit the file has it, and what is allowed there.
struct NumberKey {
  const char* key;
  double MapBuilderOptions::*member;
  double low;
  double high;
  double unit = 1.0;  ///< member = unit × value in the file
};

using O = MapBuilderOptions;

const std::vector<NumberKey>& number_keys() {
  static const std::vector<NumberKey> keys{
      {"stdXY_no_odo", &O::stdXY_no_odo, 1e-6, huge},
      {"stdPhi_no_odo_deg", &O::stdPhi_no_odo_rad, 1e-6, 360.0, radians_per_degree},
      {"std_sensor_range", &O::std_sensor_range, 0.0, huge},
      {"std_sensor_yaw_deg", &O::std_sensor_yaw_rad, 0.0, 180.0, radians_per_degree},
      {"quantiles_3D_representation", &O::quantiles_3D_representation, 0.1, 100.0},
      {"data_assoc_IC_chi2_thres", &O::data_assoc_IC_chi2_thres, 0.5, 0.999999},
      {"extraneous_per_scan", &O::extraneous_per_scan, 0.01, 100.0},
      {"max_sensor_range", &O::max_sensor_range, 0.0, huge},
      {"std_detector_range", &O::std_detector_range, 0.0, huge},
      {"std_detector_yaw_deg", &O::std_detector_yaw_rad, 0.0, 180.0, radians_per_degree},
      {"detector_view_range", &O::detector_view_range, 0.0, huge},
      {"odo_a1", &O::odo_a1, 0.0, huge},
      {"odo_a2", &O::odo_a2, 0.0, huge},
      {"odo_a3", &O::odo_a3, 0.0, huge},
      {"odo_a4", &O::odo_a4, 0.0, huge},
      {"odo_min_std_xy", &O::odo_min_std_xy, 0.0, huge},
      {"odo_min_std_phi_deg", &O::odo_min_std_phi_rad, 0.0, 180.0, radians_per_degree},
      {"gps_std_xy", &O::gps_std_xy, 1e-3, huge},
      {"gps_probability", &O::gps_probability, 0.5, 0.999999},
      {"gps_latitude_deg", &O::gps_latitude_deg, -90.0, 90.0},
      {"gps_longitude_deg", &O::gps_longitude_deg, -180.0, 180.0},
      {"gps_altitude", &O::gps_altitude, -huge, huge},
      {"cell_side", &O::cell_side, 1.0, huge},
      {"hysteresis", &O::hysteresis, 0.0, huge},
      {"search_old_after", &O::search_old_after, 1.0, huge},
      {"search_scale", &O::search_scale, 1e-3, 1e3},
      {"search_foreign_per_scan", &O::search_extraneous_per_scan, 0.0, 100.0},  // the name of version 0.1
      {"search_extraneous_per_scan", &O::search_extraneous_per_scan, 0.0, 100.0},
      {"search_view_area", &O::search_view_area, 0.0, huge},
      {"fastslam_detection_probability", &O::fastslam_detection_probability, 0.01, 0.999},
      {"fastslam_new_density", &O::fastslam_new_density, 1e-9, 1e3},
      {"fastslam_clutter_density", &O::fastslam_clutter_density, 1e-9, 1e3},
  };
  return keys;
}

struct SwitchKey {
  const char* key;
  bool MapBuilderOptions::*member;
};

constexpr SwitchKey switch_keys[] = {{"force_ignore_odometry", &O::force_ignore_odometry},
                                     {"create_simplemap", &O::create_simplemap},
                                     {"use_landmark_ids", &O::use_landmark_ids},
                                     {"gps_use", &O::gps_use},
                                     {"search_enabled", &O::search_enabled},
                                     {"fastslam_weigh_unseen", &O::fastslam_weigh_unseen},
                                     {"enable_profiler", &O::enable_profiler}};

struct NameKey {
  const char* key;
  std::string MapBuilderOptions::*member;
  std::vector<std::string> allowed;
};

std::vector<NameKey> name_keys() {
  return {{"association", &O::association, association_names()},
          {"detector", &O::detector, detector_names()},
          {"retraction", &O::retraction, retraction_names()},
          {"filter", &O::filter, {"compressed-ekf", "fastslam"}},
          {"fastslam_association", &O::fastslam_association, fastslam_association_names()}};
}

struct CountKey {
  const char* key;
  std::uint64_t MapBuilderOptions::*member;
  std::uint64_t low;
  std::uint64_t high;
};

constexpr CountKey count_keys[] = {{"search_seed", &O::search_seed, 0, std::numeric_limits<std::uint64_t>::max()},
                                   {"search_threads", &O::search_threads, 1, 256},
                                   {"fastslam_particles", &O::fastslam_particles, 1, 1'000'000},
                                   {"fastslam_version", &O::fastslam_version, 1, 2},
                                   {"fastslam_seed", &O::fastslam_seed, 0, std::numeric_limits<std::uint64_t>::max()},
                                   {"fastslam_threads", &O::fastslam_threads, 1, 256}};

/// A section of a file, whose values are text until somebody asks for more.
class Section {
 public:
  Section(const mrpt::config::CConfigFileBase& source, const std::string& name) : source_(source), name_(name) {}

  bool has(const std::string& key) const { return source_.keyExists(name_, key); }

  std::string text(const std::string& key) const { return source_.read_string(name_, key, "", true); }

  double number(const std::string& key, double low, double high) const {
    const std::string value = text(key);
    char* end = nullptr;
    const double number = std::strtod(value.c_str(), &end);
    const bool whole = end != value.c_str() && *end == '\0';
    if (!whole || !(number >= low && number <= high)) {
      refuse(key, value, "a number from " + short_text(low) + " to " + short_text(high));
    }
    return number;
  }

  std::uint64_t count(const std::string& key, std::uint64_t low, std::uint64_t high) const {
    const std::string value = text(key);
    char* end = nullptr;
    const std::uint64_t number = std::strtoull(value.c_str(), &end, 10);
    const bool whole = !value.empty() && value.find_first_not_of("0123456789") == std::string::npos;
    if (!whole || number < low || number > high) {
      refuse(key, value, "a whole number from " + std::to_string(low) + " to " + std::to_string(high));
    }
    return number;
  }

  bool flag(const std::string& key) const {
    const std::string value = text(key);
    if (value == "true" || value == "1" || value == "yes" || value == "TRUE" || value == "True") return true;
    if (value == "false" || value == "0" || value == "no" || value == "FALSE" || value == "False") return false;
    refuse(key, value, "true or false");
  }

  std::string name(const NameKey& key) const {
    std::string value = text(key.key);
    for (const std::string& allowed : key.allowed) {
      if (value == allowed) return value;
    }
    std::string all;
    for (const std::string& allowed : key.allowed) all += (all.empty() ? "" : ", ") + allowed;
    refuse(key.key, value, "one of " + all + " (nearest: " + core::nearest_name(value, key.allowed) + ")");
  }

  [[noreturn]] void refuse(const std::string& key, const std::string& value, const std::string& expected) const {
    throw core::InputError("[" + name_ + "] " + key + " = \"" + value + "\": expected " + expected);
  }

 private:
  const mrpt::config::CConfigFileBase& source_;
  const std::string& name_;
};

/// kf-slam's own choice of a method, where ours is not made: its joint test has a successor here, and its nearest
/// neighbour, which is its default and stands in most of its files, means "no joint test asked for".
void take_method_of_kf_slam(const Section& section, MapBuilderOptions& options) {
  if (section.has("association") || !section.has("data_assoc_method")) return;
  const std::string value = section.text("data_assoc_method");
  if (value == "1" || value == "assocJCBB") {
    options.association = "jcbb";
  } else if (value != "0" && value != "assocNN") {
    section.refuse("data_assoc_method", value, "assocNN (0) or assocJCBB (1)");
  }
}

}  // namespace

void MapBuilderOptions::loadFromConfigFile(const mrpt::config::CConfigFileBase& source, const std::string& section) {
  const Section from(source, section);
  MapBuilderOptions read = *this;
  for (const NumberKey& key : number_keys()) {
    if (from.has(key.key)) read.*key.member = key.unit * from.number(key.key, key.low, key.high);
  }
  for (const SwitchKey& key : switch_keys) {
    if (from.has(key.key)) read.*key.member = from.flag(key.key);
  }
  for (const CountKey& key : count_keys) {
    if (from.has(key.key)) read.*key.member = from.count(key.key, key.low, key.high);
  }
  for (const NameKey& key : name_keys()) {
    if (from.has(key.key)) read.*key.member = from.name(key);
  }
  take_method_of_kf_slam(from, read);
  *this = read;
}

void MapBuilderOptions::saveToConfigFile(mrpt::config::CConfigFileBase& target, const std::string& section) const {
  for (const NumberKey& key : number_keys()) {
    target.write(section, key.key, exact_text(this->*key.member / key.unit));
  }
  for (const SwitchKey& key : switch_keys) {
    target.write(section, key.key, std::string(this->*key.member ? "true" : "false"));
  }
  for (const CountKey& key : count_keys) target.write(section, key.key, std::to_string(this->*key.member));
  for (const NameKey& key : name_keys()) target.write(section, key.key, this->*key.member);
}

}  // namespace helixnav::mrpt_adapter
