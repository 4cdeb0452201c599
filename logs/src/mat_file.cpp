// SPDX-License-Identifier: BSD-3-Clause
#include "mat_file.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <matio.h>

#include "helixnav/core/errors.hpp"
#include "input_files.hpp"
#include "mat_bounds.hpp"

namespace helixnav::logs {
namespace {

struct FreeVariable {
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using Variable = std::unique_ptr<matvar_t, FreeVariable>;

template <class Element>
std::vector<double> converted(const matvar_t& variable, std::size_t count) {
  const auto* elements = static_cast<const Element*>(variable.data);
  return std::vector<double>(elements, elements + count);
}

/// The elements as doubles; empty when they are not real numbers.
std::vector<double> numbers(const matvar_t& variable, std::size_t count) {
  if (variable.isComplex != 0) {
    return {};
  }
  switch (variable.class_type) {
    case MAT_C_DOUBLE:
      return converted<double>(variable, count);
    case MAT_C_SINGLE:
      return converted<float>(variable, count);
    case MAT_C_UINT8:
      return converted<std::uint8_t>(variable, count);
    case MAT_C_INT8:
      return converted<std::int8_t>(variable, count);
    case MAT_C_UINT16:
      return converted<std::uint16_t>(variable, count);
    case MAT_C_INT16:
      return converted<std::int16_t>(variable, count);
    case MAT_C_UINT32:
      return converted<std::uint32_t>(variable, count);
    case MAT_C_INT32:
      return converted<std::int32_t>(variable, count);
    default:
      return {};
  }
}

}  // namespace

MatFile::MatFile(const std::filesystem::path& path) : path_(path) {
  check_extent();
  mat_t* file = Mat_Open(path.c_str(), MAT_ACC_RDONLY);
  if (file == nullptr) {
    fail("expected a MATLAB file that can be read");
  }
  file_ = std::shared_ptr<void>(file, [](void* opened) { Mat_Close(static_cast<mat_t*>(opened)); });
  while (const Variable next{Mat_VarReadNextInfo(file)}) {
    variables_.emplace_back(next->name != nullptr ? next->name : "");
  }
}

/// matio reads a truncated file as one full of zeros; the lengths before each variable reveal this. It also descends
/// into cells by recursion, however deep.
void MatFile::check_extent() const {
  constexpr std::size_t header_bytes = 128;
  constexpr std::size_t tag_bytes = 8;
  const std::string content = read_file(path_);
  const std::string mark = content.size() >= header_bytes ? content.substr(126, 2) : std::string();
  if (mark != "IM" && mark != "MI") {
    fail("expected a MATLAB file of version 5 to 7.2");
  }
  for (std::size_t at = header_bytes; at < content.size();) {
    const std::size_t left = content.size() - at;
    const std::size_t length = left < tag_bytes ? 0 : unsigned32(content, at + 4, mark == "IM");
    if (left < tag_bytes || length > left - tag_bytes) {
      fail("byte " + std::to_string(at) + ": expected a variable that ends before the end of the file");
    }
    const std::string_view element = std::string_view(content).substr(at, tag_bytes + length);
    if (const std::string_view bound = broken_bound(element, mark == "IM"); !bound.empty()) {
      fail("byte " + std::to_string(at) + ": expected " + std::string(bound));
    }
    at += tag_bytes + length;
  }
}

bool MatFile::has(const std::string& variable) const {
  return std::find(variables_.begin(), variables_.end(), variable) != variables_.end();
}

/// Decompressed data may be a thousand times as long as the file.
void MatFile::check_size(const std::string& name) const {
  constexpr std::size_t most_elements = 20'000'000;
  const Variable info(Mat_VarReadInfo(static_cast<mat_t*>(file_.get()), name.c_str()));
  if (info == nullptr || info->rank != 2 || info->dims == nullptr) {
    fail("variable " + name + ": expected a matrix that can be read to its end");
  }
  const std::size_t rows = info->dims[0];
  const std::size_t columns = info->dims[1];
  if (columns > 0 && rows > most_elements / columns) {
    fail("variable " + name + ": expected at most 20 million elements, found " + std::to_string(rows) + " by " +
         std::to_string(columns));
  }
}

MatMatrix MatFile::matrix(const std::string& name) const {
  if (!has(name)) {
    std::string found;
    for (const std::string& variable : variables_) {
      found += (found.empty() ? "" : ", ") + variable;
    }
    fail("expected a variable " + name + ", found " + (found.empty() ? "none" : found));
  }
  check_size(name);
  const Variable variable(Mat_VarRead(static_cast<mat_t*>(file_.get()), name.c_str()));
  if (variable == nullptr || variable->rank != 2 || variable->data == nullptr) {
    fail("variable " + name + ": expected a matrix that can be read to its end");
  }
  MatMatrix matrix{variable->dims[0], variable->dims[1], {}};
  const std::size_t count = matrix.rows * matrix.columns;
  if (variable->data_size <= 0 || variable->nbytes / static_cast<std::size_t>(variable->data_size) < count) {
    fail("variable " + name + ": expected " + std::to_string(count) + " elements, found fewer");
  }
  matrix.values = numbers(*variable, count);
  if (matrix.values.size() != count) {
    fail("variable " + name + ": expected real numbers");
  }
  const auto bad =
      std::find_if_not(matrix.values.begin(), matrix.values.end(), [](double v) { return std::isfinite(v); });
  if (bad != matrix.values.end()) {
    fail("variable " + name + ", element " + std::to_string(bad - matrix.values.begin() + 1) +
         ": expected a finite number");
  }
  return matrix;
}

std::vector<double> MatFile::vector(const std::string& name, std::size_t length) const {
  MatMatrix vector = matrix(name);
  const bool wrong_length = length != 0 && vector.size() != length;
  if (wrong_length || (vector.rows != 1 && vector.columns != 1)) {
    fail("variable " + name + ": expected a vector" +
         (length != 0 ? " of " + std::to_string(length) + " numbers" : "") + ", found " + std::to_string(vector.rows) +
         " by " + std::to_string(vector.columns));
  }
  return std::move(vector.values);
}

void MatFile::fail(const std::string& message) const { throw core::InputError(path_.string() + ": " + message); }

}  // namespace helixnav::logs
