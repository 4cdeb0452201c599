// SPDX-License-Identifier: BSD-3-Clause
#include "vehicle_constants.hpp"

#include "helixnav/core/angle.hpp"

namespace helixnav::apps {
namespace {

constexpr double degree_rad = core::pi / 180.0;

using Places = std::function<std::vector<double*>(Settings&)>;

VehicleConstant factor(const char* key, const Eigen::Vector3d& of, Places places) {
  return {key, key, -1, 1.0, 0.05, 1e-4, 0.5, 2.0, std::move(places), of};
}

VehicleConstant angle(const char* key, const char* stem, int sensor, double usual_rad, double most_rad, Places places) {
  return {key,  stem,      sensor,   degree_rad,        usual_rad,
          1e-5, -most_rad, most_rad, std::move(places), Eigen::Vector3d::Zero()};
}

VehicleConstant length(const char* key, int sensor, double usual_m, Places places) {
  return {key, key, sensor, 1.0, usual_m, 1e-4, -1e3, 1e3, std::move(places), Eigen::Vector3d::Zero()};
}

VehicleConstant delay(double least_s, double most_s, Places places) {
  return {"delay_s", "delay_s",         VehicleConstant::every_sensor, 1.0, 0.2, 0.0, least_s,
          most_s,    std::move(places), Eigen::Vector3d::Zero()};
}

/// Adds what `Get` finds in the settings: a reference to the number.
template <class Get>
Places place(Get get) {
  return [get](Settings& settings) { return std::vector<double*>{&get(settings)}; };
}

/// A mounting that is given has been measured; one at the origin may just not have been given.
double usual_arm_m(const core::Pose2& T_vehicle_sensor, double reach_m) {
  const bool is_given = T_vehicle_sensor.position_m().norm() > 0.0;
  return reach_m / (is_given ? 100.0 : 50.0);
}

template <class Truck>
std::vector<VehicleConstant> of_truck(Truck truck, double arm_m) {
  return {
      factor("scale", Eigen::Vector3d::Ones(), place([truck](Settings& s) -> double& { return truck(s).speed_scale; })),
      factor("steering_scale", Eigen::Vector3d::UnitZ(),
             place([truck](Settings& s) -> double& { return truck(s).steering_scale; })),
      angle("steering_offset_deg", "steering_offset", -1, 2.0 * degree_rad, 0.5,
            place([truck](Settings& s) -> double& { return truck(s).steering_offset_rad; })),
      angle("heading_deg", "heading", 0, 3.0 * degree_rad, core::pi,
            place([truck](Settings& s) -> double& { return truck(s).T_robot_laser.heading_rad; })),
      length("x_m", 0, arm_m, place([truck](Settings& s) -> double& { return truck(s).T_robot_laser.x_m; })),
      length("y_m", 0, arm_m, place([truck](Settings& s) -> double& { return truck(s).T_robot_laser.y_m; })),
      delay(0.0, 1.0, place([truck](Settings& s) -> double& { return truck(s).laser_delay_s; })),
  };
}

std::vector<VehicleConstant> of_own_odometry(bool steered) {
  const auto odometry = [](auto get) {
    return place([get](Settings& s) -> double& { return get(s.logs.vehicle->odometry); });
  };
  using Model = logs::OdometryModel;
  return {
      factor("scale", steered ? Eigen::Vector3d(1.0, 1.0, 1.0) : Eigen::Vector3d(1.0, 1.0, 0.0),
             odometry([](Model& m) -> double& { return m.scale; })),
      factor("turn_scale", Eigen::Vector3d::UnitZ(), odometry([](Model& m) -> double& { return m.turn_scale; })),
      angle("turn_bias_deg_per_s", "turn_bias", -1, 0.5 * degree_rad, 10.0,
            odometry([](Model& m) -> double& { return m.turn_bias_radps; })),
      factor("steering_scale", Eigen::Vector3d::UnitZ(),
             odometry([](Model& m) -> double& { return m.steering_scale; })),
      angle("steering_offset_deg", "steering_offset", -1, 2.0 * degree_rad, 1.0,
            odometry([](Model& m) -> double& { return m.steering_offset_rad; })),
  };
}

void add_own_sensors(const std::vector<logs::SensorModel>& sensors, double reach_m,
                     std::vector<VehicleConstant>& constants) {
  for (std::size_t i = 0; i < sensors.size(); ++i) {
    const double arm_m = usual_arm_m(sensors[i].T_vehicle_sensor, reach_m);
    const auto mounting = [i](auto get) {
      return place([i, get](Settings& s) -> double& { return get(s.logs.vehicle->sensors[i].T_vehicle_sensor); });
    };
    const int sensor = static_cast<int>(i);
    constants.push_back(angle("heading_deg", "heading", sensor, 3.0 * degree_rad, 2.0 * core::pi,
                              mounting([](core::Pose2& T) -> double& { return T.heading_rad; })));
    constants.push_back(length("x_m", sensor, arm_m, mounting([](core::Pose2& T) -> double& { return T.x_m; })));
    constants.push_back(length("y_m", sensor, arm_m, mounting([](core::Pose2& T) -> double& { return T.y_m; })));
    constants.push_back(length("range_offset_m", sensor, reach_m / 100.0, place([i](Settings& s) -> double& {
                                 return s.logs.vehicle->sensors[i].range_offset_m;
                               })));
  }
  // One for all, so that scans keep their order.
  constants.push_back(delay(-100.0, 100.0, [](Settings& s) {
    std::vector<double*> delays;
    for (logs::SensorModel& sensor : s.logs.vehicle->sensors) delays.push_back(&sensor.delay_s);
    return delays;
  }));
}

}  // namespace

double VehicleConstant::value(const Settings& settings) const {
  Settings copy = settings;
  return *places(copy).front();
}

void VehicleConstant::add(Settings& settings, double change) const {
  for (double* const number : places(settings)) *number += change;
}

std::vector<VehicleConstant> constants_of(const Settings& settings, logs::LogFormat format,
                                          const logs::Vehicle& vehicle, double reach_m) {
  using logs::LogFormat;
  if (format == LogFormat::own && settings.logs.vehicle && !vehicle.sensors.empty()) {
    std::vector<VehicleConstant> constants = of_own_odometry(vehicle.odometry.wheelbase_m.has_value());
    add_own_sensors(vehicle.sensors, reach_m, constants);
    return constants;
  }
  const bool described = vehicle.odometry.wheelbase_m && vehicle.sensors.size() == 1 &&
                         !vehicle.sensors.front().T_vehicle_sensor.vector().isZero(0.0);
  if (!described) return {};  // the shipped vehicle would supply what the file does not give
  const double arm_m = usual_arm_m(vehicle.sensors.front().T_vehicle_sensor, reach_m);
  if (format == LogFormat::acfr_ascii || format == LogFormat::victoria_park_mat) {
    return of_truck([](Settings& s) -> logs::AcfrSettings& { return s.logs.victoria_park; }, arm_m);
  }
  if (format == LogFormat::car_park_mat) {
    return of_truck([](Settings& s) -> logs::AcfrSettings& { return s.logs.car_park; }, arm_m);
  }
  return {};
}

}  // namespace helixnav::apps
