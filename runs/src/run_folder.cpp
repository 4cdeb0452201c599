// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/runs/run_folder.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>

#include "bring_into_map.hpp"
#include "helixnav/core/decision_row.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/files/file.hpp"
#include "helixnav/files/number_text.hpp"
#include "helixnav/runs/words.hpp"
#include "manifest_json.hpp"
#include "missing_rows.hpp"
#include "tables/appearance_cells.hpp"
#include "tables/put_association.hpp"
#include "tables/run_rows.hpp"
#include "tables/run_tables.hpp"

namespace helixnav::runs {

namespace fs = std::filesystem;

namespace {

constexpr std::int64_t int_max = std::numeric_limits<std::int32_t>::max();

template <typename Enum, std::size_t n>
Enum enumerator(const RunRow& row, std::size_t column, const std::array<std::string_view, n>& words) {
  const auto value = value_of<Enum>(words, row.text(column));
  if (!value) {
    std::string expected;
    for (const std::string_view word : words) expected += (expected.empty() ? "" : ", ") + std::string(word);
    row.refuse(column, "one of " + expected);
  }
  return *value;
}

int small_integer(const RunRow& row, std::size_t column, std::int64_t low = 0) {
  return static_cast<int>(row.integer_in(column, low, int_max));
}

// The tables as they are, before incomplete steps are dropped.
struct AssociationRow {
  std::int64_t step;
  bool revised;
  core::AssociationReport report;
};

struct HealthRow {
  core::StepReport report;
  std::size_t association_rows;
  std::size_t decision_rows;
  std::size_t merge_rows;
  std::size_t cloud_rows;
  double microseconds;
};

struct RunTables {
  std::vector<core::StampedPose> trajectory;
  std::vector<AssociationRow> associations;
  std::vector<core::Decision> decisions;
  std::vector<core::MergedLandmarks> merges;
  std::vector<core::Pose2> particles;
  std::vector<HealthRow> health;
  std::map<std::int64_t, core::CloudReport> clouds;  ///< by step; empty where no file has them
};

/// From the columns of its upper triangle, row by row. Element by element: an Eigen comma initialiser must not
/// be left by an exception.
template <int n>
Eigen::Matrix<double, n, n> symmetric(const RunRow& row, std::size_t column) {
  Eigen::Matrix<double, n, n> matrix;
  for (int r = 0; r < n; ++r) {
    for (int c = r; c < n; ++c) matrix(r, c) = matrix(c, r) = row.number(column++);
  }
  return matrix;
}

core::StampedPose read_stamped_pose(const RunRow& row) {
  return {row.seconds(0), core::Pose2(row.number(1), row.number(2), 2.0 * std::atan2(row.number(6), row.number(7)))};
}

HealthRow read_health_row(const RunRow& row, bool has_numerics) {
  HealthRow health{};
  core::StepReport& report = health.report;
  report.step = row.integer(0);
  report.t_ns = row.seconds(1);
  report.mode = enumerator<core::Mode>(row, 2, mode_words);
  report.pose.covariance = symmetric<3>(row, 3);
  report.joint_nis = row.number(9);
  report.joint_dof = small_integer(row, 10);
  report.active_landmarks = small_integer(row, 11);
  report.mapped_landmarks = small_integer(row, 12);
  report.switched_region = row.integer_in(13, 0, 1) == 1;
  health.association_rows = static_cast<std::size_t>(row.integer_in(14, 0, int_max));
  health.decision_rows = static_cast<std::size_t>(row.integer_in(15, 0, int_max));
  health.merge_rows = static_cast<std::size_t>(row.integer_in(16, 0, int_max));
  health.cloud_rows = static_cast<std::size_t>(row.integer_in(17, 0, int_max));
  if (has_numerics) {
    report.numerics.least_pivot = row.number(18);
    report.numerics.asymmetry = row.number(19);
    report.numerics.repaired = small_integer(row, 20);
    report.numerics.refused = small_integer(row, 21);
  }
  health.microseconds = row.number(has_numerics ? 22 : 18);
  return health;
}

AssociationRow read_association_row(const RunRow& row) {
  core::AssociationReport report;
  report.observation = small_integer(row, 1);
  report.landmark = small_integer(row, 2, core::no_landmark);
  report.outcome = enumerator<core::Outcome>(row, 3, outcome_words);
  report.nis = row.number(4);
  report.dof = small_integer(row, 5);
  report.margin_nats = row.number(6);
  return {row.integer(0), row.integer_in(7, 0, 1) == 1, report};
}

core::Decision read_decision_row(const RunRow& row) {
  core::DecisionRow decision;
  decision.kind = row.text(2);
  decision.verdict = row.text(3);
  for (std::string_view rest = row.text(4); !rest.empty();) {
    const std::size_t end = std::min(rest.find(';'), rest.size());
    const std::string_view pair = rest.substr(0, end);
    const std::size_t equals = pair.find('=');
    const auto value = equals < pair.size() ? files::parse_number(pair.substr(equals + 1)) : std::nullopt;
    if (!value) row.refuse(4, "name=number;name=number");
    decision.numbers.emplace_back(pair.substr(0, equals), *value);
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  return core::decision_of(decision);
}

core::CloudReport read_cloud_report(const RunRow& row) {
  core::CloudReport cloud;
  cloud.hypotheses = static_cast<std::size_t>(row.integer_in(1, 0, int_max));
  cloud.effective_size = row.number(2);
  cloud.resampled = row.integer_in(3, 0, 1) == 1;
  cloud.log_evidence = row.number(4);
  cloud.distinct_ancestors = static_cast<std::size_t>(row.integer_in(5, 0, int_max));
  return cloud;
}

RunTables read_tables(const std::string& folder) {
  const auto path = [&](const RunTable& table) { return folder + '/' + std::string(table.file); };
  RunTables tables;
  const bool has_numerics = !begins_with(path(health_table), health_table_without_numerics);
  const RunTable& columns = has_numerics ? health_table : health_table_without_numerics;
  for_each_row(path(health_table), columns, [&](const RunRow& row) {
    const bool first = tables.health.empty();
    const core::StepReport before = first ? core::StepReport{} : tables.health.back().report;
    const HealthRow& health = tables.health.emplace_back(read_health_row(row, has_numerics));
    if (!first && health.report.step <= before.step) row.refuse(0, "more than " + std::to_string(before.step));
    if (!first && health.report.t_ns < before.t_ns) row.refuse(1, "time that does not go backwards");
  });
  for_each_row(path(trajectory_table), trajectory_table,
               [&](const RunRow& row) { tables.trajectory.push_back(read_stamped_pose(row)); });
  for_each_row(path(associations_table), associations_table,
               [&](const RunRow& row) { tables.associations.push_back(read_association_row(row)); });
  for_each_row(path(decisions_table), decisions_table,
               [&](const RunRow& row) { tables.decisions.push_back(read_decision_row(row)); });
  for_each_row(path(merges_table), merges_table, [&](const RunRow& row) {
    tables.merges.push_back({small_integer(row, 1), small_integer(row, 2)});
  });
  for_each_row(path(clouds_table), clouds_table,
               [&](const RunRow& row) { tables.particles.emplace_back(row.finite(1), row.finite(2), row.finite(3)); });
  if (fs::exists(path(particles_table))) {
    for_each_row(path(particles_table), particles_table,
                 [&](const RunRow& row) { tables.clouds[row.integer(0)] = read_cloud_report(row); });
  }
  return tables;
}

// Moves the next `count` rows of a table into a step.
template <typename Row>
void take(std::vector<Row>& rows, std::size_t& next, std::size_t count, std::vector<Row>& into) {
  for (const std::size_t end = next + count; next < end; ++next) into.push_back(std::move(rows[next]));
}

// Takes steps as long as every table holds their rows.
void assemble(RunTables& tables, Run& run) {
  std::size_t next_association = 0;
  std::size_t next_decision = 0;
  std::size_t next_merge = 0;
  std::size_t next_particle = 0;
  const std::size_t most = std::min(tables.health.size(), tables.trajectory.size());
  for (std::size_t k = 0; k < most; ++k) {
    HealthRow& health = tables.health[k];
    const std::size_t end_association = next_association + health.association_rows;
    if (end_association > tables.associations.size() ||
        next_decision + health.decision_rows > tables.decisions.size() ||
        next_merge + health.merge_rows > tables.merges.size() ||
        next_particle + health.cloud_rows > tables.particles.size()) {
      break;
    }
    core::StepReport& step = run.steps.emplace_back(std::move(health.report));
    run.microseconds.push_back(health.microseconds);
    step.pose.mean = tables.trajectory[k].T_world_robot;
    const auto cloud = tables.clouds.find(step.step);
    if (cloud != tables.clouds.end()) step.particles = cloud->second;
    take(tables.decisions, next_decision, health.decision_rows, step.decisions);
    take(tables.merges, next_merge, health.merge_rows, step.merged);
    take(tables.particles, next_particle, health.cloud_rows, step.cloud);
    for (; next_association < end_association; ++next_association) {
      const AssociationRow& row = tables.associations[next_association];
      put_association(row.step, row.report, run.steps);
    }
  }
}

/// For every step, or not at all. Returns how many rows there are.
std::size_t read_final_path(const std::string& path, Run& run) {
  if (!fs::exists(path)) return 0;
  for_each_row(path, final_trajectory_table,
               [&](const RunRow& row) { run.final_path.push_back(read_stamped_pose(row).T_world_robot); });
  const std::size_t rows = run.final_path.size();
  if (rows != run.steps.size()) run.final_path.clear();
  return rows;
}

/// Reports which growing tables have fewer rows than the steps imply; health.csv states how many there were.
void tell_missing_steps(const std::string& folder, const RunTables& tables, std::size_t steps,
                        std::vector<std::string>& missing) {
  std::size_t associations = 0, decisions = 0, merges = 0, clouds = 0;
  for (const HealthRow& health : tables.health) {
    associations += health.association_rows;
    decisions += health.decision_rows;
    merges += health.merge_rows;
    clouds += health.cloud_rows;
  }
  const auto tell = [&](const RunTable& table, std::size_t found, std::size_t expected) {
    tell_missing(folder, table.file, found, expected, missing);
  };
  tell(health_table, tables.health.size(), steps);
  tell(trajectory_table, tables.trajectory.size(), steps);
  tell(associations_table, tables.associations.size(), associations);
  tell(decisions_table, tables.decisions.size(), decisions);
  tell(merges_table, tables.merges.size(), merges);
  tell(clouds_table, tables.particles.size(), clouds);
}

bool has_truth(const std::string& folder) {
  return std::any_of(std::begin(run_files), std::end(run_files), [&](std::string_view name) {
    return name.substr(0, 6) == "truth_" && fs::exists(folder + '/' + std::string(name));
  });
}

}  // namespace

namespace {

/// Columns of a map.csv: one of four kinds, depending on what was reported of landmarks.
struct MapColumns {
  RunTable table;
  bool with_appearance = false, with_names = false;
};

MapColumns columns_of_map(const std::string& path) {
  for (const MapColumns& columns :
       {MapColumns{map_table_with_appearance_and_names, true, true}, MapColumns{map_table_with_appearance, true, false},
        MapColumns{map_table_with_names, false, true}}) {
    if (begins_with(path, columns.table)) return columns;
  }
  return {map_table};
}

}  // namespace

std::vector<core::MapLandmark> read_map(const std::string& path) {
  std::vector<core::MapLandmark> map;
  const MapColumns columns = columns_of_map(path);
  for_each_row(path, columns.table, [&](const RunRow& row) {
    core::MapLandmark& landmark = map.emplace_back();
    landmark.id = small_integer(row, 0);
    landmark.point.mean_m = {row.finite(1), row.finite(2)};
    landmark.point.covariance_m2 = symmetric<2>(row, 3);
    if (!landmark.point.covariance_m2.allFinite()) row.refuse(3, "finite numbers in it and the next two columns");
    landmark.observations = small_integer(row, 6);
    landmark.state = enumerator<core::LandmarkState>(row, 7, state_words);
    if (columns.with_appearance) landmark.appearance = read_appearance(row, 8);
  });
  return map;
}

std::map<core::LandmarkId, std::string> read_landmark_names(const std::string& path) {
  std::map<core::LandmarkId, std::string> names;
  const MapColumns columns = columns_of_map(path);
  if (!columns.with_names) return names;
  for_each_row(path, columns.table, [&](const RunRow& row) {
    const std::string_view name = row.text(columns.with_appearance ? 12 : 8);
    if (!name.empty()) names[small_integer(row, 0)] = name;
  });
  return names;
}

namespace {

/// [folder] of the robots of a team whose run folder this is; few enough for a message.
std::string robot_folders(const std::string& path) {
  std::string text;
  constexpr int most = 100;
  for (int robot = 1; robot <= most; ++robot) {
    const std::string folder = path + "/robot_" + std::to_string(robot);
    if (fs::exists(folder + '/' + manifest_file)) text += (text.empty() ? "" : ", ") + folder;
  }
  return text;
}

}  // namespace

RunManifest read_manifest(const std::string& path) {
  const std::string manifest = path + '/' + manifest_file;
  if (!fs::exists(manifest)) {
    const std::string robots = robot_folders(path);
    if (!robots.empty()) {
      throw core::InputError(path + ": the folder of a team of robots; each has a run folder of its own: " + robots);
    }
    if (fs::exists(path + "/joins.csv")) {
      throw core::InputError(
          path +
          ": the folder of a joined map, which is no run and has no drive: joins.csv says how each run was placed, "
          "changes.csv what changed between them, report.html draws both; replay --map and join go on in it");
    }
    throw core::InputError(path + ": not a run folder: expected a file " + manifest_file + " in it");
  }
  return manifest_from_text(manifest, files::read_whole_file(manifest));
}

Run read_run(const std::string& path) {
  Run run;
  run.path = path;
  run.manifest = read_manifest(path);
  RunTables tables = read_tables(path);
  run.finished = fs::exists(path + '/' + summary_file);
  const SaidOfRun said = run.finished ? read_said(path + '/' + summary_file) : SaidOfRun{};
  if (run.finished) tell_missing_steps(path, tables, said.steps.value_or(0), run.missing);
  assemble(tables, run);
  bring_into_map(run);
  const std::string final_file(final_trajectory_table.file);
  const std::size_t final_rows = read_final_path(path + '/' + final_file, run);
  if (fs::exists(path + '/' + final_file))
    tell_missing(path, final_file, final_rows, said.steps.value_or(0), run.missing);
  if (fs::exists(path + "/map.csv")) {
    run.map = read_map(path + "/map.csv");
    run.names = read_landmark_names(path + "/map.csv");
  }
  tell_missing(path, "map.csv", run.map.size(), said.landmarks.value_or(0), run.missing);
  tell_missing_rows(path, said, run.missing);
  if (run.finished) tell_cut_drive(path, said.steps.value_or(0), run.missing);
  if (has_truth(path)) run.truth = read_truth(path);
  bring_truth_into_map(run);
  return run;
}

}  // namespace helixnav::runs
