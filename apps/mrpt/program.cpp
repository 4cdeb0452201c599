// SPDX-License-Identifier: BSD-3-Clause
#include "program.hpp"

#include <algorithm>
#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>

#include <mrpt/core/exceptions.h>
#include <mrpt/system/os.h>

#include "common/usage_error.hpp"
#include "helixnav/core/errors.hpp"
#include "helixnav/core/version.hpp"

namespace helixnav::apps {
namespace {

/// Text from a damaged file may contain anything: none of it may move a terminal's cursor.
int fail(const CLI::App& app, ExitCode code, std::string what) {
  const auto commands_terminal = [](unsigned char c) { return (c < 0x20 && c != '\n') || c == 0x7f; };
  std::replace_if(what.begin(), what.end(), commands_terminal, '?');
  std::fprintf(stderr, "%s: %s\n", app.get_name().c_str(), what.c_str());
  return static_cast<int>(code);
}

}  // namespace

std::string version_text(const std::string& program) {
  return program + " " + std::string(core::version()) + " (" + std::string(core::commit()) + ") with " +
         mrpt::system::MRPT_getVersion();
}

int run_program(CLI::App& app, const std::function<ExitCode()>& run) {
  app.set_version_flag("--version", version_text(app.get_name()), "Print the version and exit");
  try {
    return static_cast<int>(run());
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app.exit(error);  // --help, --version
    return fail(app, ExitCode::usage, explain_usage_error(app, error));
  } catch (const core::InputError& error) {
    return fail(app, ExitCode::data, error.what());
  } catch (const core::NumericalError& error) {
    return fail(app, ExitCode::numerical, error.what());
  } catch (const mrpt::ExceptionWithCallBackBase& error) {
    return fail(app, ExitCode::data, error.originalWhat);
  } catch (const std::exception& error) {
    return fail(app, ExitCode::numerical, std::string("internal error: ") + error.what());
  }
}

}  // namespace helixnav::apps
