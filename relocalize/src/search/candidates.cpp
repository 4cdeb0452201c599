// SPDX-License-Identifier: BSD-3-Clause
#include "search/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>
#include <unordered_map>

#include "question/question_triangles.hpp"

namespace helixnav::relocalize {

namespace {

constexpr std::size_t most_triangles = 240;
constexpr std::size_t most_kept = 400;
constexpr double hit_probability = 0.45;  ///< of a point of the right place: detection, change and noise together
constexpr float abandoned_below = -3.0F;

/// Candidates in cells of poses, the best of each.
class PoseCells {
 public:
  explicit PoseCells(const Prepared& asked)
      : side_m_(2.0 * asked.near_m), turn_rad_(asked.near_m / std::max(asked.extent_m, asked.near_m)) {}

  void offer(const Candidate& fresh) {
    const auto [at, is_new] = best_.try_emplace(key_of(fresh.T_origin_centre), fresh);
    if (!is_new && before(fresh, at->second)) at->second = fresh;
  }

  /// Would offer() change nothing, even with the score that it may have at most?
  bool is_outdone(const Candidate& at_most) const {
    const auto found = best_.find(key_of(at_most.T_origin_centre));
    return found != best_.end() && !before(at_most, found->second);
  }

  /// Do more poses than are kept score like the best, to within one nat?
  bool crowded() const {
    float best = 0.0F;
    for (const auto& entry : best_) best = std::max(best, entry.second.score);
    const auto ties =
        std::count_if(best_.begin(), best_.end(), [&](const auto& entry) { return entry.second.score > best - 1.0F; });
    return static_cast<std::size_t>(ties) > most_kept;
  }

  std::vector<Candidate> sorted() const {
    std::vector<Candidate> list;
    for (const auto& entry : best_) list.push_back(entry.second);
    std::sort(list.begin(), list.end(), before);
    return list;
  }

 private:
  std::int64_t key_of(const core::Pose2& pose) const {
    const auto cell = [](double value) { return static_cast<std::int64_t>(std::floor(value)) & 0x1FFFFF; };
    return cell(pose.x_m / side_m_) << 42 | cell(pose.y_m / side_m_) << 21 | cell(pose.heading_rad / turn_rad_);
  }

  /// A total order on values: what is kept does not depend on the order of arrival.
  static bool before(const Candidate& a, const Candidate& b) {
    const auto& p = a.T_origin_centre;
    const auto& q = b.T_origin_centre;
    return std::tie(b.score, p.x_m, p.y_m, p.heading_rad) < std::tie(a.score, q.x_m, q.y_m, q.heading_rad);
  }

  double side_m_;
  double turn_rad_;
  std::unordered_map<std::int64_t, Candidate> best_;
};

/// A triangle of the question with all other points in order of their distance, from the triangle's centroid.
struct Fan {
  Fan(const Prepared& asked, const QuestionTriangle& triangle) : centroid{0.0F, 0.0F} {
    for (const int corner : triangle.corners) {
      const Point& point = asked.points[static_cast<std::size_t>(corner)];
      centroid.x_m += point.x_m / 3.0F;
      centroid.y_m += point.y_m / 3.0F;
    }
    std::vector<std::tuple<float, std::size_t>> order;
    for (std::size_t i = 0; i < asked.points.size(); ++i) {
      const Point from = {asked.points[i].x_m - centroid.x_m, asked.points[i].y_m - centroid.y_m};
      const float d2 = from.x_m * from.x_m + from.y_m * from.y_m;
      const auto corner = std::find(triangle.corners.begin(), triangle.corners.end(), static_cast<int>(i));
      if (corner == triangle.corners.end()) {
        order.emplace_back(d2, i);
        continue;
      }
      corners[static_cast<std::size_t>(corner - triangle.corners.begin())] = from;
      spread_m2 += d2;
    }
    std::sort(order.begin(), order.end());
    for (const auto& [d2, i] : order)
      others.push_back({asked.points[i].x_m - centroid.x_m, asked.points[i].y_m - centroid.y_m});
  }

