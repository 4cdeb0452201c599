// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/run_writer.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>

#include "cloud_choice.hpp"
#include "helixnav/core/decision_row.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/files/append_cells.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/files/folder_lock.hpp"
#include "helixnav/files/number_text.hpp"
#include "helixnav/runs/joint_map_file.hpp"
#include "helixnav/runs/map_folder.hpp"
#include "helixnav/runs/words.hpp"
#include "tables/map_text.hpp"
#include "tables/particle_tables.hpp"
#include "tables/run_tables.hpp"
#include "write_truth.hpp"

namespace helixnav::runs {

namespace fs = std::filesystem;

namespace {

void write_part(const std::string& folder, const core::JointMap& map) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw core::InputError(folder + ": cannot make the folder: " + error.message());
  write_map(folder, map);
}

void append_step_and_time(std::string& text, const core::StepReport& report) {
  files::append_number(text, report.step);
  text += ',';
  files::append_seconds(text, report.t_ns);
}

// A cell must not end its line, nor the list of numbers.
void append_word(std::string& text, const std::string& word) {
  for (const char c : word) text += c == ',' || c == ';' || c == '=' || c == '"' || c == '\n' || c == '\r' ? ' ' : c;
}

void append_association(std::string& text, std::int64_t step, const core::AssociationReport& a, bool revised) {
  files::append_number(text, step);
  files::append_counts(text, {a.observation, a.landmark});
  text += ',';
  text += word_of(outcome_words, a.outcome);
  files::append_cells(text, {a.nis});
  files::append_counts(text, {a.dof});
  files::append_cells(text, {a.margin_nats});
  text += revised ? ",1\n" : ",0\n";
}

/// Revisions first; returns the number of rows.
std::int64_t append_associations(std::string& block, const core::StepReport& report) {
  auto rows = static_cast<std::int64_t>(report.associations.size());
  for (const core::RevisedScan& scan : report.revised) {
    for (const core::AssociationReport& a : scan.associations) append_association(block, scan.step, a, true);
    rows += static_cast<std::int64_t>(scan.associations.size());
  }
  for (const core::AssociationReport& a : report.associations) append_association(block, report.step, a, false);
  return rows;
}

void append_decision(std::string& text, const core::StepReport& report, const core::Decision& decision) {
  append_step_and_time(text, report);
  const core::DecisionRow row = core::row_of(decision);
  text += ',';
  append_word(text, row.kind);
  text += ',';
  append_word(text, row.verdict);
  char separator = ',';
  for (const auto& [name, value] : row.numbers) {
    text += separator;
    append_word(text, name);
    text += '=';
    files::append_number(text, value);
    separator = ';';
  }
  text += row.numbers.empty() ? ",\n" : "\n";
}

void append_merge(std::string& text, std::int64_t step, const core::MergedLandmarks& merge) {
  files::append_number(text, step);
  files::append_counts(text, {merge.kept, merge.removed});
  text += '\n';
}

void append_particle(std::string& text, std::int64_t step, const core::Pose2& pose) {
  files::append_number(text, step);
  files::append_cells(text, {pose.x_m, pose.y_m, pose.heading_rad});
  text += '\n';
}

void append_trajectory(std::string& text, core::Nanoseconds t_ns, const core::Pose2& pose) {
  files::append_seconds(text, t_ns);
  for (const double value :
       {pose.x_m, pose.y_m, 0.0, 0.0, 0.0, std::sin(0.5 * pose.heading_rad), std::cos(0.5 * pose.heading_rad)}) {
    text += ' ';
    files::append_number(text, value);
  }
  text += '\n';
}

void append_health(std::string& text, const core::StepReport& report, std::int64_t association_rows,
                   std::int64_t cloud_rows, double microseconds) {
  const Eigen::Matrix3d& P = report.pose.covariance;
  append_step_and_time(text, report);
  text += ',';
  text += word_of(mode_words, report.mode);
  files::append_cells(text, {P(0, 0), P(0, 1), P(0, 2), P(1, 1), P(1, 2), P(2, 2), report.joint_nis});
  files::append_counts(text,
                       {report.joint_dof, report.active_landmarks, report.mapped_landmarks, report.switched_region,
                        association_rows, static_cast<std::int64_t>(report.decisions.size()),
                        static_cast<std::int64_t>(report.merged.size()), cloud_rows});
  files::append_cells(text, {report.numerics.least_pivot, report.numerics.asymmetry});
  files::append_counts(text, {report.numerics.repaired, report.numerics.refused});
  files::append_cells(text, {std::round(microseconds * 10.0) / 10.0});
  text += '\n';
}

std::string final_trajectory_text(const std::vector<core::StepReport>& steps, const std::vector<core::Pose2>& poses) {
  std::string text(trajectory_table.header);
  text += '\n';
  const std::size_t n = std::min(steps.size(), poses.size());
  for (std::size_t i = 0; i < n; ++i) append_trajectory(text, steps[i].t_ns, poses[i]);
  return text;
}

// One growing table with the block of the present step.
struct Table {
  files::AppendFile file;
  std::string block;

