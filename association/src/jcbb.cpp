// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "chi2_table.hpp"
#include "helixnav/association/joint_innovation.hpp"
#include "helixnav/core/errors.hpp"
#include "matching.hpp"

namespace helixnav::association {
namespace {

/// Joint compatibility branch and bound after Neira and Tardós (2001): of all sets of pairs, each observation and each
/// landmark at most once, whose joint NIS is within the χ² gate of their degrees of freedom, the largest; of the largest
/// the one with the least NIS. NIS only grows with the set, so a set beyond the gate of the most that its branch can
/// still collect is cut, whatever the order of the observations.
class Search {
 public:
  Search(const InnovationProblem& problem, double joint_probability, std::int64_t node_budget)
      : problem_(problem), budget_(node_budget), taken_(problem.ids.size(), 0) {
    order_observations();
    const std::size_t depth = order_.size();
    max_dof_after_.assign(depth + 1, 0);
    for (std::size_t i = depth; i-- > 0;) {
      max_dof_after_[i] = max_dof_after_[i + 1] + problem.observations[order_[i]].dof;
    }
    threshold_.assign(max_dof_after_[0] + 1, 0.0);
    for (int dof = 1; dof <= max_dof_after_[0]; ++dof) threshold_[dof] = chi2_threshold(joint_probability, dof);
    tabulate_covariances();
    chosen_.reserve(depth);
    factor_.resize(depth * (depth + 1) / 2);
    whitened_.resize(depth);
  }

  Matching run() {
    descend(0, 0.0, 0);
    Matching matching;
    matching.pair.assign(problem_.observations.size(), unmatched);
    for (const int p : best_) matching.pair[problem_.pairs[p].observation] = p;
    matching.nodes = nodes_;
    matching.budget_hit = nodes_ >= budget_;
    return matching;
  }

 private:
  /// Observations with few candidates first: the tree is narrow where it is cut most. Those without take no part.
  void order_observations() {
    for (std::size_t i = 0; i < problem_.observations.size(); ++i) {
      if (problem_.observations[i].begin < problem_.observations[i].end) order_.push_back(static_cast<int>(i));
    }
    const auto candidates = [&](int i) { return problem_.observations[i].end - problem_.observations[i].begin; };
    std::stable_sort(order_.begin(), order_.end(), [&](int a, int b) { return candidates(a) < candidates(b); });
  }

  /// Covariances between all predictions that have a pair, once for the whole search.
  void tabulate_covariances() {
    slot_of_prediction_.assign(problem_.predictions.size(), -1);
    std::vector<int> pair_of_slot;
    for (std::size_t p = 0; p < problem_.pairs.size(); ++p) {
      int& slot = slot_of_prediction_[problem_.pairs[p].prediction];
      if (slot >= 0) continue;
      slot = static_cast<int>(pair_of_slot.size());
      pair_of_slot.push_back(static_cast<int>(p));
    }
    slots_ = static_cast<int>(pair_of_slot.size());
    covariance_.resize(static_cast<std::size_t>(slots_) * slots_);
    for (int a = 0; a < slots_; ++a) {
      for (int b = 0; b < a; ++b) {
        // Different landmarks or kinds: the noise of an observation has no part in it.
        GatedPair pair_a = problem_.pairs[pair_of_slot[a]];
        GatedPair pair_b = problem_.pairs[pair_of_slot[b]];
        pair_a.observation = 0;
        pair_b.observation = 1;
        covariance_[a * slots_ + b] = innovation_cross_covariance(problem_, pair_a, pair_b);
        covariance_[b * slots_ + a] = covariance_[a * slots_ + b].transpose();
      }
    }
  }

  Eigen::Matrix2d* factor_row(std::size_t row) { return factor_.data() + row * (row + 1) / 2; }

