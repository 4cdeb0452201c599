// SPDX-License-Identifier: BSD-3-Clause
#include "convert_log.hpp"

#include <cstdio>
#include <filesystem>
#include <set>
#include <system_error>
#include <utility>
#include <variant>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/landmark_graph.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/logs/dlr.hpp"
#include "helixnav/logs/graph_files.hpp"
#include "helixnav/logs/own_lines.hpp"
#include "helixnav/logs/own_log.hpp"
#include "helixnav/logs/read_recording.hpp"

namespace helixnav::apps {
namespace {

/// DLR text has no scan before the first STEP. An empty one loses nothing; landmarks seen there would be lost.
void drop_empty_beginning(core::Recording& recording) {
  const auto* scan = recording.events.empty() ? nullptr : std::get_if<core::Scan>(&recording.events.front());
  if (scan == nullptr || !scan->observations.empty()) return;
  recording.events.erase(recording.events.begin());
  if (!recording.labels.empty()) recording.labels.erase(recording.labels.begin());
  for (core::SharedObservation& shared : recording.shared_observations) --shared.scan;
}

/// The output is read back by programs that invert covariances; our own does not.
void check_odometry(const core::Recording& recording) {
  for (const core::Event& event : recording.events) {
    const auto* odometry = std::get_if<core::Odometry>(&event);
    if (odometry == nullptr || core::is_symmetric_positive_definite(odometry->covariance)) continue;
    throw core::InputError(
        recording.name + ": the covariance of the odometry that ends at " +
        std::to_string(core::seconds(odometry->t_ns)) +
        " s is not positive definite, and no format holds that; --noise on odometry_x_m, odometry_y_m "
        "and odometry_heading_rad makes it so");
  }
}

bool is_graph_format(GraphFormat format) { return format != GraphFormat::dlr && format != GraphFormat::jsonl; }

Converted counts_of(const core::Recording& recording) {
  Converted converted;
  std::set<core::Label> labels;
  for (const core::Event& event : recording.events) {
    const auto* scan = std::get_if<core::Scan>(&event);
    if (scan == nullptr) continue;
    ++converted.poses;
    converted.observations += scan->observations.size();
  }
  for (const auto& of_scan : recording.labels) labels.insert(of_scan.begin(), of_scan.end());
  labels.erase(core::no_label);
  converted.landmarks = labels.size();
  return converted;
}

Converted to_dlr(core::Recording recording, const std::string& out) {
  drop_empty_beginning(recording);
  logs::write_dlr(recording, out);
  return counts_of(recording);
}

/// The vehicle.toml by which a log in the user's own format is read stays, also for lines beside it: they are from
/// the same sensor.
void write_vehicle(const core::Recording& recording, const std::string& in, const std::string& out, bool overwrite) {
  namespace fs = std::filesystem;
  const fs::path vehicle = fs::path(out).parent_path() / "vehicle.toml";
  const std::string text = logs::vehicle_of_lines(recording);
  std::error_code none;  // a file that does not exist yet is a different one
  if (logs::is_own_log(in) && fs::equivalent(logs::vehicle_beside(in), vehicle, none)) return;
  if (!overwrite && fs::exists(vehicle) && files::read_whole_file(vehicle.string()) != text) {
    throw core::InputError(vehicle.string() + ": the file is there already, and of another log; choose another " +
                           "folder, or --overwrite to replace it");
  }
  files::write_whole_file(vehicle.string(), text);
}

Converted to_lines(core::Recording recording, const std::string& in, const std::string& out, bool overwrite) {
  write_vehicle(recording, in, out, overwrite);
  const std::size_t told_apart = logs::tell_times_apart(recording);
  files::write_whole_file(out, logs::own_lines(recording));
  Converted converted = counts_of(recording);
  converted.times_told_apart = told_apart;
  return converted;
}

Converted to_graph(const core::LandmarkGraph& graph, const std::string& out, GraphFormat format) {
  if (format == GraphFormat::g2o) logs::write_g2o(graph, out);
  if (format == GraphFormat::isam) logs::write_isam(graph, out);
  if (format == GraphFormat::gtsam) logs::write_gtsam(graph, out);
  Converted converted;
  converted.poses = graph.poses.size();
  converted.landmarks = graph.landmarks.size();
  converted.observations = graph.landmark_edges.size();
  return converted;
}

Converted to_graph(const core::Recording& recording, const std::string& out, GraphFormat format) {
  const core::GraphFromEvents made = core::graph_from_events(recording.events, recording.labels, recording.start.mean);
  Converted converted = to_graph(made.graph, out, format);
  converted.unlabelled_observations = made.unlabelled_observations;
  converted.unlocated_landmarks = made.unlocated_landmarks;
  return converted;
}

}  // namespace

std::string name_of(GraphFormat format) { return format_names()[static_cast<std::size_t>(format)]; }

std::vector<std::string> format_names() { return {"dlr", "g2o", "isam", "gtsam", "jsonl"}; }

std::optional<GraphFormat> format_by_name(const std::string& name) {
  const std::vector<std::string> names = format_names();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == name) return static_cast<GraphFormat>(i);
  }
  return std::nullopt;
}

