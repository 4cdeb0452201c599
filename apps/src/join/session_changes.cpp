// SPDX-License-Identifier: BSD-3-Clause
#include "session_changes.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "helixnav/core/angle.hpp"
#include "helixnav/evaluation/alignment.hpp"
#include "helixnav/supervisor/lengths.hpp"
#include "left_double.hpp"

namespace helixnav::apps {
namespace {

std::size_t index_of(const core::JointMap& map, core::LandmarkId id) {
  const auto at = std::lower_bound(map.joint.ids.begin(), map.joint.ids.end(), id);
  return static_cast<std::size_t>(at - map.joint.ids.begin());
}

/// The ground around the landmarks of a session, in the frame of its component.
class Ground {
 public:
  Ground(const core::JointMap& component, const supervisor::JoinedSession& session, const core::JointMap& map,
         const SessionViews* views)
      : reach_m_(map.reach_m > 0.0 ? map.reach_m : supervisor::reference_reach_m), views_(views) {
    for (const auto& [own, name] : session.name_of) {
      const std::size_t own_row = index_of(map, own);
      own_ids_.push_back(own);
      named_.push_back(name);
      points_m_.push_back(component.joint.points_m[index_of(component, name)]);
      own_points_m_.push_back(map.joint.points_m[own_row]);
      observations_.push_back(map.observations[own_row]);
    }
    ids_ = named_;
    std::sort(ids_.begin(), ids_.end());
    for (const Eigen::Vector2d& point_m : points_m_) radii_m_.push_back(radius_m(point_m));
  }

  /// Whether this session or the other has at least half of the other's eight nearest landmarks. If the two are bent apart, each has
  /// copies of its own, and neither shows what the other should have seen; if much was added, the later one has those of the earlier
  /// one.
  bool agrees_with(const Ground& other, const Eigen::Vector2d& at_m) const {
    return knows_half_of(other, at_m) || other.knows_half_of(*this, at_m);
  }

  bool has(core::LandmarkId id) const { return std::binary_search(ids_.begin(), ids_.end(), id); }
  bool knows_its_looks() const { return views_ != nullptr; }

  /// Probability that the session's looks missed what stands there, which is so easily seen.
  double missed_by_chance(const Eigen::Vector2d& at_m, double visibility) const {
    return views_->missed_by_chance(visibility * views_->surely_expected(in_own_frame(at_m)));
  }

  /// Share of the expected detections that the landmark had, at most 1; a few detections do not make it less visible than it is.
  double visibility(core::LandmarkId id) const {
    if (!knows_its_looks()) return 1.0;
    double detections = 1.0, expected = 1.0;
    for (std::size_t i = 0; i < named_.size(); ++i) {
      if (named_[i] != id) continue;
      detections += views_->detections(own_ids_[i]);
      expected += views_->expected(own_points_m_[i]);
    }
    return std::min(1.0, detections / expected);
  }

  /// Near a landmark of the session, and with others on all sides: it may not have looked beyond the edge of what it
  /// mapped. Where what it has nearest was seldom seen, or is far away, there is such an edge.
  bool looked_at(const Eigen::Vector2d& at_m) const {
    for (std::size_t i = 0; i < points_m_.size(); ++i) {
      if ((points_m_[i] - at_m).norm() <= radii_m_[i]) return is_surrounded(at_m) && is_well_in_view(at_m);
    }
    return false;
  }

 private:
  bool knows_half_of(const Ground& other, const Eigen::Vector2d& at_m) const {
    constexpr std::size_t nearest = 8;
    if (other.points_m_.size() < nearest) return false;
    std::vector<std::pair<double, core::LandmarkId>> apart;
    for (std::size_t i = 0; i < other.points_m_.size(); ++i) {
      apart.emplace_back((other.points_m_[i] - at_m).squaredNorm(), other.named_[i]);
    }
    std::nth_element(apart.begin(), apart.begin() + nearest - 1, apart.end());
    const auto is_known = [&](const auto& one) { return has(one.second); };
    const auto known = std::count_if(apart.begin(), apart.begin() + nearest, is_known);
    return 2 * static_cast<std::size_t>(known) >= nearest;
  }

  /// Whether every half plane with the point on its edge contains one of the eight nearest landmarks.
  bool is_surrounded(const Eigen::Vector2d& at_m) const {
    constexpr std::size_t nearest = 8;
    if (points_m_.size() < nearest) return false;
    std::vector<Eigen::Vector2d> apart_m;
    for (const Eigen::Vector2d& point_m : points_m_) apart_m.push_back(point_m - at_m);
    std::nth_element(apart_m.begin(), apart_m.begin() + nearest - 1, apart_m.end(),
                     [](const auto& a, const auto& b) { return a.squaredNorm() < b.squaredNorm(); });
    std::vector<double> angles_rad;
    for (std::size_t k = 0; k < nearest; ++k) angles_rad.push_back(std::atan2(apart_m[k].y(), apart_m[k].x()));
    std::sort(angles_rad.begin(), angles_rad.end());
    angles_rad.push_back(angles_rad.front() + 2.0 * core::pi);
    for (std::size_t k = 1; k < angles_rad.size(); ++k) {
      if (angles_rad[k] - angles_rad[k - 1] >= core::pi) return false;
    }
    return true;
  }

