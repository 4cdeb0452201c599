// SPDX-License-Identifier: BSD-3-Clause
#include "appearance.hpp"

#include <cmath>
#include <cstddef>
#include <limits>

#include "arrays.hpp"
#include "helixnav/core/errors.hpp"

namespace helixnav::python {
namespace {

/// [i] of an array that must be as long as the scan; of a scalar, the same for all.
double entry_of(const Array& values, std::size_t i, std::size_t count, const char* name) {
  if (values.ndim() == 0) return *values.data();
  if (values.ndim() == 1 && values.shape(0) == static_cast<py::ssize_t>(count)) return values.data()[i];
  throw core::PreconditionError(std::string(name) + ": expected one number or " + std::to_string(count) +
                                ", found an array of shape " + shape_text(values));
}

}  // namespace

void tell_appearance(const py::object& classes, const py::object& sizes, const py::object& sigma_sizes,
                     double class_error, core::Scan& scan) {
  const std::size_t count = scan.observations.size();
  if (!classes.is_none()) {
    const py::sequence names = py::reinterpret_borrow<py::sequence>(classes);
    if (names.size() != count)
      throw core::PreconditionError("classes: expected " + std::to_string(count) + " names, found " +
                                    std::to_string(names.size()));
    for (std::size_t i = 0; i < count; ++i) {
      if (names[i].is_none()) continue;
      if (!py::isinstance<py::str>(names[i])) throw py::type_error("classes: expected names or None");
      scan.observations[i].appearance.name = core::ClassName(utf8_from(names[i], "classes"));
      scan.observations[i].appearance.class_error = class_error;
    }
  }
  if (sizes.is_none()) return;
  const Array size_m = numbers_from(sizes, "sizes");
  const Array sigma_m = numbers_from(sigma_sizes, "sigma_sizes");
  for (std::size_t i = 0; i < count; ++i) {
    const double one_m = entry_of(size_m, i, count, "sizes");
    if (std::isnan(one_m)) continue;
    if (!(one_m > 0.0))
      throw core::PreconditionError("sizes: expected sizes above 0, or NaN, found " + std::to_string(one_m));
    scan.observations[i].appearance.size_m = one_m;
    scan.observations[i].appearance.sigma_size_m = entry_of(sigma_m, i, count, "sigma_sizes");
  }
}

std::vector<std::string> classes_of(const core::Scan& scan) {
  std::vector<std::string> names;
  for (const core::Observation& one : scan.observations) names.emplace_back(one.appearance.name.text());
  return names;
}

py::array_t<double> sizes_of(const core::Scan& scan, double core::Appearance::*value) {
  py::array_t<double> sizes(static_cast<py::ssize_t>(scan.observations.size()));
  double* to = sizes.mutable_data();
  for (const core::Observation& one : scan.observations) {
    const bool given = one.appearance.size_m > 0.0;
    *to++ = given ? one.appearance.*value : std::numeric_limits<double>::quiet_NaN();
  }
  return sizes;
}

}  // namespace helixnav::python
