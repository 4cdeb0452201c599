// SPDX-License-Identifier: BSD-3-Clause
#include "write_truth.hpp"

#include <algorithm>
#include <filesystem>

#include "helixnav/core/errors.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/files/number_text.hpp"
#include "helixnav/runs/run_folder.hpp"
#include "tables/run_rows.hpp"
#include "tables/run_tables.hpp"

namespace helixnav::runs {

namespace fs = std::filesystem;

namespace {

void append_row(std::string& text, std::initializer_list<double> cells) {
  for (const double cell : cells) {
    text += ',';
    files::append_number(text, cell);
  }
  text += '\n';
}

template <typename Items, typename AppendItem>
void write_table(const std::string& folder, const RunTable& table, const Items& items, AppendItem append_item) {
  if (items.empty()) return;
  std::string text(table.header);
  text += '\n';
  for (const auto& item : items) append_item(text, item);
  files::write_whole_file(folder + '/' + std::string(table.file), text);
}

std::string labels_text(const std::vector<std::vector<core::Label>>& labels) {
  std::string text;
  for (std::size_t step = 0; step < labels.size(); ++step) {
    for (std::size_t k = 0; k < labels[step].size(); ++k) {
      files::append_number(text, static_cast<std::int64_t>(step));
      text += ',';
      files::append_number(text, static_cast<std::int64_t>(k));
      text += ',';
      files::append_number(text, labels[step][k]);
      text += '\n';
    }
  }
  return text;
}

void read_poses(const std::string& path, RunTruth& truth) {
  for_each_row(path, truth_poses_table, [&](const RunRow& row) {
    truth.poses.push_back({row.seconds(0), core::Pose2(row.finite(1), row.finite(2), row.finite(3))});
  });
}

void read_positions(const std::string& path, RunTruth& truth) {
  for_each_row(path, truth_positions_table, [&](const RunRow& row) {
    truth.positions.push_back({row.seconds(0), {row.finite(1), row.finite(2)}});
    truth.antenna_robot_m = {row.finite(3), row.finite(4)};
  });
}

void read_landmarks(const std::string& path, RunTruth& truth) {
  for_each_row(path, truth_landmarks_table, [&](const RunRow& row) {
    truth.landmarks.push_back({row.integer(0), {row.finite(1), row.finite(2)}});
  });
}

void read_labels(const std::string& path, RunTruth& truth) {
  // The memory that a row can claim is bounded, whatever it says. The writer leaves out no observation; others may.
  constexpr std::int64_t most_steps = 10'000'000;
  constexpr std::int64_t most_unseen_steps = 100'000;
  constexpr std::int64_t most_unseen_observations = 100;
  for_each_row(path, truth_labels_table, [&](const RunRow& row) {
    const auto known = static_cast<std::int64_t>(truth.labels.size());
    const auto step = static_cast<std::size_t>(row.integer_in(0, 0, std::min(most_steps, known + most_unseen_steps)));
    const std::size_t seen = step < truth.labels.size() ? truth.labels[step].size() : 0;
    const auto observation =
        static_cast<std::size_t>(row.integer_in(1, 0, static_cast<std::int64_t>(seen) + most_unseen_observations));
    if (truth.labels.size() <= step) truth.labels.resize(step + 1);
    auto& labels = truth.labels[step];
    if (labels.size() <= observation) labels.resize(observation + 1, core::no_label);
    labels[observation] = row.integer(2);
  });
}

void read_frames(const std::string& path, RunTruth& truth) {
  for_each_row(path, truth_frame_table, [&](const RunRow& row) {
    const bool is_known = row.integer_in(1, 0, 1) == 1;
    core::TruthFrame frame{is_known, std::nullopt};
    if (is_known) frame.T_truth_map = core::Pose2(row.finite(2), row.finite(3), row.finite(4));
    if (row.text(0) == "begin") {
      truth.frame = frame;
    } else if (row.text(0) == "placed") {
      truth.frame_when_placed = frame;
    } else if (row.text(0) != "end") {  // which the steps of the run also show: T_truth_of_map
      row.refuse(0, "begin, placed or end");
    }
  });
}

void append_frame(const char* when, const core::TruthFrame& frame, std::string& text) {
  const core::Pose2 T_truth_map = frame.T_truth_map.value_or(core::Pose2());
  text += when;
  text += frame.T_truth_map ? ",1" : ",0";
  append_row(text, {T_truth_map.x_m, T_truth_map.y_m, T_truth_map.heading_rad});
}

/// Nothing for a drive of which only the poses in the map frame are known.
void write_frames(const std::string& folder, const core::Recording& recording) {
  const core::TruthFrame& begin = recording.truth_frame;
  const std::optional<core::TruthFrame>& placed = recording.truth_frame_when_placed;
  if (recording.true_poses.empty() || (begin.is_map && !begin.T_truth_map && !placed)) return;
  std::string text = std::string(truth_frame_table.header) + '\n';
  if (begin.T_truth_map || !begin.is_map) append_frame("begin", begin, text);
  if (placed) append_frame("placed", *placed, text);
  files::write_whole_file(folder + '/' + std::string(truth_frame_table.file), text);
}

/// What may be there already, of the begin.
std::string frames_text(const std::string& file) {
  return fs::exists(file) ? files::read_whole_file(file) : std::string(truth_frame_table.header) + '\n';
}

struct TruthReader {
  const RunTable& table;
  void (*read)(const std::string& path, RunTruth& truth);
};

constexpr TruthReader readers[] = {{truth_poses_table, &read_poses},
                                   {truth_positions_table, &read_positions},
                                   {truth_landmarks_table, &read_landmarks},
                                   {truth_labels_table, &read_labels},
                                   {truth_frame_table, &read_frames}};

RunTruth read_truth_file(const std::string& path) {
  const std::string text = files::read_whole_file(path);
  const std::string header = text.substr(0, text.find_first_of("\r\n"));
  std::string expected;
  RunTruth truth;
  for (const TruthReader& reader : readers) {
    if (header == reader.table.header) {
      reader.read(path, truth);
      return truth;
    }
    expected += (expected.empty() ? "\"" : "\" or \"") + std::string(reader.table.header);
  }
  throw core::InputError(path + ":1: not a file of truth: expected the header line " + expected + '"');
}

}  // namespace

void write_truth(const std::string& folder, const core::Recording& recording) {
  write_table(folder, truth_poses_table, recording.true_poses, [](std::string& text, const core::TruePose& pose) {
    files::append_seconds(text, pose.t_ns);
    append_row(text, {pose.T_world_robot.x_m, pose.T_world_robot.y_m, pose.T_world_robot.heading_rad});
  });
  write_frames(folder, recording);
  const Eigen::Vector2d& antenna = recording.antenna_robot_m;
  write_table(folder, truth_positions_table, recording.true_positions,
              [&](std::string& text, const core::TruePosition& fix) {
                files::append_seconds(text, fix.t_ns);
                append_row(text, {fix.position_m.x(), fix.position_m.y(), antenna.x(), antenna.y()});
              });
  write_table(folder, truth_landmarks_table, recording.true_landmarks,
              [](std::string& text, const core::TrueLandmark& landmark) {
                files::append_number(text, landmark.label);
                append_row(text, {landmark.point_m.x(), landmark.point_m.y()});
              });
  if (!recording.labels.empty()) {
    files::write_whole_file(folder + '/' + std::string(truth_labels_table.file),
                            std::string(truth_labels_table.header) + '\n' + labels_text(recording.labels));
  }
}

void write_frame_of_map(const std::string& folder, const Run& run) {
  if (run.truth.poses.empty() || !begin_of_last_part(run)) return;
  const std::string file = folder + '/' + std::string(truth_frame_table.file);
  std::string text = frames_text(file);
  append_frame("end", {false, T_truth_of_map(run)}, text);
  files::write_whole_file(file, text);
}

RunTruth read_truth(const std::string& path) {
  if (!fs::is_directory(path)) return read_truth_file(path);
  RunTruth truth;
  bool found = false;
  for (const TruthReader& reader : readers) {
    const std::string file = path + '/' + std::string(reader.table.file);
    if (!fs::exists(file)) continue;
    reader.read(file, truth);
    found = true;
  }
  if (!found) throw core::InputError(path + ": no truth here: expected a file truth_*.csv");
  return truth;
}

}  // namespace helixnav::runs
