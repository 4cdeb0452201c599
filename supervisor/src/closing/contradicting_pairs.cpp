// SPDX-License-Identifier: BSD-3-Clause
#include "closing/contradicting_pairs.hpp"

#include <algorithm>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "closing/pair_differences.hpp"
#include "helixnav/core/chi2.hpp"

namespace helixnav::supervisor {
namespace {

using Index = Eigen::Index;

/// χ² of the remaining pairs, and their S⁻¹.
class Remaining {
 public:
  explicit Remaining(const PairDifferences& differences)
      : K_(differences.S_m2.llt().solve(Eigen::MatrixXd::Identity(differences.S_m2.rows(), differences.S_m2.cols()))),
        lambda_(K_ * differences.nu_m),
        cost_(lambda_.dot(differences.nu_m)),
        is_left_(static_cast<std::size_t>(K_.rows() / 2), true),
        dof_(static_cast<int>(K_.rows())) {}

  double cost() const { return cost_; }
  int dof() const { return dof_; }

  struct Worst {
    std::size_t pair = 0;
    double nis = -1.0;  ///< of the pair given the others: by this much χ² falls without it
  };
  Worst worst() const {
    Worst worst;
    for (std::size_t k = 0; k < is_left_.size(); ++k) {
      if (!is_left_[k]) continue;
      const auto row = 2 * static_cast<Index>(k);
      const Eigen::Vector2d lambda = lambda_.segment<2>(row);
      const double nis = lambda.dot(K_.block<2, 2>(row, row).inverse() * lambda);
      if (nis > worst.nis) worst = {k, nis};
    }
    return worst;
  }

  void leave_out(std::size_t pair) {
    const auto row = 2 * static_cast<Index>(pair);
    const Eigen::Matrix2d own = K_.block<2, 2>(row, row).inverse();
    const Eigen::MatrixXd column = K_.middleCols<2>(row);
    const Eigen::Vector2d lambda = lambda_.segment<2>(row);
    cost_ -= lambda.dot(own * lambda);
    lambda_ -= column * (own * lambda);
    K_.noalias() -= column * own * column.transpose();
    is_left_[pair] = false;
    dof_ -= 2;
  }

 private:
  Eigen::MatrixXd K_;
  Eigen::VectorXd lambda_;
  double cost_;
  std::vector<bool> is_left_;
  int dof_;
};

}  // namespace

std::vector<std::size_t> contradicting_pairs(const cekf::CompressedEkf& filter, const KeptRemoved& pairs,
                                             double sigma_m, double closing_probability, MayLeaveOut may) {
  static const double outlier = core::chi2_quantile(0.999, 2);
  Remaining remaining(pair_differences(filter, pairs, core::Pose2(), sigma_m));
  std::vector<std::size_t> left_out;
  while (left_out.size() < may.any + may.outliers && remaining.dof() > 2 * static_cast<int>(least_pairs) &&
         remaining.cost() > core::chi2_quantile(closing_probability, remaining.dof())) {
    const Remaining::Worst worst = remaining.worst();
    if (left_out.size() >= may.any && worst.nis < outlier) break;
    left_out.push_back(worst.pair);
    remaining.leave_out(left_out.back());
  }
  std::sort(left_out.begin(), left_out.end());
  return left_out;
}

}  // namespace helixnav::supervisor
