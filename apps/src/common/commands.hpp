// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "exit_code.hpp"

namespace CLI {
class App;
}

namespace helixnav::apps {

/// Each adds one subcommand to `app`; when the user calls it, it runs within app.parse() and stores its result in
/// `code`, which outlives the parse.
void add_replay_command(CLI::App& app, ExitCode& code);
void add_stream_command(CLI::App& app, ExitCode& code);
void add_smooth_command(CLI::App& app, ExitCode& code);
void add_convert_command(CLI::App& app, ExitCode& code);
void add_simulate_command(CLI::App& app, ExitCode& code);
void add_join_command(CLI::App& app, ExitCode& code);
void add_montecarlo_command(CLI::App& app, ExitCode& code);
void add_evaluate_command(CLI::App& app, ExitCode& code);
void add_explain_command(CLI::App& app, ExitCode& code);
void add_associate_command(CLI::App& app, ExitCode& code);
void add_calibrate_command(CLI::App& app, ExitCode& code);
void add_check_command(CLI::App& app, ExitCode& code);
void add_new_vehicle_command(CLI::App& app, ExitCode& code);
void add_config_command(CLI::App& app, ExitCode& code);

}  // namespace helixnav::apps
