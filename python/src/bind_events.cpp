// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <limits>
#include <sstream>
#include <string>

#include "bind.hpp"
#include "helixnav/core/check_event.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"

namespace helixnav::python {
namespace {

using core::Pose2;
using Matrix = py::array_t<double, py::array::c_style | py::array::forcecast>;

core::ObservationKind kind_of(const std::string& word) {
  using core::ObservationKind;
  if (word == "range_bearing") return ObservationKind::range_bearing;
  if (word == "cartesian") return ObservationKind::cartesian;
  if (word == "bearing") return ObservationKind::bearing;
  if (word == "range") return ObservationKind::range;
  throw core::PreconditionError("kind: expected range_bearing, cartesian, bearing or range, found '" + word + "'");
}

const char* word_of(core::ObservationKind kind) {
  constexpr const char* words[] = {"range_bearing", "cartesian", "bearing", "range"};
  return words[static_cast<std::size_t>(kind)];
}

Pose2 pose_of(const Eigen::Vector3d& v) { return Pose2(v); }

/// z is N×d, R d×d for all or N×d×d.
std::vector<core::Observation> observations_of(const std::string& word, const Matrix& z, const Matrix& R) {
  const core::ObservationKind kind = kind_of(word);
  const py::ssize_t d = core::dimension(kind);
  const py::ssize_t n = z.ndim() == 2 ? z.shape(0) : z.size() / d;
  const bool shared = R.ndim() == 2 && R.shape(0) == d && R.shape(1) == d;
  const bool each = R.ndim() == 3 && R.shape(0) == n && R.shape(1) == d && R.shape(2) == d;
  const bool rows = (z.ndim() == 2 && z.shape(1) == d) || (z.ndim() == 1 && (d == 1 || z.size() == 0));
  if (!rows || !(shared || each)) {
    throw core::PreconditionError("scan: expected z of shape (N, " + std::to_string(d) + ") and R of shape (" +
                                  std::to_string(d) + ", " + std::to_string(d) + ") or (N, " + std::to_string(d) +
                                  ", " + std::to_string(d) + ")");
  }
  std::vector<core::Observation> observations(static_cast<std::size_t>(n));
  for (py::ssize_t i = 0; i < n; ++i) {
    core::Observation& observation = observations[static_cast<std::size_t>(i)];
    observation.kind = kind;
    observation.z.resize(d);
    observation.R.resize(d, d);
    for (py::ssize_t r = 0; r < d; ++r) {
      observation.z[r] = z.data()[i * d + r];
      for (py::ssize_t c = 0; c < d; ++c) observation.R(r, c) = R.data()[(shared ? 0 : i * d * d) + r * d + c];
    }
  }
  return observations;
}

core::Scan make_scan(double t_s, const std::string& kind, const Matrix& z, const Matrix& R,
                     const Eigen::Vector3d& mounting, const core::FieldOfView& view) {
  core::Scan scan;
  scan.t_ns = core::nanoseconds_from_seconds(t_s);
  scan.T_robot_sensor = pose_of(mounting);
  scan.field_of_view = view;
  scan.observations = observations_of(kind, z, R);
  core::check(scan);
  return scan;
}

/// Of the first two rows of what was measured; NaN where there is one.
Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> z_of(const core::Scan& scan) {
  Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor> z(static_cast<Eigen::Index>(scan.observations.size()), 2);
  z.setConstant(std::numeric_limits<double>::quiet_NaN());
  for (Eigen::Index i = 0; i < z.rows(); ++i) {
    const core::ObsVector& row = scan.observations[static_cast<std::size_t>(i)].z;
    z.row(i).head(row.size()) = row.transpose();
  }
  return z;
}

std::vector<std::string> kinds_of(const core::Scan& scan) {
  std::vector<std::string> kinds;
  for (const core::Observation& observation : scan.observations) kinds.emplace_back(word_of(observation.kind));
  return kinds;
}

template <class Event>
void bind_times(py::class_<Event>& type) {
  type.def_readwrite("t_ns", &Event::t_ns, "Time [ns].");
  type.def_property(
      "t", [](const Event& event) { return core::seconds(event.t_ns); },
      [](Event& event, double t_s) { event.t_ns = core::nanoseconds_from_seconds(t_s); }, "Time [s].");
}

void bind_view(py::module_& module) {
  py::class_<core::FieldOfView>(module, "FieldOfView",
                                "Where a sensor sees landmarks: metres, radians, counter-clockwise.")
      .def(py::init([](double max_range, double min_range, double min_bearing, double max_bearing, double reach) {
             return core::FieldOfView{min_range, max_range, min_bearing, max_bearing, reach};
           }),
           py::arg("max_range") = std::numeric_limits<double>::infinity(), py::arg("min_range") = 0.0,
           py::arg("min_bearing") = -core::pi, py::arg("max_bearing") = core::pi, py::arg("reach") = 0.0)
      .def_readwrite("max_range", &core::FieldOfView::max_range_m)
      .def_readwrite("min_range", &core::FieldOfView::min_range_m)
      .def_readwrite("min_bearing", &core::FieldOfView::min_bearing_rad)
      .def_readwrite("max_bearing", &core::FieldOfView::max_bearing_rad)
      .def_readwrite("reach", &core::FieldOfView::reach_m);
}

void bind_odometry(py::module_& module) {
  py::class_<core::Odometry> odometry(
      module, "Odometry",
      "Motion since the odometry before, in the frame of the robot before it moved, with its covariance.");
  odometry
      .def(py::init([](double t_s, const Eigen::Vector3d& increment, const Eigen::Matrix3d& covariance) {
             const core::Odometry made{core::nanoseconds_from_seconds(t_s), pose_of(increment), covariance};
             core::check(made);
             return made;
           }),
           py::arg("t"), py::arg("increment"), py::arg("covariance"),
           "At the end of the increment (x, y, heading) [m, m, rad]; covariance 3×3. PreconditionError for NaN or no "
           "covariance.")
      .def_property_readonly("increment", [](const core::Odometry& o) { return o.T_before_after.vector(); })
      .def_readonly("covariance", &core::Odometry::covariance);
  bind_times(odometry);
}

void bind_scan(py::module_& module) {
  py::class_<core::Scan> scan(module, "Scan", "What one sensor saw at one instant; nothing seen is information, too.");
  scan.def(py::init(&make_scan), py::arg("t"), py::arg("kind"), py::arg("z"), py::arg("R"),
           py::arg("mounting") = Eigen::Vector3d(0, 0, 0), py::arg("view") = core::FieldOfView(),
           "kind: 'range_bearing', 'cartesian', 'bearing' or 'range'; z (N, d) in metres and radians, R (d, d) or (N, "
           "d, d); "
           "mounting (x, y, heading) of the sensor on the robot. PreconditionError for what no sensor measures.")
      .def_property_readonly("z", &z_of, "(N, 2); NaN in the second column of a bearing or range alone.")
      .def_property_readonly("kinds", &kinds_of)
      .def_property_readonly("mounting", [](const core::Scan& s) { return s.T_robot_sensor.vector(); })
      .def_readonly("view", &core::Scan::field_of_view)
      .def("__len__", [](const core::Scan& s) { return s.observations.size(); });
  bind_times(scan);
}

void bind_fix(py::module_& module) {
  py::class_<core::AbsoluteFix> fix(module, "AbsoluteFix", "An absolute position in the map frame, as by GPS.");
  fix.def(py::init([](double t_s, const Eigen::Vector2d& position, const Eigen::Matrix2d& covariance,
                      const Eigen::Vector2d& antenna) {
            const core::AbsoluteFix made{core::nanoseconds_from_seconds(t_s), position, covariance, antenna};
            core::check(made);
            return made;
          }),
          py::arg("t"), py::arg("position"), py::arg("covariance"), py::arg("antenna") = Eigen::Vector2d(0, 0),
          "Of the antenna, which stands there on the robot; covariance 2×2.")
      .def_readonly("position", &core::AbsoluteFix::position_world_m)
      .def_readonly("covariance", &core::AbsoluteFix::covariance_m2)
      .def_readonly("antenna", &core::AbsoluteFix::antenna_robot_m);
  bind_times(fix);
}

void bind_pose(py::module_& module) {
  py::class_<core::PoseGaussian>(module, "Pose", "A pose (x, y, heading) [m, m, rad] with its covariance.")
      .def(py::init([](const Eigen::Vector3d& mean, const Eigen::Matrix3d& covariance) {
             return core::PoseGaussian{pose_of(mean), covariance};
           }),
           py::arg("mean") = Eigen::Vector3d(0, 0, 0), py::arg("covariance") = Eigen::Matrix3d(Eigen::Matrix3d::Zero()))
      .def_property_readonly("mean", [](const core::PoseGaussian& pose) { return pose.mean.vector(); })
      .def_readonly("covariance", &core::PoseGaussian::covariance)
      .def_property_readonly("x", [](const core::PoseGaussian& pose) { return pose.mean.x_m; })
      .def_property_readonly("y", [](const core::PoseGaussian& pose) { return pose.mean.y_m; })
      .def_property_readonly("heading", [](const core::PoseGaussian& pose) { return pose.mean.heading_rad; })
      .def("__repr__", [](const core::PoseGaussian& pose) {
        std::ostringstream text;
        text << "Pose(x=" << pose.mean.x_m << ", y=" << pose.mean.y_m << ", heading=" << pose.mean.heading_rad << ")";
        return text.str();
      });
}

}  // namespace

void bind_events(py::module_& module) {
  bind_pose(module);
  bind_view(module);
  bind_odometry(module);
  bind_scan(module);
  bind_fix(module);
}

}  // namespace helixnav::python
