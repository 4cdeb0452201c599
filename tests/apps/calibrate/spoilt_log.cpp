// SPDX-License-Identifier: BSD-3-Clause
#include "spoilt_log.hpp"

#include <fstream>
#include <variant>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/sim/simulate.hpp"

namespace helixnav::apps {
namespace {

constexpr double degree = core::pi / 180.0;
constexpr double told_x_m = 0.5;

SpoiltLog draw(std::uint64_t seed) {
  core::RandomStream random(seed, "spoilt log");
  const auto either = [&random](double least, double most) {
    return (random.uniform(0.0, 1.0) < 0.5 ? -1.0 : 1.0) * random.uniform(least, most);
  };
  SpoiltLog log;
  log.right["scale"] = 1.0 + either(0.01, 0.03);
  log.right["turn_scale"] = 1.0 + either(0.01, 0.03);
  log.right["turn_bias_deg_per_s"] = either(0.05, 0.2);
  log.right["heading_deg"] = either(1.0, 2.0);
  log.right["x_m"] = told_x_m + either(0.1, 0.3);
  log.right["y_m"] = either(0.1, 0.3);
  log.right["delay_s"] = random.uniform(0.05, 0.15);
  log.right["range_offset_m"] = random.uniform(0.1, 0.25);
  return log;
}

core::Recording drive(std::uint64_t seed, const SpoiltLog& log) {
  sim::Scenario scenario = sim::named_scenario("figure-of-eight");
  const auto& right = log.right;
  scenario.scanner.T_robot_sensor = {right.at("x_m"), right.at("y_m"), right.at("heading_deg") * degree};
  scenario.true_noise.odometry = {0.15, 0.0147};
  return sim::simulate(scenario, seed);
}

void write_vehicle(const std::filesystem::path& folder, double noise_scale) {
  std::ofstream file(folder / "vehicle.toml");
  file << "[odometry]\nsigma_along_m_per_sqrt_m = " << 0.0274 / noise_scale
       << "\nsigma_sideways_m_per_sqrt_m = " << 0.0005 / noise_scale
       << "\nsigma_heading_deg_per_sqrt_m = " << 0.163 / noise_scale << "\n[[sensor]]\nx_m = " << told_x_m
       << "\nreach_m = 30\nmin_range_m = 1\nview_deg = [-90, 90]\nsigma_range_m = " << 0.1 / noise_scale
       << "\nsigma_bearing_deg = " << 0.7 / noise_scale << "\ndetection_probability = 0.9\nclutter_per_scan = 0.5\n";
}

}  // namespace

SpoiltLog write_spoilt_log(std::uint64_t seed, const std::filesystem::path& folder) {
  const SpoiltLog log = draw(seed);
  const core::Recording recording = drive(seed, log);
  std::filesystem::create_directories(folder);
  write_vehicle(folder, log.noise_scale);
  std::ofstream odometry(folder / "odometry.csv"), detections(folder / "detections.csv");
  odometry.precision(12);
  detections.precision(12);
  odometry << "t_s,dx_m,dy_m,dheading_deg\n";
  detections << "t_s,range_m,bearing_deg\n";
  const auto& right = log.right;
  double last_s = core::seconds(core::time_of(recording.events.front()));
  odometry << last_s << ",0,0,0\n";
  for (const core::Event& event : recording.events) {
    const double t_s = core::seconds(core::time_of(event));
    if (const auto* moved = std::get_if<core::Odometry>(&event)) {
      const core::Pose2& T = moved->T_before_after;
      const double turn_deg = T.heading_rad / degree + right.at("turn_bias_deg_per_s") * (t_s - last_s);
      odometry << t_s << ',' << T.x_m / right.at("scale") << ',' << T.y_m / right.at("scale") << ','
               << turn_deg / right.at("turn_scale") << '\n';
      last_s = t_s;
    } else if (const auto* scan = std::get_if<core::Scan>(&event)) {
      const double stamp_s = t_s + right.at("delay_s");
      if (scan->observations.empty()) detections << stamp_s << ",,\n";
      for (const core::Observation& z : scan->observations)
        detections << stamp_s << ',' << z.z[0] - right.at("range_offset_m") << ',' << z.z[1] / degree << '\n';
    }
  }
  return log;
}

}  // namespace helixnav::apps
