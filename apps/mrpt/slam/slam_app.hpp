// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>

#include <mrpt/apps/BaseAppInitializableCLI.h>

#include "slam/slam_run.hpp"

namespace CLI {
class App;
}

namespace helixnav::apps {

/// The program helixnav-slam, structured like MRPT's: initialised from the command line, then run.
class SlamApp : public mrpt::apps::BaseAppInitializableCLI {
 public:
  SlamApp();
  ~SlamApp() override;

  /// CLI::ParseError if the arguments are wrong or ask for help or version.
  void initialize(int argc, const char** argv) { impl_initialize(argc, argv); }

  /// As run_slam, with the inputs named on the command line.
  ExitCode run() const { return run_slam(job_); }

  CLI::App& command_line() { return *command_line_; }

 protected:
  void impl_initialize(int argc, const char** argv) override;
  std::string impl_get_usage() const override;

 private:
  std::unique_ptr<CLI::App> command_line_;
  SlamJob job_;
};

}  // namespace helixnav::apps
