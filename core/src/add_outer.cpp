// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/core/add_outer.hpp"

#include <algorithm>
#include <cstring>

namespace helixnav::core {
namespace {

using Index = Eigen::Index;

/// This many doubles in a vector, which the compiler lowers to what the function's target has. Written out: GCC drops
/// the attribute if its argument depends on a template's.
template <int lanes>
struct Vector;
template <>
struct Vector<2> {
  using Register = double __attribute__((vector_size(16)));
};
template <>
struct Vector<4> {
  using Register = double __attribute__((vector_size(32)));
};
template <>
struct Vector<8> {
  using Register = double __attribute__((vector_size(64)));
};
template <int lanes>
using Register = typename Vector<lanes>::Register;

/// The same where it lies in a matrix, aligned to one double only. A class, because an attribute of a vector type is lost
/// where the type passes through a template: clang then moves it as if it were aligned to its size, and faults.
template <int lanes>
struct __attribute__((packed, aligned(8), may_alias)) Memory {
  Register<lanes> vector;
};
static_assert(sizeof(Memory<8>) == 8 * sizeof(double) && alignof(Memory<8>) == alignof(double));

struct Operands {
  double* C;
  Index stride_C;
  const double* A;
  Index stride_A;
  const double* B;
  Index stride_B;
  Index depth;
};

/// One tile of Blocks·lanes rows × Cols columns, kept in registers through the whole depth. The loops over the tile are
/// unrolled by order: at -O2, the flags of most packages, GCC would leave them, and the sums in memory, six times slower.
template <int lanes, int Blocks, int Cols>
__attribute__((always_inline)) inline void tile(const Operands& o, Index i, Index j) {
  Register<lanes> sum[Cols][Blocks];
  double* const c = o.C + i + j * o.stride_C;
#pragma GCC unroll 8
  for (int q = 0; q < Cols; ++q) {
#pragma GCC unroll 8
    for (int b = 0; b < Blocks; ++b)
      sum[q][b] = reinterpret_cast<const Memory<lanes>*>(c + q * o.stride_C + b * lanes)->vector;
  }
  const double* a = o.A + i;
  const double* bt = o.B + j;
  for (Index k = 0; k < o.depth; ++k, a += o.stride_A, bt += o.stride_B) {
    Register<lanes> left[Blocks];
#pragma GCC unroll 8
    for (int b = 0; b < Blocks; ++b) left[b] = reinterpret_cast<const Memory<lanes>*>(a + b * lanes)->vector;
#pragma GCC unroll 8
    for (int q = 0; q < Cols; ++q) {
      const double right = bt[q];
#pragma GCC unroll 8
      for (int b = 0; b < Blocks; ++b) sum[q][b] += left[b] * right;
    }
  }
#pragma GCC unroll 8
  for (int q = 0; q < Cols; ++q) {
#pragma GCC unroll 8
    for (int b = 0; b < Blocks; ++b)
      reinterpret_cast<Memory<lanes>*>(c + q * o.stride_C + b * lanes)->vector = sum[q][b];
  }
}

/// Rows, a multiple of eight, in tiles of Blocks vectors and, what these leave over, in tiles of eight rows.
template <int lanes, int Blocks, int Cols>
__attribute__((always_inline)) inline void columns(const Operands& o, Index rows, Index j) {
  constexpr Index tall = Blocks * lanes;
  Index i = 0;
  const auto divides = [&](Index rest) { return rest == 0 || rest >= 8; };
  for (; divides(rows - i - tall); i += tall) tile<lanes, Blocks, Cols>(o, i, j);
  constexpr int few = 8 / lanes;  // blocks in eight rows
  for (; i < rows; i += 8) tile<lanes, few, Cols>(o, i, j);
}

template <int lanes, int Blocks, int Cols>
__attribute__((always_inline)) inline void all(const Operands& o, Index rows, Index cols) {
  Index j = 0;
  for (; j + Cols <= cols; j += Cols) columns<lanes, Blocks, Cols>(o, rows, j);
  for (; j + 2 <= cols; j += 2) columns<lanes, Blocks, 2>(o, rows, j);
  for (; j < cols; ++j) columns<lanes, Blocks, 1>(o, rows, j);
}

void all_baseline(const Operands& o, Index rows, Index cols) { all<2, 4, 2>(o, rows, cols); }

using Kernel = void (*)(const Operands&, Index, Index);

#if defined(__x86_64__)
__attribute__((target("avx2,fma"))) void all_avx2(const Operands& o, Index rows, Index cols) {
  all<4, 3, 4>(o, rows, cols);
}
__attribute__((target("avx512f,fma"))) void all_avx512(const Operands& o, Index rows, Index cols) {
  all<8, 2, 8>(o, rows, cols);
}

#else
constexpr Kernel all_avx2 = all_baseline;
constexpr Kernel all_avx512 = all_baseline;
#endif

Kernel kernel_for(Instructions instructions) {
  if (instructions == Instructions::avx512) return all_avx512;
  return instructions == Instructions::avx2 ? all_avx2 : all_baseline;
}

Kernel best_kernel() {
  for (const Instructions instructions : {Instructions::avx512, Instructions::avx2}) {
    if (is_supported(instructions)) return kernel_for(instructions);
  }
  return all_baseline;
}

const Kernel kernel = best_kernel();

}  // namespace

bool is_supported([[maybe_unused]] Instructions instructions) {
#if defined(__x86_64__)
  __builtin_cpu_init();
  if (instructions == Instructions::avx512) return __builtin_cpu_supports("avx512f") != 0;
  if (instructions == Instructions::avx2)
    return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
#endif
  return instructions == Instructions::baseline;
}

void add_outer_with(Instructions instructions, double* C, Index stride_C, Index rows, Index cols, const double* A,
                    Index stride_A, const double* B, Index stride_B, Index depth) {
  if (rows == 0 || cols == 0 || depth == 0) return;
  kernel_for(instructions)({C, stride_C, A, stride_A, B, stride_B, depth}, rows, cols);
}

void add_outer(double* C, Index stride_C, Index rows, Index cols, const double* A, Index stride_A, const double* B,
               Index stride_B, Index depth) {
  if (rows == 0 || cols == 0 || depth == 0) return;
  kernel({C, stride_C, A, stride_A, B, stride_B, depth}, rows, cols);
}

void add_outer_lower(double* C, Index stride_C, Index rows, Index cols, const double* A, Index stride_A,
                     const double* B, Index stride_B, Index depth) {
  constexpr Index panel = 8;
  for (Index j = 0; j < cols; j += panel) {
    add_outer(C + j + j * stride_C, stride_C, rows - j, std::min(panel, cols - j), A + j, stride_A, B + j, stride_B,
              depth);
  }
}

}  // namespace helixnav::core
