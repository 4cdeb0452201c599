// SPDX-License-Identifier: BSD-3-Clause
#include <CLI/CLI.hpp>

#include "program.hpp"
#include "slam_run.hpp"

int main(int argc, char** argv) {
  using namespace helixnav::apps;
  CLI::App app{"Landmark SLAM along an MRPT rawlog, with the configuration files of kf-slam.", "helixnav-slam"};
  SlamJob job;
  job.command_line.assign(argv, argv + argc);
  app.add_option("CONFIG", job.config, "INI file as for kf-slam; a section [HelixNav] may stand beside")->required();
  app.add_option("RAWLOG", job.rawlog,
                 "Rawlog, compressed or not, of frames or of single observations; without, the "
                 "file's rawlog_file");
  app.add_option("--out", job.out, "Folder for the results, instead of the file's logOutput_dir")->type_name("DIR");
  app.add_flag("--overwrite", job.overwrite, "Replace the files of an earlier run in that folder");
  app.add_flag("--quiet", job.quiet, "No progress bar, no list of keys without effect");
  app.footer(
      "Sections: [MappingApplication], [RangeBearingKFSLAM], [RangeBearingKFSLAM_KalmanFilter] as they are, "
      "[HelixNav]\n"
      "for what kf-slam has no key for. All keys: docs/mrpt.md.\n\n"
      "Exit codes:\n"
      "  0    done\n"
      "  2    usage: the command line is wrong\n"
      "  3    data: configuration or rawlog cannot be used, or only in part, or the folder is not empty\n"
      "  4    numerical: the mathematics broke down\n"
      "  130  interrupted: the results are complete up to the last step\n\n"
      "Examples:\n"
      "  helixnav-slam EKF-SLAM_test_2d.ini kf-slam_demo.rawlog\n"
      "  helixnav convert victoria_park_ascii.zip park.rawlog; helixnav-slam park.ini park.rawlog --out runs/park\n");
  return run_program(app, argc, argv, [&job] { return run_slam(job); });
}
