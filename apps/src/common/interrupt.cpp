// SPDX-License-Identifier: BSD-3-Clause
#include "interrupt.hpp"

#include <csignal>

namespace helixnav::apps {
namespace {

volatile std::sig_atomic_t interrupt_count = 0;

void on_signal(int signal) {
  interrupt_count = interrupt_count + 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void catch_interrupts() {
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

bool interrupted() { return interrupt_count > 0; }

}  // namespace helixnav::apps
