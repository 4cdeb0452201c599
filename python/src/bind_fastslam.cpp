// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <variant>
#include <vector>

#include "arrays.hpp"
#include "bind.hpp"
#include "configuration.hpp"
#include "gil.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/fastslam/fast_slam.hpp"
#include "helixnav/fastslam/observe.hpp"
#include "locked.hpp"
#include "log.hpp"
#include "map.hpp"

namespace helixnav::python {
namespace {

using fastslam::FastSlam;
using LockedSlam = Locked<FastSlam>;

fastslam::Options fitted(fastslam::Options options) {
  // What has a name is there.
  if (options.association == fastslam::Association::known) options.existence.remove = false;
  return options;
}

std::unique_ptr<LockedSlam> slam_of_options(const core::PoseGaussian& start, const py::dict& options) {
  const Configuration configuration = configuration_of(options, {}, {}, Filter::fastslam);
  refuse_unheeded(configuration, "FastSlam", true);
  const apps::FastSlamSettings& settings = configuration.settings.fastslam;
  return std::make_unique<LockedSlam>(FastSlam(start, fitted(settings.options), settings.seed));
}

std::unique_ptr<LockedSlam> slam_of_log(const Log& log) {
  return std::make_unique<LockedSlam>(FastSlam(log.recording.start, fitted(log.fastslam.options), log.fastslam.seed));
}

void move_slam(LockedSlam& self, const core::Odometry& odometry) {
  const std::lock_guard hold(self.mutex);
  self.navigator.predict(odometry);
}

core::StepReport observe_slam(LockedSlam& self, const core::Scan& scan, const py::object& identities) {
  std::optional<std::vector<std::int64_t>> names;
  if (!identities.is_none()) names = identities_from(identities);
  const WithoutGil released;
  const std::lock_guard hold(self.mutex);
  return names ? fastslam::observe_known(self.navigator, scan, *names) : fastslam::observe(self.navigator, scan);
}

std::optional<core::StepReport> take_slam(LockedSlam& self, const core::Event& event, const py::object& identities) {
  if (const auto* scan = std::get_if<core::Scan>(&event)) return observe_slam(self, *scan, identities);
  const auto* odometry = std::get_if<core::Odometry>(&event);
  if (odometry == nullptr) throw core::PreconditionError("FastSlam takes Odometry and Scan alone");
  const WithoutGil released;
  move_slam(self, *odometry);
  return std::nullopt;
}

std::vector<core::Pose2> poses_of(LockedSlam& self) {
  const std::lock_guard hold(self.mutex);
  return self.navigator.poses();
}

py::array_t<double> particles_of(LockedSlam& self) {
  std::vector<core::Pose2> poses;
  {
    const WithoutGil released;
    poses = poses_of(self);
  }
  py::array_t<double> rows({static_cast<py::ssize_t>(poses.size()), py::ssize_t{3}});
  double* to = rows.mutable_data();
  for (const core::Pose2& pose : poses) {
    for (const double number : {pose.x_m, pose.y_m, pose.heading_rad}) *to++ = number;
  }
  return rows;
}

py::array_t<double> weights_of(LockedSlam& self) {
  std::vector<double> weights;
  {
    const WithoutGil released;
    weights = locked(&FastSlam::weights)(self);
  }
  return py::array_t<double>(static_cast<py::ssize_t>(weights.size()), weights.data());
}

core::PoseGaussian pose_of_slam(LockedSlam& self) {
  const std::lock_guard hold(self.mutex);
  return self.navigator.pose();
}

}  // namespace

void bind_fastslam(py::module_& module) {
  using Released = py::call_guard<WithoutGil>;
  py::class_<LockedSlam>(module, "FastSlam",
                         "FastSLAM 1.0 and 2.0: particles over the path, each with its own map. Meant for comparison: "
                         "its covariances forget what resampling lost. Fixes are not used.")
      .def(py::init(&slam_of_options), py::arg("start") = core::PoseGaussian(), py::arg("options") = py::dict(),
           "Options are the fastslam.* keys of a configuration file; with fastslam.association 'known', scans come "
           "with identities.")
      .def(py::init(&slam_of_log), py::arg("log"), "Uses the start and options of a log.")
      .def("move", &move_slam, py::arg("odometry"), Released(), "Accumulates motion.")
      .def("observe", &observe_slam, py::arg("scan"), py::arg("identities") = py::none(),
           "Processes one scan; a negative identity is not a landmark.")
      .def("take", &take_slam, py::arg("event"), py::arg("identities") = py::none(),
           "Takes odometry or a scan; returns the report of a scan, None for odometry.")
      .def_property_readonly("pose", py::cpp_function(&pose_of_slam, Released()),
                             "Mean and covariance of the particle cloud, moved by the odometry since the last scan (a "
                             "navigator's pose is as of the scan).")
      .def_property_readonly(
          "map", py::cpp_function([](LockedSlam& self) { return Map{locked(&FastSlam::map)(self)}; }, Released()),
          "Landmarks of the heaviest particle.")
      .def_property_readonly("particles", &particles_of, "(M, 3): x, y, heading at the last scan.")
      .def_property_readonly("weights", &weights_of, "(M,); they sum to 1.");
}

}  // namespace helixnav::python