std::optional<GraphFormat> format_by_extension(const std::string& extension) {
  if (extension == ".circles" || extension == ".lines") return GraphFormat::dlr;
  return extension.empty() ? std::nullopt : format_by_name(extension.substr(1));
}

Converted convert_log(const std::string& in, const std::string& out, GraphFormat format,
                      const std::vector<logs::Noise>& noises, std::uint64_t seed, bool overwrite) {
  const bool is_graph = logs::recognise(in) == logs::LogFormat::g2o;
  if (is_graph && noises.empty() && is_graph_format(format)) return to_graph(logs::read_g2o(in), out, format);
  return convert_recording(logs::read_recording(in), in, out, format, noises, seed, overwrite);
}

Converted convert_recording(core::Recording recording, const std::string& in, const std::string& out,
                            GraphFormat format, const std::vector<logs::Noise>& noises, std::uint64_t seed,
                            bool overwrite) {
  if (recording.labels.empty() && is_graph_format(format)) {
    throw core::InputError(in +
                           ": a graph needs a labelled log, and this one has no labels; --to dlr and jsonl need none");
  }
  std::vector<logs::AddedNoise> added;
  if (!noises.empty()) added = logs::add_noise(recording, noises, seed);
  if (format != GraphFormat::jsonl) check_odometry(recording);
  Converted converted = format == GraphFormat::dlr     ? to_dlr(std::move(recording), out)
                        : format == GraphFormat::jsonl ? to_lines(std::move(recording), in, out, overwrite)
                                                       : to_graph(recording, out, format);
  converted.noise = std::move(added);
  return converted;
}

std::string text_of(const Converted& converted) {
  char line[256];
  std::snprintf(line, sizeof line, "poses %zu, landmarks %zu, observations %zu\n", converted.poses, converted.landmarks,
                converted.observations);
  std::string text = line;
  if (converted.unlabelled_observations + converted.unlocated_landmarks > 0) {
    std::snprintf(line, sizeof line, "left out: %d observations without label, %d landmarks that nothing locates\n",
                  converted.unlabelled_observations, converted.unlocated_landmarks);
    text += line;
  }
  if (converted.times_told_apart > 0) {
    std::snprintf(line, sizeof line,
                  "times told apart: %zu rows were not later than the row before, and are written 1 ns after it\n",
                  converted.times_told_apart);
    text += line;
  }
  for (const logs::AddedNoise& noise : converted.noise) {
    std::snprintf(line, sizeof line,
                  "noise on %s: sigma %g, measured %.6g on %zu numbers (99 %% interval %.6g to %.6g)\n",
                  logs::name_of(noise.field).c_str(), noise.sigma, noise.measured_sigma, noise.count, noise.low_99,
                  noise.high_99);
    text += line;
  }
  return text;
}

}  // namespace helixnav::apps
