// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "bind.hpp"
#include "gil.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/robot_sighting.hpp"
#include "helixnav/team/team.hpp"
#include "locked.hpp"
#include "map.hpp"
#include "scan.hpp"

namespace helixnav::python {
namespace {

using team::JudgedSighting;
using team::SameLandmarks;
using team::TakenBackJoin;
using team::Team;
using team::TeamJoin;
using LockedTeam = Locked<Team>;

core::RobotSighting make_sighting(double t_s, int seen, const std::string& kind, const py::object& z,
                                  const py::object& R, const py::object& mounting) {
  const py::object row = py::module_::import("numpy").attr("atleast_2d")(numbers_from(z, "z"));
  const core::Scan scan = scan_from(t_s, kind, row, R, mounting, {});
  if (scan.observations.size() != 1 || core::dimension(scan.observations.front().kind) != 2) {
    throw core::PreconditionError("sighting: expected one range and bearing, or one point");
  }
  return {scan.t_ns, seen, scan.T_robot_sensor, scan.observations.front()};
}

std::unique_ptr<LockedTeam> make_team(const std::vector<std::optional<core::PoseGaussian>>& starts, bool by_names,
                                      bool by_sightings, bool by_constellation, bool by_place, double looks_as_one) {
  team::TeamOptions options;
  options.join.by_names = by_names;
  options.join.by_sightings = by_sightings;
  options.join.by_constellation = by_constellation;
  options.join.by_place = by_place;
  options.looks_as_one = looks_as_one;
  return std::make_unique<LockedTeam>(Team(starts, options));
}

std::optional<core::StepReport> take_of_robot(LockedTeam& self, int robot, const core::Event& event,
                                              const py::object& identities) {
  const std::vector<std::int64_t> names = identities_from(identities);
  const WithoutGil released;
  const std::lock_guard hold(self.mutex);
  return self.navigator.take(robot, event, names);
}

/// A method of a robot's that changes nothing.
template <class Result>
auto of_robot(Result (Team::*method)(int) const) {
  return [method](LockedTeam& self, int robot) -> Result {
    const std::lock_guard hold(self.mutex);
    return (self.navigator.*method)(robot);
  };
}

Map map_of_robot(LockedTeam& self, int robot) { return {of_robot(&Team::map)(self, robot)}; }

py::array_t<double> path_of_robot(LockedTeam& self, int robot) {
  std::vector<core::StampedPose> path;
  {
    const WithoutGil released;
    path = of_robot(&Team::path)(self, robot);
  }
  py::array_t<double> rows({static_cast<py::ssize_t>(path.size()), py::ssize_t{4}});
  double* to = rows.mutable_data();
  for (const core::StampedPose& at : path) {
    *to++ = core::seconds(at.t_ns);
    for (const double number : {at.T_world_robot.x_m, at.T_world_robot.y_m, at.T_world_robot.heading_rad})
      *to++ = number;
  }
  return rows;
}

std::optional<core::LandmarkId> landmark_of_robot(LockedTeam& self, int robot, std::int64_t name) {
  const std::lock_guard hold(self.mutex);
  const core::LandmarkId id = self.navigator.landmark_of(robot, name);
  if (id == core::no_landmark) return std::nullopt;
  return id;
}

std::vector<TeamJoin> joins_of(LockedTeam& self) {
  const std::lock_guard hold(self.mutex);
  return self.navigator.joins();
}

std::vector<TakenBackJoin> joins_taken_back_of(LockedTeam& self) {
  const std::lock_guard hold(self.mutex);
  return self.navigator.joins_taken_back();
}

std::vector<SameLandmarks> same_landmarks_of(LockedTeam& self) {
  const std::lock_guard hold(self.mutex);
  return self.navigator.same_landmarks();
}

void bind_sightings(py::module_& module) {
  using core::RobotSighting;
  py::class_<RobotSighting>(module, "RobotSighting", "One robot of a team sees the reference point of another.")
      .def(py::init(&make_sighting), py::arg("t"), py::arg("seen"), py::arg("kind"), py::arg("z"), py::arg("R"),
           py::arg("mounting") = py::make_tuple(0.0, 0.0, 0.0),
           "seen: index of the robot in the team; kind 'range_bearing' or 'cartesian'; z (2,), R (2, 2).")
      .def_property_readonly(
          "t", [](const RobotSighting& s) { return core::seconds(s.t_ns); }, "Time [s].")
      .def_readonly("t_ns", &RobotSighting::t_ns, "Time [ns].")
      .def_readonly("seen", &RobotSighting::seen, "Index of the robot that is seen.")
      .def_property_readonly(
          "z", [](const RobotSighting& s) { return Eigen::Vector2d(s.observation.z); },
          "(2,): range and bearing [m, rad], or x and y [m], in the frame of the sensor.")
      .def_property_readonly(
          "R", [](const RobotSighting& s) { return Eigen::Matrix2d(s.observation.R); }, "(2, 2): covariance of z.");
  py::class_<JudgedSighting>(module, "JudgedSighting", "A robot that was seen, and what came of it.")
      .def_property_readonly(
          "t", [](const JudgedSighting& s) { return core::seconds(s.t_ns); }, "Time [s].")
      .def_readonly("robot", &JudgedSighting::robot, "Index of the one that saw.")
      .def_readonly("seen", &JudgedSighting::seen, "Index of the one that was seen.")
      .def_readonly("used", &JudgedSighting::used, "Whether it is in the solution.")
      .def_readonly("residual", &JudgedSighting::residual,
                    "Against the last solution; None between robots that have no common frame.");
}

void bind_joins(py::module_& module) {
  py::class_<TeamJoin>(module, "TeamJoin", "Two components of a team became one.")
      .def_property_readonly(
          "by", [](const TeamJoin& j) { return team::name_of(j.by); }, "'names', 'sightings' or 'constellation'.")
      .def_property_readonly(
          "t", [](const TeamJoin& j) { return core::seconds(j.t_ns); }, "Time [s].")
      .def_readonly("robot", &TeamJoin::robot, "First robot of the component that kept its frame.")
      .def_readonly("other", &TeamJoin::other, "First robot of the one that came into it.")
      .def_property_readonly(
          "transform", [](const TeamJoin& j) { return j.T_component_other.vector(); }, "(x, y, heading) of its frame.")
      .def_readonly("merged", &TeamJoin::merged, "Landmarks of the two that became one.")
      .def_readonly("left_out", &TeamJoin::left_out, "Names that both have and that contradict the others.")
      .def_readonly("sightings", &TeamJoin::sightings, "Of robots by each other, where these joined.")
      .def_readonly("cost", &TeamJoin::cost, "Chi squared of what joined.")
      .def_readonly("dof", &TeamJoin::dof, "Its degrees of freedom.")
      .def_readonly("limit", &TeamJoin::limit, "That the cost had to stay below.");
  py::class_<TakenBackJoin>(module, "TakenBackJoin",
                            "A join that sightings since then contradicted, or that was taken back by hand.")
      .def_readonly("join", &TakenBackJoin::join, "The TeamJoin.")
      .def_property_readonly(
          "t", [](const TakenBackJoin& one) { return core::seconds(one.t_ns); }, "When it was taken back [s].")
      .def_readonly("refused", &TakenBackJoin::refused, "Sightings between its two sides since then that were refused.")
      .def_readonly("seen", &TakenBackJoin::seen, "Of so many; 0: by hand.");
}

void bind_same_landmarks(py::module_& module) {
  py::class_<SameLandmarks>(module, "SameLandmarks", "Two landmarks of a team became one by where they stand.")
      .def_property_readonly(
          "t", [](const SameLandmarks& s) { return core::seconds(s.t_ns); }, "Time [s].")
      .def_readonly("kept", &SameLandmarks::kept, "Id that stays.")
      .def_readonly("removed", &SameLandmarks::removed, "Id that went.")
      .def_readonly("nats", &SameLandmarks::nats, "ln of the likelihood ratio against another one that stands there.")
      .def_readonly("cost", &SameLandmarks::cost, "Chi squared of the two as one.")
      .def_readonly("dof", &SameLandmarks::dof, "Its degrees of freedom.")
      .def_readonly("limit", &SameLandmarks::limit, "That the cost had to stay below.");
}

}  // namespace

void bind_team(py::module_& module) {
  using Released = py::call_guard<WithoutGil>;
  bind_sightings(module);
  bind_joins(module);
  bind_same_landmarks(module);
  py::class_<LockedTeam>(
      module, "Team",
      "Several robots in one map; a robot of unknown start is a component of its own until something "
      "joins it. Robots by their index.")
      .def(
          py::init(&make_team), py::arg("starts"), py::arg("by_names") = true, py::arg("by_sightings") = true,
          py::arg("by_constellation") = false, py::arg("by_place") = false, py::arg("looks_as_one") = 1.0,
          "A Pose for each robot, None where the start is unknown. With by_names a name means the same landmark to all "
          "robots, else to its own; with by_place landmarks of one place become one. looks_as_one: so many looks in a "
          "row say "
          "what one would (1 or more), and scans without names are told apart by the noise of one.")
      .def(
          "take", &take_of_robot, py::arg("robot"), py::arg("event"), py::arg("names") = py::tuple(),
          "Odometry, or a scan with a name for each observation, a negative one for none, or without names: associated "
          "by place. The report of a scan; None "
          "for odometry, and for a scan that came late. PreconditionError for AbsoluteFix and Lost.")
      .def("sight", locked(&Team::sight), py::arg("robot"), py::arg("sighting"), Released(),
           "`robot` sees another one.")
      .def("solve", locked(&Team::solve), Released(), "Solves the graph with all that has come.")
      .def("pose", of_robot(&Team::pose), py::arg("robot"), Released(),
           "After the last event, in its component's frame.")
      .def("component", of_robot(&Team::component), py::arg("robot"), Released(), "Index of its first robot.")
      .def("map", &map_of_robot, py::arg("robot"), Released(), "Landmarks of the robot's component.")
      .def("path", &path_of_robot, py::arg("robot"),
           "(N, 4): t, x, y, heading where it saw something or was seen, as known at the last solution.")
      .def("landmark_of", &landmark_of_robot, py::arg("robot"), py::arg("name"), Released(),
           "Id of the landmark that a name means to the robot; None where it has not seen it.")
      .def_property_readonly("joins", py::cpp_function(&joins_of, Released()), "TeamJoins so far.")
      .def_property_readonly("joins_taken_back", py::cpp_function(&joins_taken_back_of, Released()),
                             "TakenBackJoins: held for a while, and none of joins.")
      .def_property_readonly("sightings", py::cpp_function(locked(&Team::sightings), Released()), "JudgedSightings.")
      .def("remove_join", locked(&Team::remove_join), py::arg("join"), Released(),
           "Takes a join back, by its index, and everything that came of it.")
      .def_property_readonly("same_landmarks", py::cpp_function(&same_landmarks_of, Released()),
                             "SameLandmarks so far, of by_place.")
      .def("remove_same", locked(&Team::remove_same), py::arg("same"), Released(),
           "Makes two landmarks two again, by the index, with everything that came of their being one.");
}

}  // namespace helixnav::python