  Point centroid;
  std::array<Point, 3> corners;
  float spread_m2 = 0.0F;  ///< Σ of squared distances of the corners from the centroid
  std::vector<Point> others;
};

/// Rotation and centroid that lay the fan's triangle on three landmarks.
struct Laid {
  float x_m, y_m, cosine, sine;
  TileGrid::Probe first_look;
};

/// Sides within the tolerance of a triangle's. One branch for all three: which of them disagrees cannot be predicted.
class SideGate {
 public:
  SideGate(const Sides& sides_m, float tolerance_m) {
    for (std::size_t k = 0; k < 3; ++k) {
      const float low_m = std::max(0.0F, sides_m[k] - tolerance_m);
      const float high_m = sides_m[k] + tolerance_m;
      middle_m2_[k] = 0.5F * (high_m * high_m + low_m * low_m);
      half_m2_[k] = 0.5F * (high_m * high_m - low_m * low_m);
    }
  }

  bool passes(const Node& a, const Node& b, const Node& c) const {
    const bool first = std::abs(squared_distance_m2(a, b) - middle_m2_[0]) <= half_m2_[0];
    const bool second = std::abs(squared_distance_m2(b, c) - middle_m2_[1]) <= half_m2_[1];
    const bool third = std::abs(squared_distance_m2(c, a) - middle_m2_[2]) <= half_m2_[2];
    return static_cast<int>(first) + static_cast<int>(second) + static_cast<int>(third) == 3;
  }

 private:
  std::array<float, 3> middle_m2_;
  std::array<float, 3> half_m2_;
};

class Search {
 public:
  explicit Search(const Prepared& asked)
      : asked_(asked),
        nodes_(asked.map.nodes),
        cells_(asked),
        hit_(static_cast<float>(std::log(hit_probability / asked.chance_hit))),
        miss_(static_cast<float>(std::log((1.0 - hit_probability) / (1.0 - asked.chance_hit)))) {}

  /// Returns how many triangles of the map have these sides.
  double look_up(const QuestionTriangle& triangle) {
    const Fan fan(asked_, triangle);
    const SideGate gate(triangle.sides_m, asked_.map.side_tolerance_m());
    double found = 0.0;
    asked_.map.bins.near(triangle.sides_m, asked_.map.side_tolerance_m(), [&](const Code* codes, std::uint32_t count) {
      for (std::uint32_t k = 0; k < count; ++k) __builtin_prefetch(&nodes_[owner_of(codes[k])]);
      batch_.insert(batch_.end(), codes, codes + count);
      if (batch_.size() >= batch_size) found += consider_batch(fan, gate);
    });
    return found + consider_batch(fan, gate);
  }

  bool crowded() const { return cells_.crowded(); }
  std::vector<Candidate> sorted() const { return cells_.sorted(); }

 private:
  /// Landmarks come from all over the map: all of a batch are prefetched before the first is looked at.
  static constexpr std::size_t batch_size = 64;

  double consider_batch(const Fan& fan, const SideGate& gate) {
    corners_.clear();
    for (const Code code : batch_) {
      corners_.push_back(corners_of(nodes_, code));
      for (const Slot slot : corners_.back()) __builtin_prefetch(&nodes_[slot]);
    }
    batch_.clear();
    laid_.clear();
    double found = 0.0;
    for (const Corners& at : corners_) {
      if (!gate.passes(nodes_[at[0]], nodes_[at[1]], nodes_[at[2]])) continue;
      ++found;
      Laid fit{};
      if (!lay(fan, at, fit)) continue;
      const Point first = place(fit, fan.others.front());
      fit.first_look = asked_.map.grid.probe(first.x_m, first.y_m);
      __builtin_prefetch(fit.first_look.word);
      laid_.push_back(fit);
    }
    for (const Laid& fit : laid_) test(fan, fit);
    return found;
  }

