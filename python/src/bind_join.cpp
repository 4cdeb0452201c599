// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "arrays.hpp"
#include "bind.hpp"
#include "drive/earlier_session.hpp"
#include "drive/kept_inputs.hpp"
#include "gil.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/reports/decision_sentence.hpp"
#include "helixnav/supervisor/join_sessions.hpp"
#include "join/joined_folder.hpp"
#include "join/joined_names.hpp"
#include "join/run_views.hpp"
#include "join/session_changes.hpp"
#include "map.hpp"
#include "signals.hpp"

namespace helixnav::python {
namespace {

namespace fs = std::filesystem;

struct Joined {
  supervisor::JoinedSessions joined;
  std::vector<apps::ChangedLandmark> changes;
};

struct Sessions {
  std::vector<core::JointMap> maps;
  std::vector<std::string> names;                        ///< of each
  std::vector<std::string> folders;                      ///< of those that were read
  std::vector<std::optional<apps::SessionViews>> views;  ///< of each; of a map in memory they are not known
  std::vector<apps::LandmarkNames> landmarks;  ///< of each, what its landmarks are called; a map in memory does not say
};

Sessions sessions_from(const py::sequence& list) {
  Sessions sessions;
  for (const py::handle& value : list) {
    const std::string number = std::to_string(sessions.maps.size() + 1);
    if (py::isinstance<core::JointMap>(value)) {
      sessions.names.push_back("session " + number);
      sessions.maps.push_back(value.cast<core::JointMap>());
      apps::check_has_covariance(sessions.maps.back(), sessions.names.back(), "join");
      sessions.views.emplace_back();
      sessions.landmarks.emplace_back();
      continue;
    }
    const std::string folder = path_from(value, "sessions").string();
    sessions.maps.push_back(apps::read_dense_map_in(folder, "join"));
    sessions.names.push_back(folder);
    sessions.folders.push_back(folder);
    sessions.views.push_back(apps::views_in(folder, sessions.maps.back()));
    sessions.landmarks.push_back(apps::landmark_names_in(folder));
  }
  if (sessions.maps.size() < 2) throw core::PreconditionError("join: expected two sessions or more");
  return sessions;
}

void check_out(const fs::path& out, bool overwrite) {
  if (!fs::exists(out) || (fs::is_directory(out) && (overwrite || fs::is_empty(out)))) return;
  throw core::InputError(out.string() + (fs::is_directory(out) ? ": the folder is not empty" : ": is a file"));
}

Joined join(const py::sequence& list, const std::optional<fs::path>& out, bool overwrite) {
  if (out) check_out(*out, overwrite);
  const Sessions sessions = sessions_from(list);
  if (out) apps::refuse_to_replace(sessions.folders, out->string());
  const WithoutGil released;
  apps::check_independent(sessions.folders);
  apps::check_independent(sessions.maps, sessions.names);
  Joined result;
  SignalWatch signals;
  result.joined = supervisor::join_sessions(sessions.maps, [&] { signals.heed(); });
  apps::tell_drives(sessions.maps, result.joined);
  result.changes = apps::shared_landmarks(sessions.maps, result.joined, sessions.views);
  apps::make_gone_tentative(result.changes, result.joined.components);
  if (out) {
    const apps::JoinedNames landmarks = apps::joined_names(sessions.landmarks, result.joined);
    apps::write_joined(out->string(), sessions.names, result.joined, result.changes, landmarks.of_component);
  }
  return result;
}

std::optional<Decided> decision_on(const supervisor::JoinedSession& session) {
  if (session.decision.verdict == core::PlacedDecision::Verdict::sought) return std::nullopt;
  return Decided{session.decision, reports::sentence_of_join(session.decision)};
}

void bind_parts(py::module_& module) {
  using supervisor::JoinedSession;
  py::class_<JoinedSession>(module, "JoinedSession", "What join made of one session.")
      .def_readonly("component", &JoinedSession::component, "Index in Joined.components.")
      .def_property_readonly(
          "transform", [](const JoinedSession& s) { return s.T_component_session.vector(); },
          "(x, y, heading): the session's frame in that of its component.")
      .def_property_readonly("decision", &decision_on,
                             "How it was placed, or why it was not; None for the session that gave the first component "
                             "its frame, which needs no placing.")
      .def_readonly("landmark_of", &JoinedSession::name_of,
                    "Ids in the component by the session's own ids; mature landmarks only.");
  using apps::ChangedLandmark;
  py::class_<ChangedLandmark>(module, "ChangedLandmark", "A landmark in an area that several sessions observed.")
      .def_readonly("component", &ChangedLandmark::component, "Index in Joined.components.")
      .def_readonly("landmark", &ChangedLandmark::id, "Id in the component.")
      .def_readonly("position", &ChangedLandmark::point_m, "(2,): in the frame of the component [m].")
      .def_property_readonly(
          "change", [](const ChangedLandmark& l) { return apps::name_of(l.change()); },
          "'kept', 'gone', 'new', 'both' (it both came and went) or 'moved'.")
      .def_property_readonly(
          "counterpart",
          [](const ChangedLandmark& l) {
            return l.counterpart == core::no_landmark ? std::optional<core::LandmarkId>() : l.counterpart;
          },
          "For a moved landmark: the new landmark if this one is gone, and vice versa; otherwise None.")
      .def_readonly("seen_in", &ChangedLandmark::seen_in, "Indices of the sessions that saw it.")
      .def_readonly("missing_in", &ChangedLandmark::missing_in,
                    "Indices of the sessions that looked there without seeing it.");
}

}  // namespace

void bind_join(py::module_& module) {
  bind_parts(module);
  py::class_<Joined>(module, "Joined", "Several sessions joined into as few maps as the evidence allows.")
      .def_property_readonly(
          "components", [](const Joined& j) { return j.joined.components; },
          "JointMaps, the one with the largest session first.")
      .def_property_readonly(
          "sessions", [](const Joined& j) { return j.joined.sessions; }, "In the order given.")
      .def_readonly("changes", &Joined::changes, "What is new or gone, taking the sessions to be in time order.");
  module.def(
      "join", &join, py::arg("sessions"), py::arg("out") = py::none(), py::arg("overwrite") = false,
      "Joins several sessions that began anywhere into one map: JointMaps or run folders, oldest first. Each is placed "
      "on the others by its landmarks, or remains a separate component. With `out`, the folder of helixnav join is "
      "written. InputError if a map is listed twice, or if two maps contain observations of the same drive.");
}

}  // namespace helixnav::python
