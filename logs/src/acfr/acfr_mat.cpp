// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "acfr_laser_text.hpp"
#include "acfr_limits.hpp"
#include "acfr_order.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/logs/acfr_log.hpp"
#include "mat_file.hpp"
#include "plausible.hpp"

namespace helixnav::logs {
namespace {

constexpr double seconds_per_millisecond = 1e-3;
/// Reading of the aa3_*.mat clock at time 0 of the text release.
constexpr core::Nanoseconds mat_clock_ahead_ns = 20'967'000'000;

/// A vector of times on the file's clock that never goes back.
std::vector<core::Nanoseconds> times(const MatFile& file, const std::string& name, double unit_s,
                                     std::size_t length = 0) {
  std::vector<core::Nanoseconds> times_ns;
  for (const double t : file.vector(name, length)) {
    const double t_s = t * unit_s;
    if (std::abs(t_s) > 4e9 || (!times_ns.empty() && core::nanoseconds_from_seconds(t_s) < times_ns.back())) {
      file.fail("variable " + name + ", element " + std::to_string(times_ns.size() + 1) +
                ": expected a time that does not go backwards, found " + std::to_string(t_s) + " s");
    }
    times_ns.push_back(core::nanoseconds_from_seconds(t_s));
  }
  return times_ns;
}

/// Variable names of one sensor in a file: its time and two columns.
struct Columns {
  const char* time;
  const char* first;
  const char* second;
  double time_unit_s;
};

std::vector<DeadReckoning> dead_reckoning(const MatFile& file, const Columns& names) {
  const std::vector<core::Nanoseconds> t_ns = times(file, names.time, names.time_unit_s);
  const std::vector<double> speed_mps = file.vector(names.first, t_ns.size());
  const std::vector<double> steering_rad = file.vector(names.second, t_ns.size());
  std::vector<DeadReckoning> readings(t_ns.size());
  for (std::size_t i = 0; i < t_ns.size(); ++i) {
    if (std::abs(speed_mps[i]) > most_speed_mps || std::abs(steering_rad[i]) > most_steering_rad) {
      file.fail(std::string("variables ") + names.first + ", " + names.second + ", element " + std::to_string(i + 1) +
                ": expected up to 100 m/s and 1.2 rad, found " + std::to_string(speed_mps[i]) + " and " +
                std::to_string(steering_rad[i]));
    }
    readings[i] = {t_ns[i], speed_mps[i], steering_rad[i]};
  }
  return readings;
}

std::vector<GpsFix> gps(const MatFile& file, const Columns& names) {
  const std::vector<core::Nanoseconds> t_ns = times(file, names.time, names.time_unit_s);
  const std::vector<double> east_m = file.vector(names.first, t_ns.size());
  const std::vector<double> north_m = file.vector(names.second, t_ns.size());
  std::vector<GpsFix> fixes(t_ns.size());
  for (std::size_t i = 0; i < t_ns.size(); ++i) {
    if (std::max(std::abs(east_m[i]), std::abs(north_m[i])) > most_coordinate_m) {
      file.fail(std::string("variables ") + names.first + ", " + names.second + ", element " + std::to_string(i + 1) +
                ": expected coordinates of up to 1e8 m");
    }
    fixes[i] = {t_ns[i], {east_m[i], north_m[i]}};
  }
  return fixes;
}

/// A matrix with one row per scan and one column per beam, as whole multiples of `unit` from 0 to `most`.
MatMatrix beams(const MatFile& file, const std::string& name, std::size_t scans, double unit, double most) {
  MatMatrix matrix = file.matrix(name);
  if (matrix.rows != scans || matrix.columns != SickScan::beams) {
    file.fail("variable " + name + ": expected " + std::to_string(scans) + " by 361, found " +
              std::to_string(matrix.rows) + " by " + std::to_string(matrix.columns));
  }
  for (double& value : matrix.values) {
    value = std::round(value / unit);
    if (value < 0.0 || value > most) {
      file.fail("variable " + name + ": expected values in 0 … " + std::to_string(most * unit) + ", found " +
                std::to_string(value * unit));
    }
  }
  return matrix;
}

std::vector<SickScan> ranges(const MatFile& file, const std::string& name, const std::vector<core::Nanoseconds>& t_ns,
                             double centimetre) {
  const MatMatrix range_cm = beams(file, name, t_ns.size(), centimetre, 65535.0);
  std::vector<SickScan> scans(t_ns.size());
  for (std::size_t i = 0; i < scans.size(); ++i) {
    scans[i].t_ns = t_ns[i];
    for (std::size_t beam = 0; beam < scans[i].range_cm.size(); ++beam) {
      scans[i].range_cm[beam] = static_cast<std::uint16_t>(range_cm(i, beam));
    }
  }
  return scans;
}

/// The scanner's code is in the top three bits of its 16-bit word.
void add_reflectivity(const MatFile& file, const std::string& name, std::vector<SickScan>& scans) {
  const MatMatrix code = beams(file, name, scans.size(), 8192.0, 7.0);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    for (std::size_t beam = 0; beam < scans[i].reflectivity.size(); ++beam) {
      scans[i].reflectivity[beam] = static_cast<std::uint8_t>(code(i, beam));
    }
  }
}

void read_order(const MatFile& file, AcfrLog& log) {
  const std::vector<core::Nanoseconds> t_ns = times(file, "Time", 1.0);
  const std::vector<double> sensor = file.vector("Sensor", t_ns.size());
  const std::vector<double> row = file.vector("Index", t_ns.size());
  AcfrOrder order(log);
  for (std::size_t i = 0; i < t_ns.size(); ++i) {
    const std::string objection = order.append(t_ns[i], std::llround(sensor[i]), std::llround(row[i]));
    if (!objection.empty()) {
      file.fail("variables Time, Sensor, Index, element " + std::to_string(i + 1) + ": " + objection);
    }
  }
}

std::vector<core::TrueLandmark> beacons(const std::filesystem::path& path) {
  const MatFile file(path);
  const MatMatrix east_north_m = file.matrix("estbeac");
  if (east_north_m.columns != 2) {
    file.fail("variable estbeac: expected 2 columns (east, north)");
  }
  std::vector<core::TrueLandmark> landmarks;
  for (std::size_t i = 0; i < east_north_m.rows; ++i) {
    landmarks.push_back({static_cast<core::Label>(i), {east_north_m(i, 0), east_north_m(i, 1)}});
  }
  return landmarks;
}

template <class Readings>
void to_clock_of_the_text_release(Readings& readings) {
  for (auto& reading : readings) {
    reading.t_ns -= mat_clock_ahead_ns;
  }
}

std::vector<SickScan> victoria_park_scans(const std::filesystem::path& folder) {
  const std::filesystem::path matrix = folder / "aa3_lsr2.mat";
  if (!std::filesystem::exists(matrix)) {
    return find_laser_text(folder);
  }
  const MatFile file(matrix);
  std::vector<SickScan> scans = ranges(file, "LASER", times(file, "TLsr", seconds_per_millisecond), 1.0);
  to_clock_of_the_text_release(scans);
  return scans;
}

}  // namespace

