// SPDX-License-Identifier: BSD-3-Clause
#include "cholesky.hpp"

#include <cholmod.h>

#include <string>

#include "helixnav/core/errors.hpp"

namespace helixnav::smoothing {

struct Cholesky::Impl {
  cholmod_common common;
  cholmod_sparse matrix{};
  cholmod_factor* factor = nullptr;
  cholmod_dense* solution = nullptr;
  cholmod_dense* work_y = nullptr;
  cholmod_dense* work_e = nullptr;
  Ordering ordering = Ordering::amd;

  Impl() { cholmod_start(&common); }
  ~Impl() {
    cholmod_free_dense(&work_e, &common);
    cholmod_free_dense(&work_y, &common);
    cholmod_free_dense(&solution, &common);
    cholmod_free_factor(&factor, &common);
    cholmod_finish(&common);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void require_ok(const char* what) const {
    if (common.status < CHOLMOD_OK) {
      throw core::NumericalError(std::string("smoothing: CHOLMOD's ") + what + " gave status " +
                                 std::to_string(common.status) +
                                 (common.status == CHOLMOD_OUT_OF_MEMORY ? " (out of memory)" : ""));
    }
  }
};

namespace {

void choose_orderings(cholmod_common& common, Ordering ordering) {
  common.method[0].ordering = ordering == Ordering::metis ? CHOLMOD_METIS : CHOLMOD_AMD;
  common.method[1].ordering = CHOLMOD_METIS;
  common.nmethods = ordering == Ordering::least_fill ? 2 : 1;
}

}  // namespace

Cholesky::Cholesky(const std::vector<int>& column_start, const std::vector<int>& row_index, Ordering ordering)
    : impl_(std::make_unique<Impl>()) {
  cholmod_common& common = impl_->common;
  common.supernodal = CHOLMOD_SIMPLICIAL;
  common.final_asis = 0;
  common.final_super = 0;
  common.final_ll = 1;
  common.print = 0;
  choose_orderings(common, ordering);

  cholmod_sparse& matrix = impl_->matrix;
  matrix.nrow = matrix.ncol = column_start.size() - 1;
  matrix.nzmax = row_index.size();
  // CHOLMOD reads the pattern through pointers to non-const and does not write.
  matrix.p = const_cast<int*>(column_start.data());
  matrix.i = const_cast<int*>(row_index.data());
  matrix.stype = 1;
  matrix.itype = CHOLMOD_INT;
  matrix.xtype = CHOLMOD_PATTERN;
  matrix.dtype = CHOLMOD_DOUBLE;
  matrix.sorted = 1;
  matrix.packed = 1;
  impl_->factor = cholmod_analyze(&matrix, &common);
  impl_->require_ok("analysis");
  impl_->ordering = common.method[common.selected].ordering == CHOLMOD_METIS ? Ordering::metis : Ordering::amd;
}

Cholesky::~Cholesky() = default;

int Cholesky::factorize(const std::vector<double>& values, double smallest_pivot) {
  impl_->matrix.x = const_cast<double*>(values.data());
  impl_->matrix.xtype = CHOLMOD_REAL;
  cholmod_factorize(&impl_->matrix, impl_->factor, &impl_->common);
  impl_->require_ok("factorisation");
  const FactorView L = factor();
  if (impl_->factor->minor < impl_->factor->n) return L.permutation[impl_->factor->minor];
  const int* column_start = static_cast<const int*>(impl_->matrix.p);
  for (int k = 0; k < L.columns; ++k) {
    const int column = L.permutation[k];
    const double pivot = L.values[L.column_start[k]];
    const double diagonal = values[static_cast<std::size_t>(column_start[column + 1] - 1)];
    if (!(pivot * pivot > smallest_pivot * diagonal)) return column;
  }
  return -1;
}

void Cholesky::solve(const Eigen::VectorXd& b, Eigen::VectorXd& x) {
  cholmod_dense rhs{};
  rhs.nrow = rhs.d = rhs.nzmax = static_cast<std::size_t>(b.size());
  rhs.ncol = 1;
  rhs.x = const_cast<double*>(b.data());
  rhs.xtype = CHOLMOD_REAL;
  rhs.dtype = CHOLMOD_DOUBLE;
  cholmod_solve2(CHOLMOD_A, impl_->factor, &rhs, nullptr, &impl_->solution, nullptr, &impl_->work_y, &impl_->work_e,
                 &impl_->common);
  impl_->require_ok("solve");
  x = Eigen::Map<const Eigen::VectorXd>(static_cast<const double*>(impl_->solution->x), b.size());
}

FactorView Cholesky::factor() const {
  const cholmod_factor& L = *impl_->factor;
  FactorView view;
  view.columns = static_cast<int>(L.n);
  view.column_start = static_cast<const int*>(L.p);
  view.column_size = static_cast<const int*>(L.nz);
  view.row_index = static_cast<const int*>(L.i);
  view.values = static_cast<const double*>(L.x);
  view.permutation = static_cast<const int*>(L.Perm);
  return view;
}

Ordering Cholesky::ordering_kept() const { return impl_->ordering; }

double Cholesky::nonzeros() const { return impl_->common.method[impl_->common.selected].lnz; }

}  // namespace helixnav::smoothing
