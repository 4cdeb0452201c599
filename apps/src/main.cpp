// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include <malloc.h>

#include <CLI/CLI.hpp>

#include "common/commands.hpp"
#include "common/exit_code.hpp"
#include "common/help_pages.hpp"
#include "common/run_options.hpp"
#include "common/usage_error.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/version.hpp"

namespace helixnav::apps {
namespace {

ExitCode fail(ExitCode code, const char* what) {
  std::fprintf(stderr, "helixnav: %s\n", what);
  return code;
}

/// Output that cannot be written is lost silently, unless somebody checks.
ExitCode check_output(ExitCode code) {
  errno = 0;
  std::cout.flush();
  const bool lost = std::fflush(stdout) != 0 || std::ferror(stdout) != 0 || !std::cout;
  if (!lost || code != ExitCode::ok) return code;
  const std::string why = errno != 0 ? std::string(": ") + std::strerror(errno) : std::string();
  return fail(ExitCode::data, ("the standard output cannot be written, and what was printed is lost" + why).c_str());
}

/// Large matrices are returned to the system when they are freed. glibc raises the size from which this happens to that of
/// the largest freed so far, up to 32 MB; from then on they leave holes in its heap, a fifth of the memory of a drive
/// through a forest.
void give_back_large_matrices() {
#ifdef M_MMAP_THRESHOLD
  constexpr int least_bytes = 4 << 20;
  mallopt(M_MMAP_THRESHOLD, least_bytes);
#endif
}

ExitCode run(int argc, char** argv) {
  CLI::App app{"Landmark navigation with an exact compressed EKF.", "helixnav"};
  const std::string version = "helixnav " + std::string(core::version()) + " (" + std::string(core::commit()) + ")";
  app.set_version_flag("--version", version, "Print the version and exit");
  app.require_subcommand(1);
  app.fallthrough(false);
  use_short_help(app);
  app.footer(
      "helixnav COMMAND --help (or helixnav help COMMAND) says more.\n\n"
      "Exit codes:\n"
      "  0    done\n"
      "  2    usage: the command line or the configuration file is wrong\n"
      "  3    data: a log, run folder or truth cannot be used, --out is not empty, or output cannot be written\n"
      "  4    numerical: the mathematics broke down\n"
      "  130  interrupted: the run folder is complete up to the last step\n");

  remember_command_line(argc, argv);
  ExitCode code = ExitCode::ok;
  add_replay_command(app, code);
  add_stream_command(app, code);
  add_smooth_command(app, code);
  add_convert_command(app, code);
  add_simulate_command(app, code);
  add_join_command(app, code);
  add_montecarlo_command(app, code);
  add_evaluate_command(app, code);
  add_explain_command(app, code);
  add_associate_command(app, code);
  add_check_command(app, code);
  add_new_vehicle_command(app, code);
  add_calibrate_command(app, code);
  add_config_command(app, code);
  for (CLI::App* command : app.get_subcommands({})) {
    command->set_version_flag("--version", version, "Print the version and exit");
  }
  if (argc < 2) return fail(ExitCode::usage, ("a command is missing\n\n" + app.help()).c_str());
  try {
    std::vector<std::string> words = without_help_word(app, {argv, argv + argc});
    words.erase(words.begin());
    std::reverse(words.begin(), words.end());  // as parse expects them
    app.parse(std::move(words));
    return check_output(code);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) {  // --help, --version
      app.exit(error);
      return check_output(ExitCode::ok);
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
  helixnav::apps::give_back_large_matrices();
  using helixnav::apps::ExitCode;
  try {
    return static_cast<int>(helixnav::apps::run(argc, argv));
  } catch (const std::exception& error) {
    std::fprintf(stderr, "helixnav: internal error: %s\n", error.what());
    return static_cast<int>(ExitCode::numerical);
  }
}
