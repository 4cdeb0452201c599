// SPDX-License-Identifier: BSD-3-Clause
#include "kept_constants.hpp"

#include <algorithm>
#include <cmath>

namespace helixnav::apps {

bool gains_as_promised(double gained_chi2, double sigmas) {
  constexpr double enough = 0.5;
  return gained_chi2 >= enough * sigmas * sigmas;
}

std::vector<bool> kept_of(const std::vector<Verdict>& verdicts) {
  std::vector<bool> kept;
  for (const Verdict verdict : verdicts) kept.push_back(verdict == Verdict::kept);
  return kept;
}

bool is_any_kept(const std::vector<Verdict>& verdicts) {
  return std::find(verdicts.begin(), verdicts.end(), Verdict::kept) != verdicts.end();
}

Eigen::VectorXd kept_sigmas(const Eigen::MatrixXd& information, const std::vector<Verdict>& verdicts,
                            const Eigen::VectorXd& usual) {
  Eigen::VectorXd uncertain = usual;  // a constant put back to its file value is known: 0
  for (std::size_t c = 0; c < verdicts.size(); ++c) {
    if (verdicts[c] != Verdict::kept && verdicts[c] != Verdict::not_observable) uncertain[index(c)] = 0.0;
  }
  return sigmas_of(information, kept_of(verdicts), uncertain);
}

std::optional<std::size_t> least_significant(const smoothing::ConstantsEvidence& all,
                                             const std::vector<Verdict>& verdicts, const Eigen::VectorXd& usual,
                                             const Eigen::VectorXd& pinned) {
  const Eigen::VectorXd from_told = best_change(all, kept_of(verdicts), pinned) - pinned;
  const Eigen::VectorXd sigmas = kept_sigmas(all.information, verdicts, usual);
  double least = 1.96;
  std::optional<std::size_t> which;
  for (std::size_t c = 0; c < verdicts.size(); ++c) {
    if (verdicts[c] != Verdict::kept || std::abs(from_told[index(c)]) >= least * sigmas[index(c)]) continue;
    least = std::abs(from_told[index(c)]) / sigmas[index(c)];
    which = c;
  }
  return which;
}

std::vector<Verdict> judge_kept(const smoothing::ConstantsEvidence& all, const std::vector<Fold>& folds,
                                std::vector<Verdict> verdicts, const Eigen::VectorXd& usual,
                                const Eigen::VectorXd& pinned) {
  while (true) {
    if (const auto least = least_significant(all, verdicts, usual, pinned)) {
      verdicts[*least] = Verdict::indistinguishable;
      continue;
    }
    const std::vector<bool> kept = kept_of(verdicts), good = confirmed(folds, kept, pinned);
    if (good == kept) return verdicts;
    for (std::size_t c = 0; c < kept.size(); ++c) {
      if (kept[c] && !good[c]) verdicts[c] = Verdict::not_confirmed;
    }
  }
}

}  // namespace helixnav::apps