  /// [place] indices of the landmarks nearest to it.
  std::vector<std::size_t> nearest_to(const Eigen::Vector2d& at_m, std::size_t most) const {
    std::vector<std::size_t> order(points_m_.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    most = std::min(most, order.size());
    std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(most), order.end(),
                      [&](std::size_t a, std::size_t b) {
                        return (points_m_[a] - at_m).squaredNorm() < (points_m_[b] - at_m).squaredNorm();
                      });
    order.resize(most);
    return order;
  }

  /// The joined map is bent where the session's own is not: carried over with the landmarks around.
  Eigen::Vector2d in_own_frame(const Eigen::Vector2d& at_m) const {
    constexpr std::size_t around = 8;
    constexpr double any_m = 1e9;
    std::vector<Eigen::Vector2d> own_m, here_m;
    for (const std::size_t i : nearest_to(at_m, around)) {
      own_m.push_back(own_points_m_[i]);
      here_m.push_back(points_m_[i]);
    }
    return core::transform(evaluation::align_rigidly(own_m, here_m, any_m).T_a_b, at_m);
  }

  bool is_well_in_view(const Eigen::Vector2d& at_m) const {
    constexpr std::size_t three = 3;
    if (points_m_.size() < three) return false;
    std::vector<int> observations = observations_;
    const auto middle = observations.begin() + static_cast<std::ptrdiff_t>(observations.size() / 2);
    std::nth_element(observations.begin(), middle, observations.end());
    const std::vector<std::size_t> nearest = nearest_to(at_m, three);
    return std::all_of(nearest.begin(), nearest.end(), [&](std::size_t i) {
      return 2 * observations_[i] >= *middle && (points_m_[i] - at_m).norm() <= 0.5 * reach_m_;
    });
  }

  double radius_m(const Eigen::Vector2d& at_m) const {
    constexpr std::size_t eighth = 8;  // the landmark itself is the nearest
    constexpr double share = 0.6;
    std::vector<double> distances_m;
    for (const Eigen::Vector2d& other_m : points_m_) distances_m.push_back((other_m - at_m).norm());
    if (distances_m.size() <= eighth) return 0.0;
    std::nth_element(distances_m.begin(), distances_m.begin() + eighth, distances_m.end());
    return share * std::min(distances_m[eighth], reach_m_);
  }

