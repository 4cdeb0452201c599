// SPDX-License-Identifier: BSD-3-Clause
#include "slam/ground_truth.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

#include <mrpt/math/CVectorDynamic.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include "helixnav/core/errors.hpp"

namespace helixnav::apps {
namespace {

/// The rows of numbers of a text file; lines that begin with % or # are comments.
std::vector<std::vector<double>> read_rows(const std::string& path, std::size_t columns) {
  std::ifstream file(path);
  if (!file) throw core::InputError(path + ": expected a file of ground truth, found nothing that can be read");
  std::vector<std::vector<double>> rows;
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    const std::size_t begin = line.find_first_not_of(" \t\r");
    if (begin == std::string::npos || line[begin] == '%' || line[begin] == '#') continue;
    std::istringstream words(line);
    std::vector<double> row;
    for (double value = 0.0; words >> value;) row.push_back(value);
    if (!words.eof() || row.size() < columns) {
      throw core::InputError(path + ":" + std::to_string(number) + ": expected at least " + std::to_string(columns) +
                             " numbers, found '" + line.substr(0, 60) + "'");
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace

std::vector<core::TrueLandmark> read_true_landmarks(const std::string& path) {
  constexpr std::size_t id_column = 6;
  std::vector<core::TrueLandmark> landmarks;
  for (const auto& row : read_rows(path, id_column + 1)) {
    landmarks.push_back({static_cast<core::Label>(row[id_column]), {row[0], row[1]}});
  }
  return landmarks;
}

std::vector<Eigen::Vector2d> read_true_path(const std::string& path) {
  std::vector<Eigen::Vector2d> places_m;
  for (const auto& row : read_rows(path, 2)) places_m.emplace_back(row[0], row[1]);
  return places_m;
}

LandmarkErrors landmark_errors(const mrpt_adapter::MapBuilder& builder, const std::vector<core::TrueLandmark>& truth) {
  mrpt::poses::CPosePDFGaussian pose;
  std::vector<mrpt::math::TPoint2D> points;
  std::map<unsigned int, std::int64_t> ids;
  mrpt::math::CVectorDouble state;
  builder.getCurrentState(pose, points, ids, state);
  LandmarkErrors errors;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::int64_t id = ids.at(static_cast<unsigned int>(i));
    const auto known = std::find_if(truth.begin(), truth.end(), [id](const auto& one) { return one.label == id; });
    if (known == truth.end()) {
      ++errors.without_truth;
      continue;
    }
    const double error_m = (known->point_m - Eigen::Vector2d(points[i].x, points[i].y)).norm();
    errors.mean_m += error_m;
    errors.largest_m = std::max(errors.largest_m, error_m);
    ++errors.compared;
  }
  if (errors.compared > 0) errors.mean_m /= static_cast<double>(errors.compared);
  return errors;
}

}  // namespace helixnav::apps
