// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstddef>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "appearance.hpp"
#include "arrays.hpp"
#include "helixnav/core/check_event.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/events.hpp"
#include "helixnav/core/gaussian.hpp"
#include "scan.hpp"

namespace helixnav::python {
namespace {

using core::Pose2;
using Rows2 = Eigen::Matrix<double, Eigen::Dynamic, 2, Eigen::RowMajor>;

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

/// One observation of row z and covariance R, d×d.
core::Observation observation_of(core::ObservationKind kind, const double* z, const double* R) {
  const int d = core::dimension(kind);
  core::Observation observation;
  observation.kind = kind;
  observation.z = Eigen::Map<const Eigen::VectorXd>(z, d);
  observation.R = Eigen::Map<const Eigen::MatrixXd>(R, d, d).transpose();
  return observation;
}

/// z is N×d, R d×d for all or N×d×d; of a bearing or range alone, z may be N.
std::vector<core::Observation> observations_of(const std::string& word, const Array& z, const Array& R) {
  const core::ObservationKind kind = kind_of(word);
  const py::ssize_t d = core::dimension(kind);
  const bool rows = (z.ndim() == 2 && z.shape(1) == d) || (z.ndim() == 1 && (d == 1 || z.size() == 0));
  const py::ssize_t n = rows ? z.shape(0) : 0;
  const bool square = R.ndim() >= 2 && R.shape(R.ndim() - 1) == d && R.shape(R.ndim() - 2) == d;
  const bool shared = R.ndim() == 2;
  if (!rows || !square || !(shared || (R.ndim() == 3 && R.shape(0) == n))) {
    const std::string width = std::to_string(d);
    const std::string wide = width + ", " + width + ")";
    throw core::PreconditionError("scan of kind " + word + ": expected z of shape (N, " + width + ") and R of shape (" +
                                  wide + " or (N, " + wide + ", found " + shape_text(z) + " and " + shape_text(R));
  }
  std::vector<core::Observation> observations;
  for (py::ssize_t i = 0; i < n; ++i)
    observations.push_back(observation_of(kind, z.data() + i * d, R.data() + (shared ? 0 : i * d * d)));
  return observations;
}

/// NaN in the second column of a bearing or range.
Rows2 z_of(const core::Scan& scan) {
  Rows2 z(static_cast<Eigen::Index>(scan.observations.size()), 2);
  z.setConstant(std::numeric_limits<double>::quiet_NaN());
  for (Eigen::Index i = 0; i < z.rows(); ++i) {
    const core::ObsVector& row = scan.observations[static_cast<std::size_t>(i)].z;
    z.row(i).head(row.size()) = row.transpose();
  }
  return z;
}

/// NaN where a bearing or range has no second row.
py::array_t<double> R_of(const core::Scan& scan) {
  py::array_t<double> R({static_cast<py::ssize_t>(scan.observations.size()), py::ssize_t{2}, py::ssize_t{2}});
  std::fill_n(R.mutable_data(), R.size(), std::numeric_limits<double>::quiet_NaN());
  double* to = R.mutable_data();
  for (const core::Observation& observation : scan.observations) {
    Eigen::Map<Eigen::Matrix2d>(to).topLeftCorner(observation.R.rows(), observation.R.cols()) = observation.R;
    to += 4;
  }
  return R;
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
      [](Event& event, double t_s) { event.t_ns = time_from(t_s); }, "Time [s].");
}

void bind_view(py::module_& module) {
  py::class_<core::FieldOfView>(
      module, "FieldOfView", "The region in which a sensor sees landmarks, in metres and radians, counter-clockwise.")
      .def(py::init([](double max_range, double min_range, double min_bearing, double max_bearing, double reach) {
             return core::FieldOfView{min_range, max_range, min_bearing, max_bearing, reach};
           }),
           py::arg("max_range") = std::numeric_limits<double>::infinity(), py::arg("min_range") = 0.0,
           py::arg("min_bearing") = -core::pi, py::arg("max_bearing") = core::pi, py::arg("reach") = 0.0)
      .def_readwrite("max_range", &core::FieldOfView::max_range_m,
                     "Range up to which landmarks are reliably seen [m]; infinite: unknown.")
      .def_readwrite("min_range", &core::FieldOfView::min_range_m, "Least range at which landmarks are seen [m].")
      .def_readwrite("min_bearing", &core::FieldOfView::min_bearing_rad, "Right-hand limit, in the sensor frame [rad].")
      .def_readwrite("max_bearing", &core::FieldOfView::max_bearing_rad,
                     "Left-hand limit, in the sensor frame [rad]; a view from pi/2 to 3 pi/2 covers the rear.")
      .def_readwrite("reach", &core::FieldOfView::reach_m,
                     "Range up to which landmarks are seen at all [m]; 0: up to max_range.");
}

void bind_odometry(py::module_& module) {
  py::class_<core::Odometry> odometry(
      module, "Odometry",
      "Motion since the previous odometry, in the robot's frame before the motion, with its covariance.");
  odometry
      .def(py::init([](double t_s, const py::object& increment, const py::object& covariance) {
             const core::Odometry made{time_from(t_s), Pose2(vector3_from(increment, "increment")),
                                       matrix3_from(covariance, "covariance")};
             core::check(made);
             return made;
           }),
           py::arg("t"), py::arg("increment"), py::arg("covariance"),
           "t is the time at the end of the increment (x, y, heading) [m, m, rad]; covariance 3×3. PreconditionError "
           "for NaN or an invalid covariance.")
      .def_property_readonly(
          "increment", [](const core::Odometry& o) { return o.T_before_after.vector(); },
          "(3,): x, y, heading [m, m, rad].")
      .def_readonly("covariance", &core::Odometry::covariance, "(3, 3) of x, y, heading.");
  bind_times(odometry);
}

void bind_scan(py::module_& module) {
  py::class_<core::Scan> scan(module, "Scan", "What one sensor saw at one instant; seeing nothing is information too.");
  scan.def(
          py::init([](double t_s, const std::string& kind, const py::object& z, const py::object& R,
                      const py::object& mounting, const core::FieldOfView& view, const py::object& classes,
                      const py::object& sizes, const py::object& sigma_sizes, double class_error) {
            core::Scan made = scan_from(t_s, kind, z, R, mounting, view);
            tell_appearance(classes, sizes, sigma_sizes, class_error, made);
            core::check(made);
            return made;
          }),
          py::arg("t"), py::arg("kind"), py::arg("z"), py::arg("R"),
          py::arg("mounting") = py::make_tuple(0.0, 0.0, 0.0), py::arg("view") = core::FieldOfView(),
          py::arg("classes") = py::none(), py::arg("sizes") = py::none(), py::arg("sigma_sizes") = 0.0,
          py::arg("class_error") = core::Appearance().class_error,
          "kind: 'range_bearing', 'cartesian', 'bearing' or 'range'; z (N, d) in metres and radians, R (d, d) or (N, "
          "d, d); mounting (x, y, heading) of the sensor on the robot. If the detector classifies or measures objects: "
          "classes, each None or a name of at most 23 bytes that is wrong with probability class_error; sizes [m], NaN "
          "where unknown, with standard deviations sigma_sizes. PreconditionError for values that no sensor measures.")
      .def_property_readonly("classes", &classes_of, "'' where none is given.")
      .def_property_readonly(
          "sizes", [](const core::Scan& s) { return sizes_of(s, &core::Appearance::size_m); },
          "(N,) [m]; NaN where none is given.")
      .def_property_readonly(
          "sigma_sizes", [](const core::Scan& s) { return sizes_of(s, &core::Appearance::sigma_size_m); }, "(N,) [m].")
      .def_property_readonly("z", &z_of, "(N, 2); NaN in the second column of a bearing or range alone.")
      .def_property_readonly("R", &R_of, "(N, 2, 2); NaN in the second row and column of a bearing or range alone.")
      .def_property_readonly("kinds", &kinds_of, "The kind of each observation, as in the argument kind.")
      .def_property_readonly(
          "mounting", [](const core::Scan& s) { return s.T_robot_sensor.vector(); },
          "(3,): x, y, heading of the sensor on the robot [m, m, rad].")
      .def_readonly("view", &core::Scan::field_of_view, "The FieldOfView.")
      .def("__len__", [](const core::Scan& s) { return s.observations.size(); });
  bind_times(scan);
}

void bind_fix(py::module_& module) {
  py::class_<core::AbsoluteFix> fix(module, "AbsoluteFix", "An absolute position in the map frame, e.g. from GPS.");
  fix.def(py::init([](double t_s, const py::object& position, const py::object& covariance, const py::object& antenna) {
            const core::AbsoluteFix made{time_from(t_s), vector2_from(position, "position"),
                                         matrix2_from(covariance, "covariance"), vector2_from(antenna, "antenna")};
            core::check(made);
            return made;
          }),
          py::arg("t"), py::arg("position"), py::arg("covariance"), py::arg("antenna") = py::make_tuple(0.0, 0.0),
          "position is that of the antenna, antenna where it is mounted on the robot; covariance 2×2.")
      .def_readonly("position", &core::AbsoluteFix::position_world_m, "(2,): the antenna in the map frame [m].")
      .def_readonly("covariance", &core::AbsoluteFix::covariance_m2, "(2, 2) [m²].")
      .def_readonly("antenna", &core::AbsoluteFix::antenna_robot_m, "(2,): where it is mounted on the robot [m].");
  bind_times(fix);
}

void bind_lost(py::module_& module) {
  py::class_<core::Lost> lost(
      module, "Lost", "The vehicle was moved by something other than its wheels, and the motion was not measured.");
  lost.def(py::init([](double t_s) { return core::Lost{time_from(t_s)}; }), py::arg("t"));
  bind_times(lost);
}

core::PoseGaussian make_pose(const py::object& mean, const py::object& covariance) {
  core::PoseGaussian pose;
  pose.mean = Pose2(vector3_from(mean, "mean"));
  if (!covariance.is_none()) pose.covariance = matrix3_from(covariance, "covariance");
  core::check_start(pose);
  return pose;
}

void bind_pose(py::module_& module) {
  py::class_<core::PoseGaussian>(module, "Pose", "A pose (x, y, heading) [m, m, rad] with its covariance.")
      .def(py::init(&make_pose), py::arg("mean") = py::make_tuple(0.0, 0.0, 0.0), py::arg("covariance") = py::none(),
           "Covariance 3×3, zero by default. PreconditionError for NaN or an invalid covariance.")
      .def_property_readonly(
          "mean", [](const core::PoseGaussian& pose) { return pose.mean.vector(); }, "(3,): x, y, heading [m, m, rad].")
      .def_readonly("covariance", &core::PoseGaussian::covariance, "(3, 3) of x, y, heading.")
      .def_property_readonly(
          "x", [](const core::PoseGaussian& pose) { return pose.mean.x_m; }, "[m]")
      .def_property_readonly(
          "y", [](const core::PoseGaussian& pose) { return pose.mean.y_m; }, "[m]")
      .def_property_readonly(
          "heading", [](const core::PoseGaussian& pose) { return pose.mean.heading_rad; },
          "[rad], counter-clockwise from x.")
      .def("__repr__", [](const core::PoseGaussian& pose) {
        std::ostringstream text;
        text << "Pose(x=" << pose.mean.x_m << ", y=" << pose.mean.y_m << ", heading=" << pose.mean.heading_rad << ")";
        return text.str();
      });
}

}  // namespace

core::Scan scan_from(double t_s, const std::string& kind, const py::object& z, const py::object& R,
                     const py::object& mounting, const core::FieldOfView& view) {
  core::Scan scan;
  scan.t_ns = time_from(t_s);
  scan.T_robot_sensor = Pose2(vector3_from(mounting, "mounting"));
  scan.field_of_view = view;
  scan.observations = observations_of(kind, numbers_from(z, "z"), numbers_from(R, "R"));
  core::check(scan);
  return scan;
}

void bind_events(py::module_& module) {
  bind_pose(module);
  bind_view(module);
  bind_odometry(module);
  bind_scan(module);
  bind_fix(module);
  bind_lost(module);
}

}  // namespace helixnav::python
