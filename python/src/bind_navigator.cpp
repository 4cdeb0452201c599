// SPDX-License-Identifier: BSD-3-Clause
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "arrays.hpp"
#include "configuration.hpp"
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
supervisor::NavigatorOptions options_of(const py::dict& options) {
  const Configuration configuration = configuration_of(options);
  supervisor::NavigatorOptions navigator = configuration.settings.navigator;
  for (const auto& [name, length_m] : configuration.settings.given_lengths_m) {
    supervisor::set_length(navigator, name, length_m);
  }
  return navigator;
}

py::array_t<std::int64_t> ids_of(const Map& map) {
  py::array_t<std::int64_t> ids(static_cast<py::ssize_t>(map.landmarks.size()));
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) ids.mutable_data()[i] = map.landmarks[i].id;
  return ids;
}

py::array_t<double> means_of(const Map& map) {
  py::array_t<double> means({static_cast<py::ssize_t>(map.landmarks.size()), py::ssize_t{2}});
  double* to = means.mutable_data();
  for (const core::MapLandmark& landmark : map.landmarks) {
    *to++ = landmark.point.mean_m.x();
    *to++ = landmark.point.mean_m.y();
  }
  return means;
}

py::array_t<double> covariances_of(const Map& map) {
  py::array_t<double> covariances({static_cast<py::ssize_t>(map.landmarks.size()), py::ssize_t{2}, py::ssize_t{2}});
  double* to = covariances.mutable_data();
  for (const core::MapLandmark& landmark : map.landmarks) {
    for (const auto& [r, c] : {std::pair{0, 0}, std::pair{0, 1}, std::pair{1, 0}, std::pair{1, 1}})
      *to++ = landmark.point.covariance_m2(r, c);
  }
  return covariances;
}

py::array_t<std::int64_t> counts_of(const Map& map) {
  py::array_t<std::int64_t> counts(static_cast<py::ssize_t>(map.landmarks.size()));
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) counts.mutable_data()[i] = map.landmarks[i].observations;
  return counts;
}

std::vector<std::string> states_of(const Map& map) {
  std::vector<std::string> states;
  for (const core::MapLandmark& landmark : map.landmarks) {
    states.emplace_back(runs::word_of(runs::state_words, landmark.state));
  }
  return states;
}

