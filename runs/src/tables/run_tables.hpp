// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace helixnav::runs {

/// Names and header lines of the tables in a run folder: the contract between writer and reader.
/// docs/run-folder.md says what the columns mean.
struct RunTable {
  std::string_view file;
  std::string_view header;
  char separator = ',';
};

inline constexpr RunTable trajectory_table{"trajectory.tum", "# t x y z qx qy qz qw", ' '};
inline constexpr RunTable final_trajectory_table{"trajectory_final.tum", "# t x y z qx qy qz qw", ' '};
inline constexpr RunTable associations_table{"associations.csv",
                                             "step,observation,landmark,outcome,nis,dof,margin_nats,revision"};
inline constexpr RunTable decisions_table{"decisions.csv", "step,t_s,kind,verdict,numbers"};
inline constexpr RunTable health_table{
    "health.csv",
    "step,t_s,mode,sxx,sxy,sxh,syy,syh,shh,nis,dof,active,mapped,switched,association_rows,decision_rows,merge_rows,"
    "cloud_rows,least_pivot,asymmetry,repaired,refused,microseconds"};
/// As written by earlier versions; still read.
inline constexpr RunTable health_table_without_numerics{
    "health.csv",
    "step,t_s,mode,sxx,sxy,sxh,syy,syh,shh,nis,dof,active,mapped,switched,association_rows,decision_rows,merge_rows,"
    "cloud_rows,microseconds"};
inline constexpr RunTable merges_table{"merges.csv", "step,kept,removed"};
inline constexpr RunTable clouds_table{"clouds.csv", "step,x,y,heading"};
inline constexpr RunTable particles_table{"particles.csv",
                                          "step,hypotheses,effective_size,resampled,log_evidence,distinct_ancestors"};
inline constexpr RunTable paths_table{"paths.csv", "point,before,step,x,y,heading,share"};
inline constexpr RunTable mixture_table{"mixture.csv", "id,x,y,sxx,sxy,syy,share,mature_share"};
inline constexpr RunTable map_table{"map.csv", "id,x,y,sxx,sxy,syy,observations,state"};
/// If a class or a size was reported.
inline constexpr RunTable map_table_with_appearance{
    "map.csv", "id,x,y,sxx,sxy,syy,observations,state,class,class_nats,size,sigma_size"};
/// If landmarks were known by name.
inline constexpr RunTable map_table_with_names{"map.csv", "id,x,y,sxx,sxy,syy,observations,state,name"};
inline constexpr RunTable map_table_with_appearance_and_names{
    "map.csv", "id,x,y,sxx,sxy,syy,observations,state,class,class_nats,size,sigma_size,name"};
inline constexpr RunTable truth_poses_table{"truth_poses.csv", "t_s,x,y,heading"};
inline constexpr RunTable truth_frame_table{"truth_frame.csv", "when,known,x,y,heading"};
inline constexpr RunTable truth_positions_table{"truth_positions.csv", "t_s,x,y,antenna_x,antenna_y"};
inline constexpr RunTable truth_landmarks_table{"truth_landmarks.csv", "label,x,y"};
inline constexpr RunTable truth_labels_table{"truth_labels.csv", "step,observation,label"};

inline constexpr const char* manifest_file = "manifest.json";
inline constexpr const char* joint_map_file = "map.bin";
inline constexpr const char* drives_file = "drives.csv";
inline constexpr const char* drive_file = "drive.bin";
inline constexpr const char* summary_file = "summary.json";
inline constexpr const char* report_file = "report.html";

inline constexpr const char* run_files[] = {
    "manifest.json",    "trajectory.tum",  "trajectory_final.tum", "map.csv",
    "associations.csv", "decisions.csv",   "health.csv",           "summary.json",
    "report.html",      "truth_poses.csv", "truth_positions.csv",  "truth_landmarks.csv",
    "truth_labels.csv", "merges.csv",      "clouds.csv",           "map.bin",
    "particles.csv",    "paths.csv",       "mixture.csv",          "drive.bin",
    "truth_frame.csv",  "drives.csv"};

}  // namespace helixnav::runs