  /// Appends one block row to the Cholesky factor of the joint covariance; what the pair adds to the joint NIS.
  double append(int p) {
    const GatedPair& pair = problem_.pairs[p];
    const std::size_t n = chosen_.size();
    Eigen::Matrix2d* row = factor_row(n);
    const Eigen::Matrix2d* covariance = covariance_.data() + slot_of_prediction_[pair.prediction] * slots_;
    Eigen::Matrix2d D = pair.S;
    Eigen::Vector2d e = pair.nu;
    for (std::size_t k = 0; k < n; ++k) {
      const Eigen::Matrix2d* row_k = factor_row(k);
      Eigen::Matrix2d C = covariance[slot_of_prediction_[problem_.pairs[chosen_[k]].prediction]];
      for (std::size_t l = 0; l < k; ++l) C.noalias() -= row[l] * row_k[l].transpose();
      const Eigen::Matrix2d& L = row_k[k];
      C.col(0) /= L(0, 0);
      C.col(1) = (C.col(1) - C.col(0) * L(1, 0)) / L(1, 1);
      row[k] = C;
      D.noalias() -= C * C.transpose();
      e.noalias() -= C * whitened_[k];
    }
    const double l00 = std::sqrt(D(0, 0));
    const double l10 = D(1, 0) / l00;
    const double l11 = std::sqrt(D(1, 1) - l10 * l10);
    if (!(l00 > 0.0) || !(l11 > 0.0)) throw_not_positive_definite(p);
    row[n] << l00, 0.0, l10, l11;
    whitened_[n] << e[0] / l00, (e[1] - l10 * e[0] / l00) / l11;
    return whitened_[n].squaredNorm();
  }

  [[noreturn]] void throw_not_positive_definite(int last) const {
    std::string landmarks;
    for (const int p : chosen_) landmarks += " " + std::to_string(problem_.ids[problem_.pairs[p].candidate]);
    landmarks += " " + std::to_string(problem_.ids[problem_.pairs[last].candidate]);
    throw core::NumericalError("jcbb: joint innovation covariance is not positive definite for landmarks" + landmarks);
  }

  bool can_still_win(std::size_t depth, double nis) const {
    const std::size_t most = chosen_.size() + (order_.size() - depth);
    return most > best_.size() || (most == best_.size() && nis < best_nis_);
  }

  void keep_if_best(double nis, int dof) {
    if (dof == 0 || nis > threshold_[dof] || chosen_.size() < best_.size()) return;
    if (chosen_.size() == best_.size() && nis >= best_nis_) return;
    best_ = chosen_;
    best_nis_ = nis;
  }

  void descend(std::size_t depth, double nis, int dof) {
    if (depth == order_.size() || !can_still_win(depth, nis)) return;
    const GatedObservation& observation = problem_.observations[order_[depth]];
    for (int p = observation.begin; p < observation.end; ++p) {
      const int candidate = problem_.pairs[p].candidate;
      if (taken_[candidate]) continue;
      if (nodes_ >= budget_) return;
      ++nodes_;
      const double next_nis = nis + append(p);
      if (next_nis > threshold_[dof + max_dof_after_[depth]]) continue;
      taken_[candidate] = 1;
      chosen_.push_back(p);
      keep_if_best(next_nis, dof + observation.dof);
      descend(depth + 1, next_nis, dof + observation.dof);
      chosen_.pop_back();
      taken_[candidate] = 0;
    }
    descend(depth + 1, nis, dof);  // without this observation
  }

  const InnovationProblem& problem_;
  std::int64_t budget_;
  std::int64_t nodes_ = 0;
  std::vector<int> order_;
  std::vector<int> max_dof_after_;
  std::vector<double> threshold_;
  std::vector<int> slot_of_prediction_;
  int slots_ = 0;
  std::vector<Eigen::Matrix2d> covariance_;
  std::vector<char> taken_;
  std::vector<int> chosen_;
  std::vector<Eigen::Matrix2d> factor_;
  std::vector<Eigen::Vector2d> whitened_;
  std::vector<int> best_;
  double best_nis_ = std::numeric_limits<double>::infinity();
};

}  // namespace

Matching jcbb(const InnovationProblem& problem, double joint_probability, std::int64_t node_budget) {
  return Search(problem, joint_probability, node_budget).run();
}

}  // namespace helixnav::association