  double reach_m_;
  const SessionViews* views_;
  std::vector<core::LandmarkId> ids_;  ///< ascending
  // [landmark]:
  std::vector<core::LandmarkId> own_ids_, named_;
  std::vector<Eigen::Vector2d> points_m_, own_points_m_;
  std::vector<int> observations_;
  std::vector<double> radii_m_;
};

/// Whether the session should have mapped the landmark that others saw, and why it may still have missed it.
bool should_have(const Ground& session, const std::vector<const Ground*>& seen, ChangedLandmark& landmark) {
  constexpr double unlikely = 1e-3;
  const auto agrees = [&](const Ground* one) { return session.agrees_with(*one, landmark.point_m); };
  if (std::none_of(seen.begin(), seen.end(), agrees)) return false;
  double& chance = landmark.missed_by_chance;
  if (!session.knows_its_looks()) {
    if (!session.looked_at(landmark.point_m)) return false;
    chance = std::numeric_limits<double>::quiet_NaN();
    return true;
  }
  double visibility = 0.0;
  for (const Ground* one : seen) visibility = std::max(visibility, one->visibility(landmark.id));
  const double missed = session.missed_by_chance(landmark.point_m, visibility);
  if (missed >= unlikely) return false;
  const bool first = landmark.missing_in.empty();
  if (first || !std::isnan(chance)) chance = first ? missed : std::max(chance, missed);
  return true;
}

void add_shared(std::size_t number, const core::JointMap& component, const std::vector<Ground>& grounds,
                const std::vector<std::size_t>& sessions, std::vector<ChangedLandmark>& shared) {
  for (std::size_t i = 0; i < component.joint.ids.size(); ++i) {
    ChangedLandmark landmark{number, component.joint.ids[i], component.joint.points_m[i], {}, {}};
    std::vector<const Ground*> seen;
    for (std::size_t k = 0; k < sessions.size(); ++k) {
      if (!grounds[k].has(landmark.id)) continue;
      landmark.seen_in.push_back(sessions[k]);
      seen.push_back(&grounds[k]);
    }
    for (std::size_t k = 0; k < sessions.size(); ++k) {
      if (grounds[k].has(landmark.id) || !should_have(grounds[k], seen, landmark)) continue;
      landmark.missing_in.push_back(sessions[k]);
    }
    if (landmark.seen_in.size() + landmark.missing_in.size() > 1) shared.push_back(std::move(landmark));
  }
}

bool is_gone_then_new(const ChangedLandmark& gone, const ChangedLandmark& other) {
  return other.change() == Change::appeared && other.seen_in.front() > gone.seen_in.back();
}

bool stand_alike(const core::JointMap& component, const ChangedLandmark& a, const ChangedLandmark& b, double reach_m) {
  constexpr double surely = 9.21;  // χ²₂ of 99 %
  return chi2_as_one(component, index_of(component, a.id), index_of(component, b.id), reach_m) < surely;
}

ChangedLandmark& entry_of(const core::JointMap& component, std::size_t number, core::LandmarkId id,
                          const std::vector<std::size_t>& seen_in, std::vector<ChangedLandmark>& shared) {
  const auto found = std::find_if(shared.begin(), shared.end(),
                                  [&](const ChangedLandmark& one) { return one.component == number && one.id == id; });
  if (found != shared.end()) return *found;
  shared.push_back({number, id, component.joint.points_m[index_of(component, id)], seen_in, {}});
  return shared.back();
}

void note_copy(core::LandmarkId other, const std::vector<std::size_t>& other_seen_in, ChangedLandmark& one) {
  one.perhaps_copy_of = other;
  const auto is_seen = [&](std::size_t session) {
    return std::binary_search(other_seen_in.begin(), other_seen_in.end(), session);
  };
  one.missing_in.erase(std::remove_if(one.missing_in.begin(), one.missing_in.end(), is_seen), one.missing_in.end());
}

/// Neither of two that may be one is missing where the other was seen.
void note_left_double(const supervisor::JoinedSessions& joined, std::size_t number, double reach_m,
                      const std::vector<Ground>& grounds, const std::vector<std::size_t>& sessions,
                      std::vector<ChangedLandmark>& shared) {
  const auto seen_in = [&](core::LandmarkId id) {
    std::vector<std::size_t> seen;
    for (std::size_t k = 0; k < sessions.size(); ++k) {
      if (grounds[k].has(id)) seen.push_back(sessions[k]);
    }
    return seen;
  };
  const core::JointMap& component = joined.components[number];
  for (const auto& [a, b] : left_double(joined, number, reach_m)) {
    note_copy(b, seen_in(b), entry_of(component, number, a, seen_in(a), shared));
    note_copy(a, seen_in(a), entry_of(component, number, b, seen_in(b), shared));
  }
}

/// One that is gone where a later session has a new one is still there: as with two stems beside each other, of which either may be
/// either, so that they were not merged. The map holds two copies, and both are kept.
void keep_copies(const core::JointMap& component, std::size_t number, double reach_m,
                 std::vector<ChangedLandmark>& shared) {
  for (ChangedLandmark& gone : shared) {
    if (gone.component != number || !gone.is_gone()) continue;
    ChangedLandmark* nearest = nullptr;
    for (ChangedLandmark& other : shared) {
      if (other.component != number || !is_gone_then_new(gone, other)) continue;
      const double apart_m = (other.point_m - gone.point_m).norm();
      if (nearest == nullptr || apart_m < (nearest->point_m - gone.point_m).norm()) nearest = &other;
    }
    if (nearest == nullptr || !stand_alike(component, gone, *nearest, reach_m)) continue;
    gone.missing_in.clear();
    nearest->missing_in.clear();
  }
}

/// Of the landmarks that are gone and those new nearby, the ones that moved (Benjamini and Hochberg 1995).
class Moves {
 public:
  Moves(const core::JointMap& component, std::vector<ChangedLandmark*> landmarks)
      : component_(component), landmarks_(std::move(landmarks)) {
    for (ChangedLandmark* landmark : landmarks_) {
      if (landmark->is_gone()) gone_.push_back(landmark);
      if (landmark->change() == Change::appeared) new_.push_back(landmark);
    }
  }

  void tell() {
    std::vector<Move> moves;
    for (ChangedLandmark* gone : gone_) {
      ChangedLandmark* near = nearest(*gone, new_);
      if (near == nullptr || nearest(*near, gone_) != gone) continue;
      if (near->seen_in.front() <= gone->seen_in.back()) continue;
      moves.push_back({gone, near, by_chance(gone->point_m, (near->point_m - gone->point_m).norm())});
    }
    std::stable_sort(moves.begin(), moves.end(), [](const Move& a, const Move& b) { return a.chance < b.chance; });
    std::size_t believed = 0;
    for (std::size_t k = 0; k < moves.size(); ++k) {
      const double by_chance_so_far = static_cast<double>(gone_.size()) * moves[k].chance;
      if (by_chance_so_far <= most_wrong * static_cast<double>(k + 1)) believed = k + 1;
    }
    for (std::size_t k = 0; k < believed; ++k) {
      moves[k].gone->counterpart = moves[k].appeared->id;
      moves[k].appeared->counterpart = moves[k].gone->id;
    }
  }

