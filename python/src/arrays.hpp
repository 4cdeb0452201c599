// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bind.hpp"
#include "helixnav/core/gaussian.hpp"
#include "helixnav/core/time.hpp"

namespace helixnav::python {

/// Contiguous, row by row.
using Array = py::array_t<double, py::array::c_style>;

/// What NumPy makes an array of real numbers of: TypeError for anything else, so that None and text do not become NaN and
/// complex numbers do not lose a part. `name` says in the message which argument it was.
Array numbers_from(const py::handle& value, const char* name);

/// The same with a shape; core::PreconditionError, which names both shapes, for another one.
Eigen::Vector2d vector2_from(const py::handle& value, const char* name);
Eigen::Vector3d vector3_from(const py::handle& value, const char* name);
Eigen::Matrix2d matrix2_from(const py::handle& value, const char* name);
Eigen::Matrix3d matrix3_from(const py::handle& value, const char* name);

/// Whole numbers, a row of them; TypeError for others.
std::vector<std::int64_t> identities_from(const py::handle& value);

/// "(3, 2)", "(3,)" as Python writes it.
std::string shape_text(const Array& array);

/// A path as text or os.PathLike, where a map could stand, too; TypeError for anything else. `name` says in the message which argument it was.
std::filesystem::path path_from(const py::handle& value, const char* name);

/// Text as UTF-8; core::PreconditionError, which names the argument, for a half of a surrogate pair, which no UTF-8 holds.
std::string utf8_from(const py::handle& text, const char* name);

/// What may have a path in it, as os.fsdecode makes text of it: bytes that are no UTF-8 become surrogates.
py::str text_with_paths(const std::string& bytes);
py::list texts_with_paths(const std::vector<std::string>& texts);

/// Seconds, finite and within the 292 years that nanoseconds can tell; else core::PreconditionError.
core::Nanoseconds time_from(double t_s);

}  // namespace helixnav::python
