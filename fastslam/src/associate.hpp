// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "helixnav/fastslam/options.hpp"
#include "hypothesis.hpp"
#include "lineages.hpp"
#include "persistent_map.hpp"
#include "scan_model.hpp"

namespace helixnav::fastslam {

/// A landmark in the gate of an observation.
struct Candidate {
  LineageId id = 0;
  std::uint32_t observation = 0;
  double nis = 0.0;             ///< νᵀS⁻¹ν
  double log_likelihood = 0.0;  ///< ln N(ν; 0, S)
};

/// A lineage that may concern an observation, or the view, of some particle in a block.
struct Neighbour {
  LineageId id = 0;
  float reach_m = 0.0F;
  Eigen::Vector2d anchor_m;
};

/// Memory that one worker uses over and over.
struct AssociationScratch {
  std::vector<std::vector<Neighbour>> near;  ///< [observation] lineages that may be its own, for a block of hypotheses
  std::vector<Neighbour> in_reach;           ///< lineages that may be in view
  std::vector<Candidate> candidates, pairs;
  std::vector<double> nearest_nis, share;
  HypothesisSet children;
};

/// Decides for hypotheses what the observations of one scan are of, and weighs them. All members may be called from
/// several threads, each with a scratch of its own.
class Associator {
 public:
  Associator(const Options& options, const PreparedScan& scan, const Lineages& lineages,
             const std::vector<PersistentMap>& maps);

  /// Finds lineages for the hypotheses [begin, end): for observation `only`, or for all and for the view.
  void look_around(const HypothesisSet& set, std::size_t begin, std::size_t end, AssociationScratch& scratch) const;
  void look_around(const HypothesisSet& set, std::size_t begin, std::size_t end, std::size_t only,
                   AssociationScratch& scratch) const;

  /// The term of the weight for landmarks in view, seen or not: n_in_view · ln(1 − P_D).
  void weigh_view(Hypothesis& h, const AssociationScratch& scratch) const;

  /// known[j]: the lineage of observation j, or begins_landmark, or of_nothing.
  void associate_known(Hypothesis& h, Choice* choices, const std::vector<Choice>& known) const;

  /// Nearest neighbour or likelihood ratio, best pair first.
  void associate_best_first(Hypothesis& h, Choice* choices, AssociationScratch& scratch) const;

  /// Drawn with the probabilities of the alternatives; uniform[j] in [0, 1).
  void associate_sampled(Hypothesis& h, Choice* choices, const double* uniform, AssociationScratch& scratch) const;

  /// Appends the children of one hypothesis by one observation to scratch.children.
  void split(const Hypothesis& h, const Choice* choices, std::size_t observation, AssociationScratch& scratch) const;

  /// νᵀS⁻¹ν of a landmark that h's particle holds, seen from (x, P); NaN if it is undefined.
  double nis(const Hypothesis& h, LineageId id, std::size_t observation) const;

  /// ν of the same, each row divided by its standard deviation.
  Eigen::Vector2d normalised_innovation(const Hypothesis& h, LineageId id, std::size_t observation) const;

  /// The match moves (x, P), with FastSLAM 2.0, and weighs; `known`: without a doubt, whatever its likelihood was before.
  void take(Hypothesis& h, const Candidate& candidate, bool known) const;

 private:
  struct Innovation {
    Pair pair;
    Symmetric2 S;
    double determinant, nis;

    /// False if noise out of all proportion to the spread of the pose leaves nothing of S but rounding.
    bool can_be_told() const { return determinant > 1e-14 * S.xx * S.yy && nis >= 0.0 && std::isfinite(nis); }
  };
  Innovation innovation(const Hypothesis& h, const Eigen::Vector2d& landmark_m, const Symmetric2& landmark_m2,
                        const PreparedObservation& z) const;
  Eigen::Vector2d place_m(LineageId id, const LandmarkRecord& landmark) const {
    return lineages_.anchor_m(id) + Eigen::Vector2d(landmark.dx_m, landmark.dy_m);
  }
  std::vector<Neighbour>& neighbours(const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m, double margin_m,
                                     std::vector<Neighbour>& out) const;
  double spread_m2(const Hypothesis& h, const PreparedObservation& z) const;
  void find_candidates(const Hypothesis& h, std::size_t observation, double gate, bool likelihood,
                       AssociationScratch& scratch) const;
  void find_pairs(const Hypothesis& h, AssociationScratch& scratch) const;
  bool has_no_landmark_left(std::size_t observation, const Choice* choices, const AssociationScratch& scratch) const;
  void split_in_gate(const Hypothesis& h, const Choice* choices, std::size_t observation,
                     AssociationScratch& scratch) const;
  bool is_taken(const Choice* choices, LineageId id) const;

  const Options& options_;
  const PreparedScan& scan_;
  const Lineages& lineages_;
  const std::vector<PersistentMap>& maps_;
  ViewTest view_;
  double log_detection_odds_, log_unmatched_, log_new_, log_clutter_, log_missed_;
};

/// Factor on the gate when places are compared in the plane, before the exact test: room for curved coordinates.
inline constexpr double search_slack = 1.3;

/// What a landmark's own uncertainty adds to how far it may be found from its estimate.
inline double search_reach_m(const Options& options, const LandmarkRecord& landmark) {
  const double farthest = std::max(options.match_gate, options.new_gate);
  return std::sqrt(search_slack * farthest * landmark.covariance_m2().trace());
}

}  // namespace helixnav::fastslam
