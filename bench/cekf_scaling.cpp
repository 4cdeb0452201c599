// SPDX-License-Identifier: BSD-3-Clause
//
// Prints one table: step time of the compressed EKF (predict + joint update with 8 observations, 40 active landmarks) and
// its region switch, by the number of landmarks mapped, beside a plain dsyrk of the same size where a BLAS was found.
// Times are processor time of one thread.
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <vector>

#include "cekf_world.hpp"

#ifdef HELIXNAV_BENCH_BLAS
extern "C" void dsyrk_(const char* uplo, const char* trans, const int* n, const int* k, const double* alpha,
                       const double* A, const int* lda, const double* beta, double* C, const int* ldc);
#endif

namespace {

using namespace helixnav;

double seconds_of_this_thread() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

struct StepTimes {
  double median_us;
  double p99_us;
};

StepTimes time_steps(bench::CekfWorld& world, int steps) {
  std::vector<double> us;
  for (int k = 0; k < steps; ++k) {
    const std::vector<cekf::Match>& matches = world.look();
    const double start = seconds_of_this_thread();
    world.filter.predict(world.odometry());
    world.filter.update(matches);
    us.push_back(1e6 * (seconds_of_this_thread() - start));
  }
  std::sort(us.begin(), us.end());
  return {us[us.size() / 2], us[us.size() * 99 / 100]};
}

/// Gflop/s of C (n × n) −= A·Aᵀ, A n × k, by the BLAS of the machine; 0 without one.
double dsyrk_gflops([[maybe_unused]] int n, [[maybe_unused]] int k) {
#ifdef HELIXNAV_BENCH_BLAS
  const auto size = [](int a, int b) { return static_cast<std::size_t>(a) * static_cast<std::size_t>(b); };
  std::vector<double> A(size(n, k), 0.5);
  std::vector<double> C(size(n, n), 1.0);
  const double minus = -1.0;
  const double one = 1.0;
  const double start = seconds_of_this_thread();
  dsyrk_("L", "N", &n, &k, &minus, A.data(), &n, &one, C.data(), &n);
  return 1e-9 * n * n * k / (seconds_of_this_thread() - start);
#else
  return 0.0;
#endif
}

void print_row(cekf::Retraction retraction, int landmarks) {
  constexpr int active = 40;
  bench::CekfWorld world(retraction, landmarks, active);
  const StepTimes step = time_steps(world, 2000);
  const double start = seconds_of_this_thread();
  world.filter.global_update();
  const double switch_s = seconds_of_this_thread() - start;

  const double n = 2.0 * landmarks;
  const bool turns = retraction == cekf::Retraction::right_invariant;
  const double a = 3 + 2 * active;
  const double q = turns ? 2 * a : a;
  const double flops = n * n * q + 2 * n * q * q + 2 * n * q * a;  // P_bb, response, P_ab
  const double gflops = 1e-9 * flops / switch_s;
  const double plain = dsyrk_gflops(static_cast<int>(n), static_cast<int>(q));
  std::printf("%-15s %6d %10.1f %10.1f %12.1f %9.1f %9.1f", turns ? "right_invariant" : "standard", landmarks,
              step.median_us, step.p99_us, 1e3 * switch_s, gflops, plain);
  std::printf(plain > 0 ? " %7.0f %%\n" : "       -\n", 100.0 * gflops / plain);
  std::fflush(stdout);
}

}  // namespace

int main() {
#ifdef HELIXNAV_BENCH_BLAS
  std::printf("plain dsyrk by %s\n", HELIXNAV_BENCH_BLAS);
#endif
  std::printf("%-15s %6s %10s %10s %12s %9s %9s %9s\n", "retraction", "N", "step µs", "p99 µs", "switch ms", "Gflop/s",
              "dsyrk", "ratio");
  for (const auto retraction : {cekf::Retraction::standard, cekf::Retraction::right_invariant}) {
    for (const int landmarks : {100, 1000, 2000, 5000}) print_row(retraction, landmarks);
  }
  return 0;
}