  /// Closed-form rigid fit of three points; false when its residual has a χ² (three degrees of freedom) above 16.
  bool lay(const Fan& fan, const Corners& corners, Laid& laid) const {
    const std::array<const Node*, 3> at = {&nodes_[corners[0]], &nodes_[corners[1]], &nodes_[corners[2]]};
    laid.x_m = (at[0]->x_m + at[1]->x_m + at[2]->x_m) / 3.0F;
    laid.y_m = (at[0]->y_m + at[1]->y_m + at[2]->y_m) / 3.0F;
    float along = 0.0F;
    float across = 0.0F;
    float spread = fan.spread_m2;
    for (std::size_t k = 0; k < 3; ++k) {
      const float dx = at[k]->x_m - laid.x_m;
      const float dy = at[k]->y_m - laid.y_m;
      along += fan.corners[k].x_m * dx + fan.corners[k].y_m * dy;
      across += fan.corners[k].x_m * dy - fan.corners[k].y_m * dx;
      spread += dx * dx + dy * dy;
    }
    const float length = std::sqrt(along * along + across * across);
    laid.cosine = along / length;
    laid.sine = across / length;
    return spread - 2.0F * length <= 16.0F * asked_.map.noise_m * asked_.map.noise_m;
  }

  static Point place(const Laid& fit, const Point& p) {
    return {fit.x_m + fit.cosine * p.x_m - fit.sine * p.y_m, fit.y_m + fit.sine * p.x_m + fit.cosine * p.y_m};
  }

  /// Where rows repeat, thousands of triangles lay the question on the same place, and nearly all of them are outdone by an earlier one.
  /// That is asked once some points have been looked at, which most false poses do not survive.
  void test(const Fan& fan, const Laid& fit) {
    constexpr std::size_t outdone_every = 8;
    const TileGrid& grid = asked_.map.grid;
    const auto near_m = static_cast<float>(asked_.near_m);
    const std::size_t count = fan.others.size();
    Candidate candidate{0.0F, {}};
    for (std::size_t k = 0; k < count; ++k) {
      const Point at = place(fit, fan.others[k]);
      const bool marked = k == 0 ? fit.first_look.set() : grid.probe(at.x_m, at.y_m).set();
      candidate.score += marked && grid.holds(nodes_, at.x_m, at.y_m, near_m) ? hit_ : miss_;
      if (candidate.score < abandoned_below) return;
      if ((k + 1) % outdone_every != 0) continue;
      if (k + 1 == outdone_every) candidate.T_origin_centre = pose_of(fan, fit);
      if (cells_.is_outdone({at_most(candidate.score, count - k - 1), candidate.T_origin_centre})) return;
    }
    if (candidate.score < 0.0F) return;
    if (count < outdone_every) candidate.T_origin_centre = pose_of(fan, fit);
    cells_.offer(candidate);
  }

  /// As the sum is made, so that it is reached to the last bit.
  float at_most(float score, std::size_t left) const {
    for (std::size_t k = 0; k < left; ++k) score += std::max(hit_, miss_);
    return score;
  }

  static core::Pose2 pose_of(const Fan& fan, const Laid& fit) {
    const Point centre = place(fit, {-fan.centroid.x_m, -fan.centroid.y_m});
    return {centre.x_m, centre.y_m, std::atan2(fit.sine, fit.cosine)};
  }

  const Prepared& asked_;
  const Nodes& nodes_;
  PoseCells cells_;
  float hit_;
  float miss_;
  std::vector<Code> batch_;
  std::vector<Corners> corners_;
  std::vector<Laid> laid_;
};

}  // namespace

Candidates find_candidates(const Prepared& asked, double most_candidates) {
  Candidates result;
  Search search(asked);
  for (const QuestionTriangle& triangle : question_triangles(asked, most_triangles)) {
    result.capped = result.looked_at > most_candidates;
    // If hundreds of poses tie after that many triangles, more of them will not separate them.
    if (result.triangles % 32 == 0 && result.triangles >= 96) result.crowded = search.crowded();
    if (result.capped || result.crowded) break;
    result.looked_at += search.look_up(triangle);
    ++result.triangles;
  }
  result.crowded = search.crowded();
  result.best = search.sorted();
  if (result.best.size() > most_kept) result.best.resize(most_kept);
  return result;
}

}  // namespace helixnav::relocalize
