// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <exception>
#include <string>

#include <CLI/CLI.hpp>

#include "commands.hpp"
#include "exit_code.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/version.hpp"
#include "run_options.hpp"
#include "usage_error.hpp"

namespace helixnav::apps {
namespace {

ExitCode fail(ExitCode code, const char* what) {
  std::fprintf(stderr, "helixnav: %s\n", what);
  return code;
}

ExitCode run(int argc, char** argv) {
  CLI::App app{"Landmark navigation with an exact compressed EKF.", "helixnav"};
  app.set_version_flag("--version",
                       "helixnav " + std::string(core::version()) + " (" + std::string(core::commit()) + ")");
  app.require_subcommand(1);
  app.fallthrough(false);
  app.footer("helixnav COMMAND --help says more.  Exit codes: 0 ok, 2 usage, 3 data, 4 numerical, 130 interrupted.");

  remember_command_line(argc, argv);
  ExitCode code = ExitCode::ok;
  add_replay_command(app, code);
  add_simulate_command(app, code);
  add_evaluate_command(app, code);
  add_config_command(app, code);
  try {
    app.parse(argc, argv);
    return code;
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      app.exit(error);
      return ExitCode::ok;
    }
    return fail(ExitCode::usage, explain_usage_error(app, error).c_str());
  } catch (const core::InputError& error) {
    return fail(ExitCode::data, error.what());
  } catch (const core::NumericalError& error) {
    return fail(ExitCode::numerical, error.what());
  }
}

}  // namespace
}  // namespace helixnav::apps

int main(int argc, char** argv) {
  using helixnav::apps::ExitCode;
  try {
    return static_cast<int>(helixnav::apps::run(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "helixnav: internal error: %s\n", error.what());
    return static_cast<int>(ExitCode::numerical);
  }
}
