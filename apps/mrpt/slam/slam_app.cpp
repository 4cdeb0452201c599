// SPDX-License-Identifier: BSD-3-Clause
#include "slam/slam_app.hpp"

#include <CLI/CLI.hpp>

namespace helixnav::apps {

SlamApp::SlamApp()
    : command_line_(std::make_unique<CLI::App>(
          "Landmark SLAM along an MRPT rawlog, with the configuration files of kf-slam.", "helixnav-slam")) {
  command_line_->add_option("CONFIG", job_.config, "INI file as for kf-slam; a section [HelixNav] may stand beside")
      ->required();
  command_line_->add_option("RAWLOG", job_.rawlog,
                            "Rawlog, compressed or not, of frames or of single observations; without, the "
                            "file's rawlog_file");
  command_line_->add_option("--out", job_.out, "Folder for the results, instead of the file's logOutput_dir")
      ->type_name("DIR");
  command_line_->add_flag("--overwrite", job_.overwrite, "Replace the files of an earlier run in that folder");
  command_line_->add_flag("--quiet", job_.quiet, "No progress bar, no list of keys without effect");
  command_line_->footer(
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
}

SlamApp::~SlamApp() = default;

void SlamApp::impl_initialize(int argc, const char** argv) {
  job_.command_line.assign(argv, argv + argc);
  command_line_->parse(argc, argv);
}

std::string SlamApp::impl_get_usage() const { return command_line_->help(); }

}  // namespace helixnav::apps