 private:
  static constexpr double most_wrong = 0.05;  ///< share of the reported moves, on average

  struct Move {
    ChangedLandmark* gone;
    ChangedLandmark* appeared;
    double chance;
  };

  static ChangedLandmark* nearest(const ChangedLandmark& of, const std::vector<ChangedLandmark*>& among) {
    ChangedLandmark* nearest = nullptr;
    for (ChangedLandmark* other : among) {
      const double apart_m = (other->point_m - of.point_m).norm();
      if (nearest == nullptr || apart_m < (nearest->point_m - of.point_m).norm()) nearest = other;
    }
    return nearest;
  }

  /// Probability that an unrelated new landmark is this near to the one that is gone: its density is the share of new ones
  /// among all, times the local density, from the distance of the eighth neighbour.
  double by_chance(const Eigen::Vector2d& at_m, double apart_m) const {
    constexpr std::size_t eighth = 8;
    std::vector<double> distances_m;
    for (const Eigen::Vector2d& other_m : component_.joint.points_m) distances_m.push_back((other_m - at_m).norm());
    if (distances_m.size() <= eighth) return HUGE_VAL;
    std::nth_element(distances_m.begin(), distances_m.begin() + eighth, distances_m.end());
    const double share_new = static_cast<double>(new_.size()) / static_cast<double>(landmarks_.size());
    const double radii = apart_m / distances_m[eighth];
    return share_new * static_cast<double>(eighth) * radii * radii;
  }

  const core::JointMap& component_;
  std::vector<ChangedLandmark*> landmarks_, gone_, new_;
};

void tell_moved(const core::JointMap& component, std::size_t number, std::vector<ChangedLandmark>& shared) {
  std::vector<ChangedLandmark*> here;
  for (ChangedLandmark& landmark : shared) {
    if (landmark.component == number) here.push_back(&landmark);
  }
  Moves(component, std::move(here)).tell();
}

}  // namespace

Change ChangedLandmark::change() const {
  if (counterpart != core::no_landmark) return Change::moved;
  if (missing_in.empty()) return Change::kept;
  if (is_gone()) return Change::gone;
  return missing_in.back() < seen_in.front() ? Change::appeared : Change::both;
}

const char* name_of(Change change) {
  switch (change) {
    case Change::gone:
      return "gone";
    case Change::appeared:
      return "new";
    case Change::both:
      return "both";
    case Change::moved:
      return "moved";
    case Change::kept:
      break;
  }
  return "kept";
}

std::vector<ChangedLandmark> shared_landmarks(const std::vector<core::JointMap>& sessions,
                                              const supervisor::JoinedSessions& joined,
                                              const std::vector<std::optional<SessionViews>>& views) {
  std::vector<ChangedLandmark> shared;
  for (std::size_t number = 0; number < joined.components.size(); ++number) {
    std::vector<std::size_t> members;
    std::vector<Ground> grounds;
    double farthest_m = 0.0;
    for (std::size_t k = 0; k < sessions.size(); ++k) {
      if (joined.sessions[k].component != number) continue;
      const double reach_m = sessions[k].reach_m > 0.0 ? sessions[k].reach_m : supervisor::reference_reach_m;
      members.push_back(k);
      farthest_m = std::max(farthest_m, reach_m);
      const SessionViews* looks = k < views.size() && views[k] ? &*views[k] : nullptr;
      grounds.emplace_back(joined.components[number], joined.sessions[k], sessions[k], looks);
    }
    add_shared(number, joined.components[number], grounds, members, shared);
    note_left_double(joined, number, farthest_m, grounds, members, shared);
    keep_copies(joined.components[number], number, farthest_m, shared);
    tell_moved(joined.components[number], number, shared);
  }
  return shared;
}

void make_gone_tentative(const std::vector<ChangedLandmark>& shared, std::vector<core::JointMap>& components) {
  for (const ChangedLandmark& landmark : shared) {
    if (!landmark.is_gone()) continue;
    core::JointMap& map = components.at(landmark.component);
    const auto at = std::lower_bound(map.joint.ids.begin(), map.joint.ids.end(), landmark.id);
    map.states[static_cast<std::size_t>(at - map.joint.ids.begin())] = core::LandmarkState::tentative;
  }
}

}  // namespace helixnav::apps
