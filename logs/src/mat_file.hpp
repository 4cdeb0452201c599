// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace helixnav::logs {

/// A real matrix of a MATLAB file, by columns.
struct MatMatrix {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<double> values;

  double operator()(std::size_t row, std::size_t column) const { return values[column * rows + row]; }
  std::size_t size() const { return values.size(); }
};

/// A MATLAB file (.mat, version 5 to 7.2), read by matio. Errors are core::InputError and name file and variable.
class MatFile {
 public:
  explicit MatFile(const std::filesystem::path& path);

  std::vector<std::string> variables() const { return variables_; }
  bool has(const std::string& variable) const;

  /// A numeric matrix without NaN or infinities.
  MatMatrix matrix(const std::string& name) const;
  /// A row or column vector of `length` numbers; of any length if `length` is 0.
  std::vector<double> vector(const std::string& name, std::size_t length = 0) const;

  /// Throws core::InputError: "file: message".
  [[noreturn]] void fail(const std::string& message) const;

 private:
  void check_extent() const;
  void check_size(const std::string& name) const;

  std::filesystem::path path_;
  std::shared_ptr<void> file_;
  std::vector<std::string> variables_;
};

}  // namespace helixnav::logs
