// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "bind.hpp"
#include "drive/earlier_session.hpp"
#include "gil.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/runs/map_folder.hpp"
#include "helixnav/runs/run_writer.hpp"
#include "helixnav/runs/words.hpp"
#include "map.hpp"

namespace helixnav::python {
namespace {

namespace fs = std::filesystem;

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

/// The likeliest class; '' where none was given.
std::vector<std::string> classes_of(const Map& map) {
  std::vector<std::string> names;
  for (const core::MapLandmark& landmark : map.landmarks) {
    names.emplace_back(landmark.appearance.votes.front().name.text());
  }
  return names;
}

/// Mean and standard deviation; NaN where none was given.
py::array_t<double> sizes_of(const Map& map) {
  py::array_t<double> sizes({static_cast<py::ssize_t>(map.landmarks.size()), py::ssize_t{2}});
  std::fill_n(sizes.mutable_data(), sizes.size(), std::numeric_limits<double>::quiet_NaN());
  double* to = sizes.mutable_data();
  for (const core::MapLandmark& landmark : map.landmarks) {
    const core::LandmarkAppearance& known = landmark.appearance;
    if (known.size_m > 0.0) {
      to[0] = known.size_m;
      to[1] = std::sqrt(known.size_variance_m2);
    }
    to += 2;
  }
  return sizes;
}

void bind_landmarks(py::module_& module) {
  py::class_<Map>(module, "Map", "Landmarks in order of id, as arrays.")
      .def_property_readonly("ids", &ids_of, "(N,)")
      .def_property_readonly("means", &means_of, "(N, 2) [m]")
      .def_property_readonly("covariances", &covariances_of, "(N, 2, 2) [m²]")
      .def_property_readonly("observations", &counts_of, "(N,)")
      .def_property_readonly("states", &states_of, "'tentative' or 'mature' for each")
      .def_property_readonly("classes", &classes_of, "The most likely class of each; '' where none was given")
      .def_property_readonly("sizes", &sizes_of, "(N, 2), mean and standard deviation [m]; NaN where none was given")
      .def("__len__", [](const Map& map) { return map.landmarks.size(); });
}

core::PoseGaussian pose_in(const core::JointMap& map) {
  return {map.joint.pose, map.joint.covariance.topLeftCorner<3, 3>()};
}

Eigen::MatrixXd covariance_in(const core::JointMap& map) {
  if (map.has_covariance()) return map.joint.covariance;
  throw core::PreconditionError("covariance: a map of " + std::to_string(map.joint.ids.size()) +
                                " landmarks has no joint covariance; landmarks.covariances has one for each");
}

/// The folder is of one map: what a run left there would be read beside it.
void save(const core::JointMap& map, const fs::path& folder, bool overwrite) {
  using IfNotEmpty = runs::RunWriter::IfNotEmpty;
  runs::make_run_folder(folder.string(), overwrite ? IfNotEmpty::overwrite : IfNotEmpty::refuse);
  runs::write_map(folder.string(), map);
}

void bind_joint_map(py::module_& module) {
  py::class_<core::JointMap>(
      module, "JointMap",
      "A map with all correlations and the pose at its end: what another session needs to continue in it.")
      .def_property_readonly(
          "landmarks", [](const core::JointMap& map) { return Map{runs::landmarks_of(map)}; },
          "A Map: the landmarks without their cross-correlations.")
      .def_property_readonly("pose", &pose_in, "The vehicle's pose at the end of that session.")
      .def_property_readonly(
          "covariance", &covariance_in,
          "(3 + 2 N, 3 + 2 N): covariance of x, y, heading and the landmarks' x, y. PreconditionError for more than "
          "2000 "
          "landmarks: their correlations are kept as factors, for a session that continues in the map.")
      .def_readonly("reach", &core::JointMap::reach_m, "Reach of the sensor that mapped it [m]; 0: unknown.")
      .def_readonly("drives", &core::JointMap::drives,
                    "Digests of the drives that went into it; maps that share one are not joined. Empty: unknown.")
      .def("save", &save, py::arg("folder"), py::arg("overwrite") = false, py::call_guard<WithoutGil>(),
           "Writes map.csv, map.bin and drives.csv; replay can continue in the folder. "
           "InputError if it is not empty; with overwrite, the files of any earlier run there are deleted.")
      .def("__len__", [](const core::JointMap& map) { return map.joint.ids.size(); });
}

core::JointMap read_map(const fs::path& folder) { return apps::read_joint_map_in(folder.string()); }

}  // namespace

void bind_map(py::module_& module) {
  bind_landmarks(module);
  bind_joint_map(module);
  module.def("read_map", &read_map, py::arg("folder"), py::call_guard<WithoutGil>(),
             "Reads the JointMap that a run or join left in its folder.");
}

}  // namespace helixnav::python
