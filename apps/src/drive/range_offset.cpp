// SPDX-License-Identifier: BSD-3-Clause
#include "range_offset.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include <Eigen/LU>

#include "lasting_matches.hpp"

namespace helixnav::apps {
namespace {

/// A match with its whitened derivatives by the pose and the landmark. The columns of `left` are the residual and its
/// derivative by the offset; what poses and landmarks explain of both is taken out of them.
struct Pair {
  std::size_t scan = 0, landmark = 0;
  Eigen::Matrix<double, 2, 3> by_pose;
  Eigen::Matrix2d by_landmark;
  Eigen::Matrix2d left;
};

Pair pair_of(const LastingMatch& match) {
  const auto whitened = match.R_lower.triangularView<Eigen::Lower>();
  Pair pair;
  pair.scan = match.scan;
  pair.landmark = match.landmark;
  pair.by_pose = whitened.solve(Eigen::Matrix<double, 2, 3>(match.predicted.H_pose));
  pair.by_landmark = whitened.solve(Eigen::Matrix2d(match.predicted.H_landmark));
  pair.left.col(0) = match.residual;
  pair.left.col(1) = -Eigen::Vector2d::UnitX();  // measured ranges are short by it
  pair.left = whitened.solve(pair.left).eval();
  return pair;
}

/// Takes out of the residuals what variables of N coordinates explain with the others held fixed.
template <int N>
class Elimination {
 public:
  Elimination(const std::vector<Pair>& pairs, std::size_t Pair::*variable,
              Eigen::Matrix<double, 2, N> Pair::*derivative)
      : variable_(variable), derivative_(derivative) {
    std::size_t count = 0;
    for (const Pair& pair : pairs) count = std::max(count, pair.*variable + 1);
    constexpr double hardly_any = 1e-6;  // 1 km, 1000 rad: what a scan with a single pair leaves open
    inverse_.assign(count, hardly_any * Matrix::Identity());
    for (const Pair& pair : pairs) inverse_[pair.*variable] += (pair.*derivative).transpose() * (pair.*derivative);
    for (Matrix& matrix : inverse_) matrix = matrix.inverse().eval();
  }

  void take_out_of(std::vector<Pair>& pairs) const {
    std::vector<Eigen::Matrix<double, N, 2>> moved(inverse_.size(), Eigen::Matrix<double, N, 2>::Zero());
    for (const Pair& pair : pairs) moved[pair.*variable_] += (pair.*derivative_).transpose() * pair.left;
    for (std::size_t i = 0; i < moved.size(); ++i) moved[i] = (inverse_[i] * moved[i]).eval();
    for (Pair& pair : pairs) pair.left -= (pair.*derivative_) * moved[pair.*variable_];
  }

 private:
  using Matrix = Eigen::Matrix<double, N, N>;

  std::size_t Pair::*variable_;
  Eigen::Matrix<double, 2, N> Pair::*derivative_;
  std::vector<Matrix> inverse_;
};

/// Rows less those used by landmarks and poses: for a scan with a single pair both of its rows.
double degrees_of_freedom(const std::vector<Pair>& pairs) {
  std::map<std::size_t, int> of_scan, of_landmark;
  for (const Pair& pair : pairs) {
    ++of_scan[pair.scan];
    ++of_landmark[pair.landmark];
  }
  double dof = 2.0 * static_cast<double>(pairs.size()) - 2.0 * static_cast<double>(of_landmark.size());
  for (const auto& [scan, count] : of_scan) dof -= std::min(3, 2 * count);
  return dof;
}

}  // namespace

std::optional<RangeOffset> range_offset_of(const core::Recording& recording, const runs::Run& run) {
  std::vector<Pair> pairs;
  for (const LastingMatch& match : lasting_matches(recording, run)) pairs.push_back(pair_of(match));
  const double dof = degrees_of_freedom(pairs);
  if (!(dof > 0.0)) return std::nullopt;
  const Elimination<2> landmarks(pairs, &Pair::landmark, &Pair::by_landmark);
  const Elimination<3> poses(pairs, &Pair::scan, &Pair::by_pose);
  constexpr int turns = 16;
  for (int i = 0; i < turns; ++i) {
    landmarks.take_out_of(pairs);
    poses.take_out_of(pairs);
  }
  double information = 0.0, gradient = 0.0, chi2 = 0.0;
  for (const Pair& pair : pairs) {
    information += pair.left.col(1).squaredNorm();
    gradient += pair.left.col(1).dot(pair.left.col(0));
    chi2 += pair.left.col(0).squaredNorm();
  }
  if (!(information > 0.0)) return std::nullopt;
  return RangeOffset{gradient / information, std::sqrt(std::max(1.0, chi2 / dof) / information)};
}

}  // namespace helixnav::apps
