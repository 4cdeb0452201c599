// SPDX-License-Identifier: BSD-3-Clause
#include "closing/agreed_pairs.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "closing/branch_pairs.hpp"
#include "closing/contradicting_pairs.hpp"

namespace helixnav::supervisor {
namespace {

using core::LandmarkId;

/// A pair must be a thousand times likelier than chance; so must a way of pairing be against another.
double nats_of_a_pair() {
  static const double nats = std::log(1000.0);
  return nats;
}

/// One way of pairing the branch with old landmarks; the pairs ascending by old landmark.
struct Way {
  KeptRemoved pairs;
  double nats = 0.0;
};

/// What may be paired about one place.
class PairedAbout {
 public:
  PairedAbout(const cekf::CompressedEkf& filter, const Branch& branch, const std::vector<LandmarkId>& old,
              const KeptRemoved& pairs, const SearchOptions& options)
      : filter_(filter), branch_(branch), old_(old), options_(options) {
    for (const auto& pair : pairs) ids_.push_back(pair.second);
    for (const LandmarkId id : branch.confirmed) {
      if (filter.contains(id) && is_among(pairs, filter.landmark_mean(id))) ids_.push_back(id);
    }
    std::sort(ids_.begin(), ids_.end());
    ids_.erase(std::unique(ids_.begin(), ids_.end()), ids_.end());
  }

  /// The ways from old landmarks of the pairs to others about them, those that differ by less than the branch's noise once.
  std::vector<Eigen::Vector2d> shifts_m(const KeptRemoved& pairs) const {
    std::vector<Eigen::Vector2d> shifts_m{Eigen::Vector2d::Zero()};
    for (const auto& pair : pairs) {
      const Eigen::Vector2d from_m = filter_.landmark_mean(pair.first);
      for (const LandmarkId other : filter_.landmarks_within(from_m, options_.rivals.apart_m)) {
        if (other == pair.first || !is_old(other)) continue;
        const Eigen::Vector2d shift_m = filter_.landmark_mean(other) - from_m;
        const bool is_known = std::any_of(shifts_m.begin(), shifts_m.end(), [&](const Eigen::Vector2d& known_m) {
          return (known_m - shift_m).norm() < options_.constellation.branch_sigma_m;
        });
        if (!is_known) shifts_m.push_back(shift_m);
      }
    }
    return shifts_m;
  }

  /// One to one, nearest first, where the branch is laid on the map; fitted to what was paired until that does not change.
  KeptRemoved paired_from(core::Pose2 T_map_branch) const {
    constexpr int most_rounds = 5;
    KeptRemoved pairs;
    for (int round = 0; round < most_rounds; ++round) {
      KeptRemoved next = paired_at(T_map_branch);
      if (next == pairs) break;
      pairs = std::move(next);
      if (pairs.size() < least_pairs) break;
      T_map_branch = fitted_to_pairs(filter_, pairs);
    }
    return pairs;
  }

  /// Nothing if the covariance of the pairs cannot be used.
  std::optional<Way> weighed(KeptRemoved pairs) const {
    const std::size_t any = pairs.size() - std::min(pairs.size(), least_pairs);
    const std::vector<std::size_t> wrong =
        contradicting_pairs(filter_, pairs, options_.merge_sigma_m, options_.closing_probability, {any, 0});
    for (std::size_t k = wrong.size(); k-- > 0;) pairs.erase(pairs.begin() + static_cast<std::ptrdiff_t>(wrong[k]));
    const std::optional<cekf::CostByPart> cost = cost_of(filter_, pairs, options_.merge_sigma_m);
    if (!cost) return std::nullopt;
    const double nats = nats_of_a_pair() * static_cast<double>(pairs.size()) - 0.5 * cost->cost;
    return Way{std::move(pairs), nats};
  }

 private:
  bool is_old(LandmarkId id) const { return std::binary_search(old_.begin(), old_.end(), id); }

  bool is_among(const KeptRemoved& pairs, const Eigen::Vector2d& at_m) const {
    return std::any_of(pairs.begin(), pairs.end(), [&](const auto& pair) {
      return (filter_.landmark_mean(pair.second) - at_m).norm() < 2.0 * options_.rivals.apart_m;
    });
  }