void bind_map(py::module_& module) {
  py::class_<Map>(module, "Map", "Landmarks in order of id, as arrays.")
      .def_property_readonly("ids", &ids_of, "(N,)")
      .def_property_readonly("means", &means_of, "(N, 2) [m]")
      .def_property_readonly("covariances", &covariances_of, "(N, 2, 2) [m²]")
      .def_property_readonly("observations", &counts_of, "(N,)")
      .def_property_readonly("states", &states_of, "'tentative' or 'mature' each")
      .def("__len__", [](const Map& map) { return map.landmarks.size(); });
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

void bind_report_parts(py::module_& module) {
  py::class_<core::AssociationReport>(module, "Association", "What became of one observation of a scan.")
      .def_readonly("observation", &core::AssociationReport::observation)
      .def_property_readonly(
          "outcome", [](const core::AssociationReport& a) { return runs::word_of(runs::outcome_words, a.outcome); },
          "'matched', 'augmented', 'ambiguous' or 'rejected'")
      .def_property_readonly("landmark", &landmark_of, "Its id, or None.")
      .def_readonly("nis", &core::AssociationReport::nis)
      .def_readonly("dof", &core::AssociationReport::dof)
      .def_readonly("margin_nats", &core::AssociationReport::margin_nats);
  py::class_<Decided>(module, "Decision", "A row of decisions.csv.")
      .def_property_readonly("kind", [](const Decided& d) { return core::row_of(d.decision).kind; })
      .def_property_readonly("verdict", [](const Decided& d) { return core::row_of(d.decision).verdict; })
      .def_property_readonly("numbers", &numbers_of, "Name with unit: value.")
      .def_property_readonly("sentence", [](const Decided& d) { return reports::sentence_of(d.decision); })
      .def("__repr__", [](const Decided& d) { return "<Decision: " + reports::sentence_of(d.decision) + ">"; });
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
  py::class_<core::NumericalHealth>(module, "NumericalHealth", "How far the arithmetic of a step was from its limits.")
      .def_readonly("least_pivot", &core::NumericalHealth::least_pivot,
                    "Of the innovation covariances, by their diagonals; 1 without an update.")
      .def_readonly("asymmetry", &core::NumericalHealth::asymmetry, "Of the same, by rounding.")
      .def_readonly("repaired", &core::NumericalHealth::repaired, "Failed as asked, done in another way.")
      .def_readonly("refused", &core::NumericalHealth::refused, "Failed and left undone.");
  py::class_<core::StepReport>(module, "StepReport", "What one scan did to the map and the pose.")
      .def_readonly("step", &core::StepReport::step)
      .def_readonly("t_ns", &core::StepReport::t_ns)
      .def_property_readonly("t", [](const core::StepReport& r) { return core::seconds(r.t_ns); })
      .def_property_readonly("mode", [](const core::StepReport& r) { return runs::word_of(runs::mode_words, r.mode); })
      .def_readonly("pose", &core::StepReport::pose)
      .def_readonly("associations", &core::StepReport::associations)
      .def_property_readonly("decisions", &decisions_of)
      .def_property_readonly("merged", &merged_of, "(kept, removed) of landmarks that became one.")
      .def_property_readonly("revised", &revised_of,
                             "(step, associations) of earlier scans gone through again: these hold, not what their own "
                             "reports say.")
      .def_readonly("joint_nis", &core::StepReport::joint_nis)
      .def_readonly("joint_dof", &core::StepReport::joint_dof)
      .def_readonly("numerics", &core::StepReport::numerics)
      .def_readonly("landmarks", &core::StepReport::mapped_landmarks);
}

using Released = py::call_guard<py::gil_scoped_release>;

template <class AnyNavigator>
std::unique_ptr<Locked<AnyNavigator>> of_log(const Log& log) {
  return std::make_unique<Locked<AnyNavigator>>(log.recording.start, log.navigator);
}

template <class AnyNavigator>
std::unique_ptr<Locked<AnyNavigator>> of_options(const core::PoseGaussian& start, const py::dict& options) {
  return std::make_unique<Locked<AnyNavigator>>(start, options_of(options));
}

core::StepReport observe_named(Locked<NamedNavigator>& self, const core::Scan& scan, const py::object& identities) {
  const std::vector<std::int64_t> names = identities_from(identities);
  const py::gil_scoped_release released;
  return locked(&NamedNavigator::observe)(self, scan, names);
}

std::optional<core::StepReport> take_named(Locked<NamedNavigator>& self, const core::Event& event,
                                           const py::object& identities) {
  const std::vector<std::int64_t> names = identities_from(identities);
  const py::gil_scoped_release released;
  return locked(&NamedNavigator::take)(self, event, names);
}

template <class AnyNavigator>
Map map_of(Locked<AnyNavigator>& self) {
  return {locked(&AnyNavigator::map)(self)};
}

template <class AnyNavigator>
void bind_common(py::class_<Locked<AnyNavigator>>& type) {
  type.def(py::init(&of_options<AnyNavigator>), py::arg("start") = core::PoseGaussian(),
           py::arg("options") = py::dict(),
           "Options are keys and values as in a configuration file; lengths follow the sensor of the first scan.")
      .def(py::init(&of_log<AnyNavigator>), py::arg("log"), "With the start and the options of a log.")
      .def("move", locked(&AnyNavigator::move), py::arg("odometry"), Released(), "Collects motion.")
      .def("fix", locked(&AnyNavigator::fix), py::arg("fix"), Released(),
           "True when the fix passed its gate and was used.")
      .def_property_readonly("pose", py::cpp_function(locked(&AnyNavigator::pose), Released()),
                             "At the last scan or fix.")
      .def_property_readonly("map", py::cpp_function(&map_of<AnyNavigator>, Released()), "The landmarks as of now.");
}

}  // namespace

void bind_navigator(py::module_& module) {
  bind_map(module);
  bind_report_parts(module);
  bind_report(module);
  py::class_<Locked<Navigator>> unnamed(module, "Navigator",
                                        "Navigates with unknown data association; searches and closes loops.");
  bind_common(unnamed);
  unnamed.def("observe", locked(&Navigator::observe), py::arg("scan"), Released(), "One scan.")
      .def("lose", locked(&Navigator::lose), py::arg("lost"), Released(),
           "The vehicle was carried: its place is sought on what was mapped so far.")
      .def("take", locked(&Navigator::take), py::arg("event"), Released(),
           "Any event; the report of a scan, None for others.");
  py::class_<Locked<NamedNavigator>> named(module, "NamedNavigator", "For observations that are known by an identity.");
  bind_common(named);
  named
      .def("observe", &observe_named, py::arg("scan"), py::arg("identities"),
           "One scan, with an identity for each observation; a negative one is no landmark.")
      .def("take", &take_named, py::arg("event"), py::arg("identities") = py::tuple(),
           "Any event; the report of a scan, None for others.");
}

}  // namespace helixnav::python
