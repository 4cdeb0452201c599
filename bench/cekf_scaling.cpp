// SPDX-License-Identifier: BSD-3-Clause
//
// Prints one table: step time of the compressed EKF (predict + joint update with 8 observations, 40 active landmarks) and
// its region switch, by the number of landmarks mapped, beside a plain dsyrk of the same size if a BLAS was found.
// Maps of all sizes take turns, and so do switch and dsyrk, so that a change in the machine's speed affects all alike.
// Times are processor time of one thread.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <vector>

#include "cekf_world.hpp"
#include "measures.hpp"

#ifdef HELIXNAV_BENCH_BLAS
extern "C" void dsyrk_(const char* uplo, const char* trans, const int* n, const int* k, const double* alpha,
                       const double* A, const int* lda, const double* beta, double* C, const int* ldc);
extern "C" __attribute__((weak)) void openblas_set_num_threads(int);
#endif

namespace {

using namespace helixnav;

constexpr int active = 40;

/// Of the given values, which it sorts.
double quantile(std::vector<double>& values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

struct Row {
  explicit Row(cekf::Retraction retraction, int landmarks) : world(retraction, landmarks, active) {}

  bench::CekfWorld world;
  std::vector<double> step_us;
  std::vector<double> switch_gflops;
  std::vector<double> dsyrk_gflops;
};

void time_steps(Row& row, int steps) {
  for (int k = 0; k < steps; ++k) {
    const std::vector<cekf::Match>& matches = row.world.look();
    const double start = bench::seconds_of_this_thread();
    row.world.filter.predict(row.world.odometry());
    row.world.filter.update(matches);
    row.step_us.push_back(1e6 * (bench::seconds_of_this_thread() - start));
  }
}

/// What the switch of a phase with this many weights subtracts: rows, and columns of the product.
struct Size {
  int n;
  int q;
};

Size size_of(const cekf::CompressedEkf& filter) {
  const bool turns = filter.options().retraction == cekf::Retraction::right_invariant;
  return {2 * filter.mapped_count(), (turns ? 2 : 1) * (3 + 2 * active)};
}

void time_switch(Row& row) {
  const Size size = size_of(row.world.filter);
  const double start = bench::seconds_of_this_thread();
  row.world.filter.global_update();
  const double switch_s = bench::seconds_of_this_thread() - start;
  const double n = size.n;
  const double q = size.q;
  const double flops = n * n * q + 2 * n * q * q + 2 * n * q * (3 + 2 * active);  // P_bb, response, P_ab
  row.switch_gflops.push_back(1e-9 * flops / switch_s);
}

#ifdef HELIXNAV_BENCH_BLAS
/// C (n × n) −= A·Aᵀ, A n × q, by the machine's BLAS, into memory touched before.
class PlainUpdate {
 public:
  explicit PlainUpdate(Size size)
      : size_(size),
        A_(static_cast<std::size_t>(size.n) * static_cast<std::size_t>(size.q), 0.5),
        C_(static_cast<std::size_t>(size.n) * static_cast<std::size_t>(size.n), 1.0) {}

  double gflops() {
    const double minus = -1.0;
    const double one = 1.0;
    const double start = bench::seconds_of_this_thread();
    dsyrk_("L", "N", &size_.n, &size_.q, &minus, A_.data(), &size_.n, &one, C_.data(), &size_.n);
    return 1e-9 * size_.n * size_.n * size_.q / (bench::seconds_of_this_thread() - start);
  }

 private:
  Size size_;
  std::vector<double> A_;
  std::vector<double> C_;
};
#endif

void time_switches(Row& row) {
#ifdef HELIXNAV_BENCH_BLAS
  PlainUpdate plain(size_of(row.world.filter));
#endif
  for (int k = 0; k < 5; ++k) {
    for (int scan = 0; scan < 20; ++scan) {
      row.world.filter.predict(row.world.odometry());
      row.world.filter.update(row.world.look());
    }
    time_switch(row);
#ifdef HELIXNAV_BENCH_BLAS
    row.dsyrk_gflops.push_back(plain.gflops());
#endif
  }
}

void print(Row& row) {
  const bool turns = row.world.filter.options().retraction == cekf::Retraction::right_invariant;
  const double gflops = quantile(row.switch_gflops, 0.5);
  std::printf("%-15s %6d %10.1f %10.1f %10.1f %9.1f", turns ? "right_invariant" : "standard",
              row.world.filter.mapped_count(), quantile(row.step_us, 0.0), quantile(row.step_us, 0.5),
              quantile(row.step_us, 0.99), gflops);
  if (row.dsyrk_gflops.empty()) {
    std::printf("         -       -\n");
  } else {
    const double plain = quantile(row.dsyrk_gflops, 0.5);
    std::printf(" %9.1f %5.0f %%\n", plain, 100.0 * gflops / plain);
  }
  std::fflush(stdout);
}

void print_rows(cekf::Retraction retraction) {
  std::vector<std::unique_ptr<Row>> rows;
  for (const int landmarks : {100, 1000, 2000, 5000}) rows.push_back(std::make_unique<Row>(retraction, landmarks));
  for (int round = 0; round < 20; ++round) {
    for (auto& row : rows) time_steps(*row, 100);
  }
  for (auto& row : rows) {
    time_switches(*row);
    print(*row);
  }
}

}  // namespace

int main() {
#ifdef HELIXNAV_BENCH_BLAS
  if (openblas_set_num_threads != nullptr) openblas_set_num_threads(1);
  std::printf("plain dsyrk by %s\n", HELIXNAV_BENCH_BLAS);
#endif
  std::printf("%-15s %6s %10s %10s %10s %9s %9s %7s\n", "retraction", "N", "least µs", "step µs", "p99 µs", "switch",
              "dsyrk", "ratio");
  std::printf("%-15s %6s %9s %9s %9s %9s %9s\n", "", "", "", "", "", "Gflop/s", "Gflop/s");
  print_rows(cekf::Retraction::standard);
  print_rows(cekf::Retraction::right_invariant);
  return 0;
}