  Table(const std::string& folder, const RunTable& table) : file(folder + '/' + std::string(table.file)) {
    block = std::string(table.header) + '\n';
    flush();
  }
  void flush() {
    if (!block.empty()) file.append(block);
    block.clear();
  }
};

}  // namespace

void make_run_folder(const std::string& folder, RunWriter::IfNotEmpty if_not_empty) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder)) {
    throw core::InputError(folder + ": cannot make the folder" + (error ? ": " + error.message() : ""));
  }
  if (fs::is_empty(folder)) return;
  if (if_not_empty == RunWriter::IfNotEmpty::refuse) {
    throw core::InputError(folder + ": the folder is not empty; expected an empty or new one, or leave to overwrite");
  }
  for (const char* name : run_files) fs::remove(fs::path(folder) / name, error);
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().filename().string().rfind("part_", 0) != 0) continue;
    for (const char* name : {"map.csv", joint_map_file, drives_file, joined_from_file})
      fs::remove(entry.path() / name, error);
    fs::remove(entry.path(), error);  // unless something else is in it
  }
}

bool is_run_file(std::string_view name) {
  return std::find(std::begin(run_files), std::end(run_files), name) != std::end(run_files);
}

struct RunWriter::Files {
  std::unique_ptr<files::FolderLock> lock;
  Table associations;
  Table decisions;
  Table merges;
  Table clouds;
  Table trajectory;
  Table health;
  std::optional<Table> particles;  ///< from the first step with a cloud
  CloudChoice cloud_choice;

  Files(const std::string& folder, std::unique_ptr<files::FolderLock> kept)
      : lock(std::move(kept)),
        associations(folder, associations_table),
        decisions(folder, decisions_table),
        merges(folder, merges_table),
        clouds(folder, clouds_table),
        trajectory(folder, trajectory_table),
        health(folder, health_table) {}
};

RunWriter::RunWriter(const std::string& folder, const RunManifest& manifest, const core::Recording& recording,
                     IfNotEmpty if_not_empty)
    : folder_(folder) {
  std::error_code error;  // make_run_folder reports what is wrong
  fs::create_directories(folder_, error);
  auto lock = std::make_unique<files::FolderLock>(folder_);
  make_run_folder(folder_, if_not_empty);
  write_truth(folder_, recording);
  files_ = std::make_unique<Files>(folder_, std::move(lock));
  // Last: if there is a manifest, everything else is there.
  files::write_whole_file(folder_ + '/' + manifest_file, manifest_json(manifest));
}

RunWriter::~RunWriter() = default;

void RunWriter::write(const core::StepReport& report, double microseconds) {
  Files& f = *files_;
  const std::int64_t rows = append_associations(f.associations.block, report);
  for (const core::Decision& decision : report.decisions) append_decision(f.decisions.block, report, decision);
  for (const core::MergedLandmarks& merge : report.merged) append_merge(f.merges.block, report.step, merge);
  const bool keeps_cloud = f.cloud_choice.keeps(report);
  // An attempt starts as it was drawn; what its first scan made of that is seen one scan later.
  const std::vector<core::Pose2>& cloud = report.drawn.empty() ? report.cloud : report.drawn;
  const auto particles = keeps_cloud ? static_cast<std::int64_t>(cloud.size()) : 0;
  if (keeps_cloud) {
    for (const core::Pose2& pose : cloud) append_particle(f.clouds.block, report.step, pose);
  }
  if (report.particles) {
    if (!f.particles) f.particles.emplace(folder_, particles_table);
    append_particles(f.particles->block, report.step, *report.particles);
    f.particles->flush();
  }
  append_trajectory(f.trajectory.block, report.t_ns, report.pose.mean);
  append_health(f.health.block, report, rows, particles, microseconds);
  // Health last: its row counts the rows of the others, so a reader knows when a step is complete.
  f.associations.flush();
  f.decisions.flush();
  f.merges.flush();
  f.clouds.flush();
  f.trajectory.flush();
  f.health.flush();
}

void RunWriter::finish(const Run& run, const std::string& report_page, const std::string& summary) {
  files::write_whole_file(folder_ + "/map.csv", map_text(run.map, run.names));
  if (!run.final_path.empty()) {
    files::write_whole_file(folder_ + '/' + std::string(final_trajectory_table.file),
                            final_trajectory_text(run.steps, run.final_path));
  }
  write_frame_of_map(folder_, run);
  if (run.joint_map) write_joint_map(folder_, *run.joint_map);
  for (const auto& [part, map] : run.parts_apart) write_part(folder_ + "/part_" + std::to_string(part), map);
  if (run.particle_end) {
    files::write_whole_file(folder_ + '/' + std::string(paths_table.file), paths_text(run.particle_end->paths));
    files::write_whole_file(folder_ + '/' + std::string(mixture_table.file), mixture_text(run.particle_end->mixture));
  }
  files::write_whole_file(folder_ + '/' + report_file, report_page);
  files::write_whole_file(folder_ + '/' + summary_file, summary);
}

}  // namespace helixnav::runs
