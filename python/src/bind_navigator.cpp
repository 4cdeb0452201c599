// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "common/joint_map_of.hpp"
#include "configuration.hpp"
#include "gil.hpp"
#include "helixnav/core/decision_row.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/reports/decision_sentence.hpp"
#include "helixnav/runs/words.hpp"
#include "helixnav/supervisor/lengths.hpp"
#include "helixnav/supervisor/named_navigator.hpp"
#include "helixnav/supervisor/navigator.hpp"
#include "locked.hpp"
#include "log.hpp"
#include "map.hpp"

namespace helixnav::python {
namespace {

using supervisor::NamedNavigator;
using supervisor::Navigator;

/// Options without a log; the navigator fits its lengths to the sensor of the first scan, but for those given.
supervisor::NavigatorOptions options_of(const py::dict& options, const char* navigates, bool by_identities) {
  const Configuration configuration = configuration_of(options);
  refuse_unheeded(configuration, navigates, by_identities);
  supervisor::NavigatorOptions navigator = configuration.settings.navigator;
  for (const auto& [name, length_m] : configuration.settings.given_lengths_m) {
    supervisor::set_length(navigator, name, length_m);
  }
  if (configuration.settings.names_wrong) navigator.names.wrong = *configuration.settings.names_wrong;
  return navigator;
}

std::optional<std::int64_t> landmark_of(const core::AssociationReport& a) {
  if (a.landmark == core::no_landmark) return std::nullopt;
  return a.landmark;
}

py::dict numbers_of(const Decided& decided) {
  py::dict numbers;
  for (const auto& [name, value] : core::row_of(decided.decision).numbers) numbers[py::str(name)] = value;
  return numbers;
}

std::string words_of(const Decided& decided) {
  return decided.sentence.empty() ? reports::sentence_of(decided.decision) : decided.sentence;
}

void bind_report_parts(py::module_& module) {
  py::class_<core::AssociationReport>(module, "Association", "What became of one observation in a scan.")
      .def_readonly("observation", &core::AssociationReport::observation, "Index in the scan.")
      .def_property_readonly(
          "outcome", [](const core::AssociationReport& a) { return runs::word_of(runs::outcome_words, a.outcome); },
          "'matched', 'augmented', 'ambiguous' or 'rejected'")
      .def_property_readonly("landmark", &landmark_of, "Its id, or None.")
      .def_readonly("nis", &core::AssociationReport::nis,
                    "The innovation squared, normalised by its covariance; NaN without a landmark.")
      .def_readonly("dof", &core::AssociationReport::dof, "Degrees of freedom of nis.")
      .def_readonly("margin_nats", &core::AssociationReport::margin_nats,
                    "ln of the likelihood ratio against the best alternative.");
  py::class_<Decided>(module, "Decision", "A row of decisions.csv.")
      .def_property_readonly(
          "kind", [](const Decided& d) { return core::row_of(d.decision).kind; },
          "As in decisions.csv: closure, search, slip, fix …")
      .def_property_readonly(
          "verdict", [](const Decided& d) { return core::row_of(d.decision).verdict; },
          "As in decisions.csv: accepted, refused …")
      .def_property_readonly("numbers", &numbers_of, "Values by name with unit.")
      .def_property_readonly("sentence", &words_of, "The decision in words.")
      .def("__repr__", [](const Decided& d) { return "<Decision: " + words_of(d) + ">"; });
}

std::vector<Decided> decisions_of(const core::StepReport& report) {
  std::vector<Decided> decisions;
  for (const core::Decision& decision : report.decisions) decisions.push_back({decision});
  return decisions;
}

std::vector<std::pair<std::int64_t, std::int64_t>> merged_of(const core::StepReport& report) {
  std::vector<std::pair<std::int64_t, std::int64_t>> merged;
  for (const core::MergedLandmarks& merge : report.merged) merged.emplace_back(merge.kept, merge.removed);
  return merged;
}

std::vector<std::pair<std::int64_t, std::vector<core::AssociationReport>>> revised_of(const core::StepReport& report) {
  std::vector<std::pair<std::int64_t, std::vector<core::AssociationReport>>> revised;
  for (const core::RevisedScan& scan : report.revised) revised.emplace_back(scan.step, scan.associations);
  return revised;
}

void bind_report(py::module_& module) {
  py::class_<core::NumericalHealth>(module, "NumericalHealth", "How far a step's arithmetic was from its limits.")
      .def_readonly("least_pivot", &core::NumericalHealth::least_pivot,
                    "Least pivot of the innovation covariances, relative to their diagonals; 1 without an update.")
      .def_readonly("asymmetry", &core::NumericalHealth::asymmetry,
                    "Asymmetry of the innovation covariances, from rounding.")
      .def_readonly("repaired", &core::NumericalHealth::repaired,
                    "Operations that failed as requested and were done another way.")
      .def_readonly("refused", &core::NumericalHealth::refused, "Operations that failed and were not done.");
  py::class_<core::StepReport>(module, "StepReport", "What one scan did to the map and the pose.")
      .def_readonly("step", &core::StepReport::step, "Number of the scan, from 0.")
      .def_readonly("t_ns", &core::StepReport::t_ns, "Time of the scan [ns].")
      .def_property_readonly(
          "t", [](const core::StepReport& r) { return core::seconds(r.t_ns); }, "Time of the scan [s].")
      .def_property_readonly(
          "mode", [](const core::StepReport& r) { return runs::word_of(runs::mode_words, r.mode); },
          "'mapping' or 'searching'.")
      .def_readonly("pose", &core::StepReport::pose, "A Pose in the map frame, after the scan.")
      .def_readonly("associations", &core::StepReport::associations, "An Association for each observation.")
      .def_property_readonly("decisions", &decisions_of, "What was decided with this scan.")
      .def_property_readonly("merged", &merged_of, "(kept, removed) for landmarks that were merged.")
      .def_property_readonly(
          "revised", &revised_of,
          "(step, associations) of earlier scans that were reprocessed: these supersede their own reports.")
      .def_readonly("joint_nis", &core::StepReport::joint_nis, "NIS of all matched observations together.")
      .def_readonly("joint_dof", &core::StepReport::joint_dof, "Degrees of freedom of joint_nis; 0 without an update.")
      .def_readonly("numerics", &core::StepReport::numerics, "The NumericalHealth.")
      .def_readonly("landmarks", &core::StepReport::mapped_landmarks, "Number of landmarks on the map.");
}

using Released = py::call_guard<WithoutGil>;

template <class AnyNavigator>
std::unique_ptr<Locked<AnyNavigator>> of_log(const Log& log) {
  return std::make_unique<Locked<AnyNavigator>>(log.recording.start, log.navigator);
}

template <class AnyNavigator>
std::unique_ptr<Locked<AnyNavigator>> of_options(const core::PoseGaussian& start, const py::dict& options) {
  constexpr bool named = std::is_same_v<AnyNavigator, NamedNavigator>;
  return std::make_unique<Locked<AnyNavigator>>(start,
                                                options_of(options, named ? "NamedNavigator" : "Navigator", named));
}

/// One scan, by which the drive may be known later.
template <class AnyNavigator, class... Identities>
core::StepReport observe(Locked<AnyNavigator>& self, const core::Scan& scan, const Identities&... identities) {
  const std::lock_guard hold(self.mutex);
  core::StepReport report = self.navigator.observe(scan, identities...);
  self.drive.add(scan);
  return report;
}

template <class AnyNavigator, class... Identities>
std::optional<core::StepReport> take(Locked<AnyNavigator>& self, const core::Event& event,
                                     const Identities&... identities) {
  if (const auto* scan = std::get_if<core::Scan>(&event)) return observe(self, *scan, identities...);
  const std::lock_guard hold(self.mutex);
  return self.navigator.take(event, identities...);
}

core::StepReport observe_unnamed(Locked<Navigator>& self, const core::Scan& scan) { return observe(self, scan); }

std::optional<core::StepReport> take_unnamed(Locked<Navigator>& self, const core::Event& event) {
  return take(self, event);
}

core::StepReport observe_named(Locked<NamedNavigator>& self, const core::Scan& scan, const py::object& identities) {
  const std::vector<std::int64_t> names = identities_from(identities);
  const WithoutGil released;
  return observe(self, scan, names);
}

std::optional<core::StepReport> take_named(Locked<NamedNavigator>& self, const core::Event& event,
                                           const py::object& identities) {
  const std::vector<std::int64_t> names = identities_from(identities);
  const WithoutGil released;
  return take(self, event, names);
}

template <class AnyNavigator>
Map map_of(Locked<AnyNavigator>& self) {
  return {locked(&AnyNavigator::map)(self)};
}

/// Whether it is not known how its map lies to the earlier one.
bool is_apart(const Navigator& navigator) { return navigator.maps_apart().count(0) > 0; }
bool is_apart(const NamedNavigator&) { return false; }

template <class AnyNavigator>
std::vector<std::string> drives_of(const Locked<AnyNavigator>& self) {
  std::vector<std::string> drives;
  if (std::string own = self.drive.text(); !own.empty()) drives.push_back(std::move(own));
  if (self.earlier_drives.empty() || is_apart(self.navigator)) return drives;
  return runs::united_drives(std::move(drives), self.earlier_drives);
}

/// Of an earlier map that is still apart it is known what went into it.
std::map<int, core::JointMap> maps_apart(Locked<Navigator>& self) {
  const std::lock_guard hold(self.mutex);
  std::map<int, core::JointMap> maps = self.navigator.maps_apart();
  if (const auto earlier = maps.find(0); earlier != maps.end()) earlier->second.drives = self.earlier_drives;
  return maps;
}

/// To go on in; None where it is too large to be saved.
template <class AnyNavigator>
std::optional<core::JointMap> joint_map_of(Locked<AnyNavigator>& self, double reach_m) {
  constexpr double most_m = 1e5;  // that map.bin holds
  if (!(reach_m >= 0.0 && reach_m <= most_m)) {
    throw core::PreconditionError("reach: expected metres up to 1e5, 0 where it is unknown, found " +
                                  std::to_string(reach_m));
  }
  const std::lock_guard hold(self.mutex);
  std::optional<core::JointMap> map = apps::joint_map_of(self.navigator, reach_m);
  if (map) map->drives = drives_of(self);
  return map;
}

std::unique_ptr<Locked<Navigator>> go_on(const core::JointMap& earlier, const py::dict& options) {
  auto begun =
      std::make_unique<Locked<Navigator>>(Navigator::go_on_in(earlier, options_of(options, "Navigator", false)));
  begun->earlier_drives = earlier.drives;
  return begun;
}

std::unique_ptr<Locked<NamedNavigator>> go_on_named(const core::JointMap& earlier,
                                                    const std::map<std::int64_t, core::LandmarkId>& landmark_of,
                                                    const py::dict& options) {
  auto begun = std::make_unique<Locked<NamedNavigator>>(
      NamedNavigator(earlier, landmark_of, options_of(options, "NamedNavigator", true)));
  begun->earlier_drives = earlier.drives;
  return begun;
}

void look_for_place(Locked<Navigator>& self, const core::JointMap& earlier) {
  const std::lock_guard hold(self.mutex);
  self.navigator.look_for_place_in(earlier);
  self.earlier_drives = earlier.drives;
}

template <class AnyNavigator>
void bind_common(py::class_<Locked<AnyNavigator>>& type) {
  type.def(
          py::init(&of_options<AnyNavigator>), py::arg("start") = core::PoseGaussian(), py::arg("options") = py::dict(),
          "Options are keys and values as in a configuration file; lengths are fitted to the sensor of the first scan.")
      .def(py::init(&of_log<AnyNavigator>), py::arg("log"), "Uses the start and options of a log.")
      .def("move", locked(&AnyNavigator::move), py::arg("odometry"), Released(), "Accumulates motion.")
      .def("fix", locked(&AnyNavigator::fix), py::arg("fix"), Released(),
           "True if the fix passed its gate and was used.")
      .def_property_readonly("pose", py::cpp_function(locked(&AnyNavigator::pose), Released()),
                             "The pose at the last scan or fix.")
      .def_property_readonly("map", py::cpp_function(&map_of<AnyNavigator>, Released()), "The landmarks now.")
      .def("joint_map", &joint_map_of<AnyNavigator>, py::arg("reach") = 0.0, Released(),
           "The map with all correlations and the pose, for another session to continue in; None above 2000 landmarks "
           "if the drive was not kept. "
           "`reach` is the sensor's [m], 0 if unknown.");
}

}  // namespace

void bind_navigator(py::module_& module) {
  bind_report_parts(module);
  bind_report(module);
  py::class_<Locked<Navigator>> unnamed(module, "Navigator",
                                        "Navigates with unknown data association; searches for loops and closes them.");
  bind_common(unnamed);
  unnamed.def("observe", &observe_unnamed, py::arg("scan"), Released(), "Processes one scan.")
      .def("lose", locked(&Navigator::lose), py::arg("lost"), Released(),
           "The vehicle was carried: searches for its place in what has been mapped so far.")
      .def("take", &take_unnamed, py::arg("event"), Released(),
           "Takes any event; returns the report of a scan, None for others.")
      .def_static("go_on_in", &go_on, py::arg("earlier"), py::arg("options") = py::dict(),
                  "Continues in the JointMap of an earlier session, from its pose.")
      .def("look_for_place_in", &look_for_place, py::arg("earlier"), Released(),
           "For a session that begins somewhere on the JointMap, or elsewhere: maps on its own until its place is "
           "found, then continues in the frame of that map. Only before the first scan.")
      .def_property_readonly("maps_apart", py::cpp_function(&maps_apart, Released()),
                             "JointMaps whose pose relative to the present map is unknown, by part of the drive; 0: "
                             "the earlier map of look_for_place_in.");
  py::class_<Locked<NamedNavigator>> named(module, "NamedNavigator",
                                           "Navigates with observations whose identities are known.");
  bind_common(named);
  named
      .def("observe", &observe_named, py::arg("scan"), py::arg("identities"),
           "Processes one scan, with an identity for each observation; a negative one is not a landmark.")
      .def("take", &take_named, py::arg("event"), py::arg("identities") = py::tuple(),
           "Takes any event; returns the report of a scan, None for others.")
      .def_static("go_on_in", &go_on_named, py::arg("earlier"), py::arg("landmark_of"), py::arg("options") = py::dict(),
                  "Continues in the JointMap of an earlier session, from its pose; landmark_of maps identities to "
                  "landmarks of that map.");
}

}  // namespace helixnav::python