  KeptRemoved paired_at(const core::Pose2& T_map_branch) const {
    const double tolerance_m = 3.0 * options_.constellation.branch_sigma_m;
    std::vector<std::pair<double, cekf::CompressedEkf::LandmarkPair>> near;
    for (const LandmarkId id : ids_) {
      const Eigen::Vector2d at_m = core::transform(T_map_branch, filter_.landmark_mean(id));
      for (const LandmarkId other : filter_.landmarks_within(at_m, tolerance_m)) {
        if (!is_old(other) || !branch_.appearance.look_alike(other, id)) continue;
        near.emplace_back((filter_.landmark_mean(other) - at_m).norm(), std::pair{other, id});
      }
    }
    std::sort(near.begin(), near.end());
    KeptRemoved pairs;
    for (const auto& [distance_m, pair] : near) {
      const auto shares = [&, &one = pair](const auto& p) { return p.first == one.first || p.second == one.second; };
      if (std::none_of(pairs.begin(), pairs.end(), shares)) pairs.push_back(pair);
    }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
  }

  const cekf::CompressedEkf& filter_;
  const Branch& branch_;
  const std::vector<LandmarkId>& old_;
  const SearchOptions& options_;
  std::vector<LandmarkId> ids_;
};

/// The way given, and each other that a shift leads to and that fits enough of the pairs.
std::vector<Way> ways_about(const PairedAbout& around, const cekf::CompressedEkf& filter, const KeptRemoved& pairs,
                            const SearchOptions& options) {
  const std::vector<Eigen::Vector2d> shifts_m = around.shifts_m(pairs);
  std::vector<Way> ways;
  if (shifts_m.size() == 1) return ways;  // nothing stands near
  const std::size_t least = std::max(
      least_pairs,
      static_cast<std::size_t>(std::ceil(options.constellation.rival_match_share * static_cast<double>(pairs.size()))));
  std::vector<KeptRemoved> known{pairs};
  const core::Pose2 T_map_branch = fitted_to_pairs(filter, pairs);
  for (const Eigen::Vector2d& shift_m : shifts_m) {
    const Eigen::Vector2d at_m = T_map_branch.position_m() + shift_m;
    KeptRemoved found = around.paired_from({at_m.x(), at_m.y(), T_map_branch.heading_rad});
    if (found.size() < least || std::find(known.begin(), known.end(), found) != known.end()) continue;
    known.push_back(std::move(found));
  }
  if (known.size() == 1) return ways;
  for (KeptRemoved& found : known) {
    if (std::optional<Way> way = around.weighed(std::move(found))) ways.push_back(std::move(*way));
  }
  return ways;
}

bool holds(const Way& way, const cekf::CompressedEkf::LandmarkPair& pair) {
  return std::binary_search(way.pairs.begin(), way.pairs.end(), pair);
}

/// To another of the branch what the best way pairs, as a row does that is shifted along itself. A way that does not has found copies of
/// the same landmarks, left on the map twice, which are as right.
bool gives_away(const Way& way, const Way& best) {
  return std::any_of(way.pairs.begin(), way.pairs.end(), [&](const auto& pair) {
    return !holds(best, pair) &&
           std::any_of(best.pairs.begin(), best.pairs.end(), [&](const auto& own) { return own.first == pair.first; });
  });
}

}  // namespace

std::vector<pf_relocalize::ConstellationPair> agreed_pairs(const cekf::CompressedEkf& filter, const Branch& branch,
                                                           const std::vector<LandmarkId>& old,
                                                           const std::vector<pf_relocalize::ConstellationPair>& pairs,
                                                           const SearchOptions& options) {
  if (pairs.size() < least_pairs) return pairs;
  KeptRemoved given = kept_removed(pairs);
  std::sort(given.begin(), given.end());
  const std::vector<Way> ways = ways_about({filter, branch, old, given, options}, filter, given, options);
  if (ways.empty()) return pairs;
  const Way& best =
      *std::max_element(ways.begin(), ways.end(), [](const Way& a, const Way& b) { return a.nats < b.nats; });
  std::vector<pf_relocalize::ConstellationPair> agreed;
  for (const auto& pair : best.pairs) {
    const bool is_disputed = std::any_of(ways.begin(), ways.end(), [&](const Way& way) {
      return way.nats >= best.nats - nats_of_a_pair() && gives_away(way, best) && !holds(way, pair);
    });
    if (!is_disputed) agreed.push_back({pair.second, pair.first});
  }
  return agreed;
}

}  // namespace helixnav::supervisor
