// SPDX-License-Identifier: BSD-3-Clause
#include "interrupt.hpp"

#include <unistd.h>

#include <csignal>
#include <ctime>

#include "exit_code.hpp"

namespace helixnav::apps {
namespace {

volatile std::sig_atomic_t interrupt_count = 0;
volatile std::sig_atomic_t noticed = 0;
volatile std::sig_atomic_t has_timer = 0;
timer_t timer;

itimerspec once{};  // until the end of patience

/// Only what POSIX allows in a handler: of the timer calls, timer_settime.
void on_signal(int signal) {
  interrupt_count = interrupt_count + 1;
  std::signal(signal, SIG_DFL);
  if (has_timer != 0) timer_settime(timer, 0, &once, nullptr);
}

/// A step, a solution or an evaluation in progress may take minutes. A run folder that is written step by step is complete up to
/// its last step at any time.
void on_end_of_patience(int) {
  if (noticed != 0) return;
  constexpr char words[] = "helixnav: interrupted in the middle of a step; what had been written until then is whole\n";
  const ssize_t ignored = ::write(STDERR_FILENO, words, sizeof words - 1);
  static_cast<void>(ignored);
  ::_exit(static_cast<int>(ExitCode::interrupted));
}

void make_timer() {
  sigevent event{};
  event.sigev_notify = SIGEV_SIGNAL;
  event.sigev_signo = SIGALRM;
  std::signal(SIGALRM, on_end_of_patience);
  has_timer = timer_create(CLOCK_MONOTONIC, &event, &timer) == 0 ? 1 : 0;
}

}  // namespace

void catch_interrupts(std::chrono::milliseconds patience) {
  once.it_value.tv_sec = patience.count() / 1000;
  once.it_value.tv_nsec = 1'000'000 * (patience.count() % 1000);
  make_timer();
  std::signal(SIGINT, on_signal);
  std::signal(SIGTERM, on_signal);
}

bool interrupt_pending() { return interrupt_count > 0; }

bool interrupted() {
  if (!interrupt_pending()) return false;
  noticed = 1;
  return true;
}

}  // namespace helixnav::apps