std::vector<GpsFix> read_victoria_park_gps(const std::filesystem::path& aa3_gpsx) {
  std::vector<GpsFix> fixes = gps(MatFile(aa3_gpsx), {"timeGps", "Lo_m", "La_m", seconds_per_millisecond});
  to_clock_of_the_text_release(fixes);
  return fixes;
}

AcfrLog read_victoria_park_mat(const std::filesystem::path& folder) {
  AcfrLog log;
  log.name = "victoria_park_mat";
  const MatFile file(folder / "aa3_dr.mat");
  log.dead_reckoning = dead_reckoning(file, {"time", "speed", "steering", seconds_per_millisecond});
  if (log.dead_reckoning.empty()) {
    file.fail("expected at least one speed and steering, found none");
  }
  to_clock_of_the_text_release(log.dead_reckoning);
  log.gps = read_victoria_park_gps(folder / "aa3_gpsx.mat");
  log.scans = victoria_park_scans(folder);
  order_by_time(log);
  return log;
}

AcfrLog read_car_park_mat(const std::filesystem::path& data_set) {
  const MatFile file(data_set);
  AcfrLog log;
  log.name = "car_park";
  log.dead_reckoning = dead_reckoning(file, {"Time_VS", "Velocity", "Steering", 1.0});
  log.gps = gps(file, {"TimeGPS", "GPSLon", "GPSLat", 1.0});
  log.scans = ranges(file, "Laser", times(file, "TimeLaser", 1.0), 0.01);
  add_reflectivity(file, "Intensity", log.scans);
  if (log.dead_reckoning.empty() || log.scans.empty()) {
    file.fail("expected at least one speed and steering and one scan, found none");
  }
  read_order(file, log);
  const std::filesystem::path surveyed = data_set.parent_path() / "beac_juan3.mat";
  if (std::filesystem::exists(surveyed)) {
    log.beacons = beacons(surveyed);
  }
  return log;
}

}  // namespace helixnav::logs
