// SPDX-License-Identifier: BSD-3-Clause
#include "arrays.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <limits>
#include <string>

#include "helixnav/core/errors.hpp"

namespace helixnav::python {
namespace {

constexpr auto most_identity = static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max());

std::string tuple_text(const py::ssize_t* shape, py::ssize_t dimensions) {
  std::string text = "(";
  for (py::ssize_t i = 0; i < dimensions; ++i) text += (i > 0 ? ", " : "") + std::to_string(shape[i]);
  return text + (dimensions == 1 ? ",)" : ")");
}

Array shaped(const py::handle& value, const char* name, std::initializer_list<py::ssize_t> shape) {
  Array array = numbers_from(value, name);
  const auto dimensions = static_cast<py::ssize_t>(shape.size());
  if (array.ndim() == dimensions && std::equal(shape.begin(), shape.end(), array.shape())) return array;
  throw core::PreconditionError(std::string(name) + ": expected an array of shape " +
                                tuple_text(shape.begin(), dimensions) + ", found " + shape_text(array));
}

}  // namespace

Array numbers_from(const py::handle& value, const char* name) {
  const py::array array = py::array::ensure(value);
  if (!array || std::strchr("iufb", array.dtype().kind()) == nullptr) {
    const std::string found = array ? "an array of " + std::string(py::str(array.dtype())) : "rows of unequal length";
    throw py::type_error(std::string(name) + ": expected real numbers, found " + found);
  }
  return py::array_t<double, py::array::c_style | py::array::forcecast>(array);
}

Eigen::Vector2d vector2_from(const py::handle& value, const char* name) {
  return Eigen::Map<const Eigen::Vector2d>(shaped(value, name, {2}).data());
}

Eigen::Vector3d vector3_from(const py::handle& value, const char* name) {
  return Eigen::Map<const Eigen::Vector3d>(shaped(value, name, {3}).data());
}

Eigen::Matrix2d matrix2_from(const py::handle& value, const char* name) {
  return Eigen::Map<const Eigen::Matrix<double, 2, 2, Eigen::RowMajor>>(shaped(value, name, {2, 2}).data());
}

Eigen::Matrix3d matrix3_from(const py::handle& value, const char* name) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(shaped(value, name, {3, 3}).data());
}

std::vector<std::int64_t> identities_from(const py::handle& value) {
  const py::array array = py::array::ensure(value);
  const bool whole = array && (array.size() == 0 || std::strchr("iu", array.dtype().kind()) != nullptr);
  if (!whole || array.ndim() != 1) throw py::type_error("identities: expected a row of whole numbers");
  if (array.dtype().kind() == 'u' && array.itemsize() == 8) {
    const py::array_t<std::uint64_t, py::array::c_style | py::array::forcecast> unsigned_numbers(array);
    const std::uint64_t* const begin = unsigned_numbers.data();
    const bool fit =
        std::all_of(begin, begin + array.size(), [](std::uint64_t number) { return number <= most_identity; });
    if (!fit) throw core::PreconditionError("identities: expected whole numbers below 2**63");
  }
  const py::array_t<std::int64_t, py::array::c_style | py::array::forcecast> numbers(array);
  return {numbers.data(), numbers.data() + numbers.size()};
}

std::string shape_text(const Array& array) { return tuple_text(array.shape(), array.ndim()); }

std::filesystem::path path_from(const py::handle& value, const char* name) {
  const bool is_path = py::isinstance<py::str>(value) || py::isinstance<py::bytes>(value);
  if (is_path || py::hasattr(value, "__fspath__")) return value.cast<std::filesystem::path>();
  throw py::type_error(std::string(name) + ": expected a path or a JointMap, found " +
                       std::string(py::str(py::type::handle_of(value).attr("__name__"))));
}

std::string utf8_from(const py::handle& text, const char* name) {
  Py_ssize_t size = 0;
  const char* const bytes = PyUnicode_AsUTF8AndSize(text.ptr(), &size);
  if (bytes != nullptr) return {bytes, static_cast<std::size_t>(size)};
  PyErr_Clear();
  throw core::PreconditionError(std::string(name) + ": expected text, found half of a surrogate pair in it");
}

py::str text_with_paths(const std::string& bytes) {
  PyObject* const text = PyUnicode_DecodeFSDefaultAndSize(bytes.data(), static_cast<Py_ssize_t>(bytes.size()));
  if (text == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(text);
}

py::list texts_with_paths(const std::vector<std::string>& texts) {
  py::list list;
  for (const std::string& text : texts) list.append(text_with_paths(text));
  return list;
}

core::Nanoseconds time_from(double t_s) {
  constexpr double most_s = 9.2e9;
  if (std::abs(t_s) <= most_s) return core::nanoseconds_from_seconds(t_s);
  throw core::PreconditionError("t: expected seconds within ±9.2e9, found " + std::to_string(t_s));
}

}  // namespace helixnav::python
