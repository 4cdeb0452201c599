// SPDX-License-Identifier: BSD-3-Clause
#include "slam/slam_files.hpp"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

#include <mrpt/core/exceptions.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/math/CMatrixDynamic.h>
#include <mrpt/math/CVectorDynamic.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CObservationBearingRange.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include "helixnav/core/errors.hpp"
#include "helixnav/mrpt_adapter/conversions.hpp"
#include "slam/slam_scene.hpp"

namespace helixnav::apps {
namespace {

using mrpt::obs::CObservationBearingRange;

constexpr const char* associations_header =
    "%           TIMESTAMP                INDEX_IN_OBS    ID    RANGE(m)    YAW(rad)   PITCH(rad) \n"
    "%--------------------------------------------------------------------------------------------\n";

struct Sighting {
  double range_m = 0.0;
  double yaw_rad = 0.0;
  double pitch_rad = 0.0;
};

/// What was measured, by the indices used in data associations.
std::vector<Sighting> sightings_of(const mrpt::obs::CObservation& seen,
                                   const mrpt_adapter::MapBuilderOptions& options) {
  std::vector<Sighting> sightings;
  if (const auto* landmarks = dynamic_cast<const CObservationBearingRange*>(&seen)) {
    for (const auto& measured : landmarks->sensedData) {
      sightings.push_back({measured.range, measured.yaw, measured.pitch});
    }
  } else if (const auto* laser = dynamic_cast<const mrpt::obs::CObservation2DRangeScan*>(&seen)) {
    for (const core::Observation& found : mrpt_adapter::scan_of(*laser, options).scan.observations) {
      sightings.push_back({found.z[0], found.z[1], 0.0});
    }
  }
  return sightings;
}

std::string numbered(std::size_t step) {
  char text[32];
  std::snprintf(text, sizeof text, "_%05zu", step);
  return text;
}

/// Whether this is a name that a run gives to a kf-slam file, with or without a step number.
bool is_written_here(const std::string& name) {
  for (const char* alone : {"data_association.log", "landmarks.txt", "map.simplemap", "map.png"}) {
    if (name == alone) return true;
  }
  const std::string stem = name.substr(0, name.find('.'));
  const std::string ending = name.substr(stem.size());
  const std::size_t digits = stem.size() - std::min(stem.size(), stem.find_last_not_of("0123456789") + 1);
  const bool is_numbered = digits >= 5 && stem.size() > digits && stem[stem.size() - digits - 1] == '_';
  const std::string kind = is_numbered ? stem.substr(0, stem.size() - digits - 1) : stem;
  if (kind == "kf_state") return ending == ".3Dscene";
  return (kind == "robot_pose" || kind == "full_cov") && ending == ".txt";
}

/// A shorter run would leave the last numbers of a longer one beside its own.
void remove_earlier_files(const std::string& folder) {
  std::vector<std::filesystem::path> earlier;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.is_regular_file() && is_written_here(entry.path().filename().string())) earlier.push_back(entry.path());
  }
  for (const std::filesystem::path& path : earlier) {
    std::error_code error;
    std::filesystem::remove(path, error);
    if (error) throw core::InputError(path.string() + ": cannot be removed: " + error.message());
  }
}

void write_landmarks(const std::string& path, const std::vector<mrpt::math::TPoint2D>& points,
                     const std::map<unsigned int, std::int64_t>& ids) {
  std::ofstream file(path);
  file << "% x[m] y[m] ID\n";
  char line[96];
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::snprintf(line, sizeof line, "%.9f %.9f %lld\n", points[i].x, points[i].y,
                  static_cast<long long>(ids.at(static_cast<unsigned int>(i))));
    file << line;
  }
  if (!file.flush()) throw core::InputError(path + ": cannot be written");
}

}  // namespace

SlamFiles::SlamFiles(const SlamConfig& config, std::string folder, std::vector<Eigen::Vector2d> true_path_m)
    : config_(config), folder_(std::move(folder)), true_path_m_(std::move(true_path_m)) {
  remove_earlier_files(folder_);
  if (!config_.SAVE_DA_LOG) return;
  associations_.open(folder_ + "/data_association.log");
  if (!(associations_ << associations_header)) {
    throw core::InputError(folder_ + "/data_association.log: cannot be written");
  }
}

void SlamFiles::write_step(const mrpt_adapter::MapBuilder& builder, const mrpt::obs::CObservation& seen,
                           std::size_t step) {
  if (config_.SAVE_DA_LOG) write_associations(builder, seen);
  const std::size_t every = config_.SAVE_LOG_FREQUENCY;
  if (every == 0 || step % every != 0) return;
  write_state(builder, numbered(step));
}

void SlamFiles::write_associations(const mrpt_adapter::MapBuilder& builder, const mrpt::obs::CObservation& seen) {
  const std::vector<Sighting> sightings = sightings_of(seen, config_.builder);
  const double time_s = mrpt::Clock::toDouble(seen.timestamp);
  char line[160];
  for (const auto& pairing : builder.getLastDataAssociation().pairings) {
    if (pairing.measurement >= sightings.size()) continue;
    const Sighting& sighting = sightings[pairing.measurement];
    std::snprintf(line, sizeof line, "%35.22f %8zu %10lld %10f %12f %12f\n", time_s, pairing.measurement,
                  static_cast<long long>(pairing.landmark), sighting.range_m, sighting.yaw_rad, sighting.pitch_rad);
    associations_ << line;
  }
}

void SlamFiles::write_state(const mrpt_adapter::MapBuilder& builder, const std::string& suffix) const {
  mrpt::poses::CPosePDFGaussian pose;
  std::vector<mrpt::math::TPoint2D> points;
  std::map<unsigned int, std::int64_t> ids;
  mrpt::math::CVectorDouble state;
  mrpt::math::CMatrixDouble covariance;
  builder.getCurrentState(pose, points, ids, state, &covariance);
  pose.mean.asVectorVal().saveToTextFile(folder_ + "/robot_pose" + suffix + ".txt");
  covariance.saveToTextFile(folder_ + "/full_cov" + suffix + ".txt");
  if (suffix.empty()) write_landmarks(folder_ + "/landmarks.txt", points, ids);
  if (!config_.SAVE_3D_SCENES) return;
  const std::string path = folder_ + "/kf_state" + suffix + ".3Dscene";
  if (!scene_of(builder, true_path_m_)->saveToFile(path)) throw core::InputError(path + ": cannot be written");
}

void SlamFiles::write_end(mrpt_adapter::MapBuilder& builder) {
  associations_.close();
  write_state(builder, "");
  if (config_.builder.create_simplemap) {
    mrpt::maps::CSimpleMap map;
    builder.getCurrentlyBuiltMap(map);
    const std::string path = folder_ + "/map.simplemap";
    if (!map.saveToFile(path)) throw core::InputError(path + ": cannot be written");
  }
  if (config_.save_png) write_picture(builder);
}

/// If there is nothing to render with, the builder draws.
void SlamFiles::write_picture(mrpt_adapter::MapBuilder& builder) const {
  const std::string path = folder_ + "/map.png";
  const auto scene = scene_of(builder, true_path_m_);
  try {
    render_png(builder, *scene, path);
  } catch (const mrpt::ExceptionWithCallBackBase& error) {
    std::fprintf(stderr, "helixnav-slam: map.png is drawn, not rendered: %s\n", error.originalWhat.c_str());
    builder.saveCurrentEstimationToImage(path);
  }
}

}  // namespace helixnav::apps
