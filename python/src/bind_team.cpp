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
      .def_readonly("seen", &RobotSighting::seen, "Index of the robot seen.")
      .def_property_readonly(
          "z", [](const RobotSighting& s) { return Eigen::Vector2d(s.observation.z); },
          "(2,): range and bearing [m, rad], or x and y [m], in the sensor frame.")
      .def_property_readonly(
          "R", [](const RobotSighting& s) { return Eigen::Matrix2d(s.observation.R); }, "(2, 2): covariance of z.");
  py::class_<JudgedSighting>(module, "JudgedSighting", "A sighting of one robot by another, and its outcome.")
      .def_property_readonly(
          "t", [](const JudgedSighting& s) { return core::seconds(s.t_ns); }, "Time [s].")
      .def_readonly("robot", &JudgedSighting::robot, "Index of the robot that saw.")
      .def_readonly("seen", &JudgedSighting::seen, "Index of the robot that was seen.")
      .def_readonly("used", &JudgedSighting::used, "Whether it is used in the solution.")
      .def_readonly("residual", &JudgedSighting::residual,
                    "Residual against the last solution; None between robots without a common frame.");
}

void bind_joins(py::module_& module) {
  py::class_<TeamJoin>(module, "TeamJoin", "A join of two components of a team.")
      .def_property_readonly(
          "by", [](const TeamJoin& j) { return team::name_of(j.by); }, "'names', 'sightings' or 'constellation'.")
      .def_property_readonly(
          "t", [](const TeamJoin& j) { return core::seconds(j.t_ns); }, "Time [s].")
      .def_readonly("robot", &TeamJoin::robot, "First robot of the component that kept its frame.")
      .def_readonly("other", &TeamJoin::other, "First robot of the component that joined it.")
      .def_property_readonly(
          "transform", [](const TeamJoin& j) { return j.T_component_other.vector(); },
          "(x, y, heading): frame of the component that joined, in the frame that was kept.")
      .def_readonly("merged", &TeamJoin::merged, "Number of landmarks that both had and that were merged.")
      .def_readonly("left_out", &TeamJoin::left_out, "Number of names common to both that contradict the others.")
      .def_readonly("sightings", &TeamJoin::sightings,
                    "Number of sightings of robots by each other, if these made the join.")
      .def_readonly("cost", &TeamJoin::cost, "Chi-squared of the join.")
      .def_readonly("dof", &TeamJoin::dof, "Its degrees of freedom.")
      .def_readonly("limit", &TeamJoin::limit, "Limit that the cost had to stay below.");
  py::class_<TakenBackJoin>(module, "TakenBackJoin",
                            "A join that later sightings contradicted, or that was taken back by hand.")
      .def_readonly("join", &TakenBackJoin::join, "The TeamJoin.")
      .def_property_readonly(
          "t", [](const TakenBackJoin& one) { return core::seconds(one.t_ns); }, "When it was taken back [s].")
      .def_readonly("refused", &TakenBackJoin::refused,
                    "Number of refused sightings between its two sides since the join.")
      .def_readonly("seen", &TakenBackJoin::seen, "Out of this many; 0: taken back by hand.");
}

void bind_same_landmarks(py::module_& module) {
  py::class_<SameLandmarks>(module, "SameLandmarks", "Two landmarks of a team merged by their position.")
      .def_property_readonly(
          "t", [](const SameLandmarks& s) { return core::seconds(s.t_ns); }, "Time [s].")
      .def_readonly("kept", &SameLandmarks::kept, "Id that was kept.")
      .def_readonly("removed", &SameLandmarks::removed, "Id that was removed.")
      .def_readonly("nats", &SameLandmarks::nats,
                    "ln of the likelihood ratio against a different landmark standing there.")
      .def_readonly("cost", &SameLandmarks::cost, "Chi-squared of the two as one.")
      .def_readonly("dof", &SameLandmarks::dof, "Its degrees of freedom.")
      .def_readonly("limit", &SameLandmarks::limit, "Limit that the cost had to stay below.");
}

}  // namespace

void bind_team(py::module_& module) {
  using Released = py::call_guard<WithoutGil>;
  bind_sightings(module);
  bind_joins(module);
  bind_same_landmarks(module);
  py::class_<LockedTeam>(module, "Team",
                         "Several robots in one map; a robot with an unknown start is a separate component until "
                         "something joins it. Robots are given by index.")
      .def(py::init(&make_team), py::arg("starts"), py::arg("by_names") = true, py::arg("by_sightings") = true,
           py::arg("by_constellation") = false, py::arg("by_place") = false, py::arg("looks_as_one") = 1.0,
           "starts: a Pose for each robot, None if unknown. With by_names, a name means the same landmark to all "
           "robots, otherwise only to its own robot; with by_place, landmarks in the same place are merged. "
           "looks_as_one (1 or more): this many consecutive looks carry as much information as one, and landmarks in "
           "scans without names are told apart using the noise of a single look.")
      .def("take", &take_of_robot, py::arg("robot"), py::arg("event"), py::arg("names") = py::tuple(),
           "Takes odometry, or a scan with a name for each observation (negative for none); a scan without names is "
           "associated by place. Returns the report of a scan; None for odometry and for a scan that came late. "
           "Without odometry a robot is taken to stand still: the report of a scan that arrives before it is wrong "
           "until then. "
           "PreconditionError for AbsoluteFix and Lost.")
      .def("sight", locked(&Team::sight), py::arg("robot"), py::arg("sighting"), Released(),
           "`robot` sees another robot.")
      .def("solve", locked(&Team::solve), Released(), "Solves the graph with everything received so far.")
      .def("pose", of_robot(&Team::pose), py::arg("robot"), Released(),
           "Pose after the last event, in its component's frame.")
      .def("component", of_robot(&Team::component), py::arg("robot"), Released(),
           "Index of the component's first robot.")
      .def("map", &map_of_robot, py::arg("robot"), Released(), "Landmarks of the robot's component.")
      .def("path", &path_of_robot, py::arg("robot"),
           "(N, 4): t, x, y, heading where it saw something or was seen, as known at the last solution.")
      .def("landmark_of", &landmark_of_robot, py::arg("robot"), py::arg("name"), Released(),
           "Id of the landmark that a name refers to for the robot; None if the robot has not seen it.")
      .def_property_readonly("joins", py::cpp_function(&joins_of, Released()), "TeamJoins so far.")
      .def_property_readonly("joins_taken_back", py::cpp_function(&joins_taken_back_of, Released()),
                             "TakenBackJoins: joins that held for a while and are no longer in joins.")
      .def_property_readonly("sightings", py::cpp_function(locked(&Team::sightings), Released()), "JudgedSightings.")
      .def("remove_join", locked(&Team::remove_join), py::arg("join"), Released(),
           "Takes back a join, by its index, and everything that followed from it.")
      .def_property_readonly("same_landmarks", py::cpp_function(&same_landmarks_of, Released()),
                             "SameLandmarks so far, from by_place.")
      .def("remove_same", locked(&Team::remove_same), py::arg("same"), Released(),
           "Separates two merged landmarks again, by index, and undoes everything that followed from the merge.");
}

}  // namespace helixnav::python
