// SPDX-License-Identifier: BSD-3-Clause
#include "town.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "helixnav/core/angle.hpp"

namespace helixnav::sim {
namespace {

constexpr double corner_radius_m = 9.0;
constexpr double street_spacing_m = 0.5;

/// A polyline that grows, and its length.
class RoadBuilder {
 public:
  explicit RoadBuilder(const Eigen::Vector2d& start_m) : points_m_{start_m} {}

  void line_to(const Eigen::Vector2d& end_m) {
    const Eigen::Vector2d start_m = points_m_.back();
    const int steps = static_cast<int>(std::ceil((end_m - start_m).norm() / street_spacing_m));
    for (int i = 1; i <= steps; ++i) append(start_m + (end_m - start_m) * i / steps);
  }

  /// A quarter circle around `crossing_m`'s corner, from driving along `in` to driving along `out`.
  void corner(const Eigen::Vector2d& crossing_m, const Eigen::Vector2d& in, const Eigen::Vector2d& out) {
    line_to(crossing_m - corner_radius_m * in);
    const Eigen::Vector2d centre_m = crossing_m + corner_radius_m * (out - in);
    const int steps = static_cast<int>(std::ceil(0.5 * core::pi * corner_radius_m / street_spacing_m));
    for (int i = 1; i <= steps; ++i) {
      const double angle_rad = 0.5 * core::pi * i / steps;
      append(centre_m + corner_radius_m * (std::sin(angle_rad) * in - std::cos(angle_rad) * out));
    }
  }

  double length_m() const { return length_m_; }
  Polyline points_m() && { return std::move(points_m_); }

 private:
  void append(const Eigen::Vector2d& point_m) {
    length_m_ += (point_m - points_m_.back()).norm();
    points_m_.push_back(point_m);
  }

  Polyline points_m_;
  double length_m_ = 0.0;
};

}  // namespace

Town::Town(const WorldOptions& options, core::RandomStream& random)
    : side_m_(options.block_side_m), blocks_(options.blocks_a_side), start_(0, options.blocks_a_side / 2) {
  for (int column = 0; column <= blocks_; ++column) {
    for (int row = 0; row <= blocks_; ++row) {
      for (const Crossing& next : {Crossing(column + 1, row), Crossing(column, row + 1)}) {
        if (is_on_grid(next) && random.bernoulli(options.bare_share)) bare_.insert(street({column, row}, next));
      }
    }
  }
  bare_.erase(street(start_, {1, start_.second}));
}

TownTour Town::tour(double length_m, double drive_on_m, core::RandomStream& random) const {
  constexpr double returns = 5.0;  // in a row, each of which may move the end of the drive further on
  const std::vector<Crossing> way = draw_crossings(length_m + returns * drive_on_m, random);
  TownTour tour;
  RoadBuilder road(at_m(way.front()));
  std::set<Street> driven;
  bool was_old = false;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Street here = street(way[i - 1], way[i]);
    const bool is_old = driven.count(here) > 0 && bare_.count(here) == 0;
    if (is_old && !was_old) tour.returns_at_m.push_back(road.length_m());
    was_old = is_old;
    driven.insert(here);
    const Eigen::Vector2d in = (at_m(way[i]) - at_m(way[i - 1])) / side_m_;
    const Eigen::Vector2d out = i + 1 < way.size() ? Eigen::Vector2d((at_m(way[i + 1]) - at_m(way[i])) / side_m_) : in;
    if (in.dot(out) > 0.5) {
      road.line_to(at_m(way[i]));
    } else {
      road.corner(at_m(way[i]), in, out);
    }
  }
  tour.drive_m = length_m;
  for (const double return_m : tour.returns_at_m) {
    if (return_m < tour.drive_m) tour.drive_m = std::max(tour.drive_m, return_m + drive_on_m);
  }
  tour.drive_m = std::min(tour.drive_m, road.length_m() - side_m_ / 2.0);
  while (!tour.returns_at_m.empty() && tour.returns_at_m.back() >= tour.drive_m) tour.returns_at_m.pop_back();
  tour.road = std::move(road).points_m();
  return tour;
}

std::vector<Polyline> Town::streets_with_trees() const {
  std::vector<Polyline> streets;
  for (int column = 0; column <= blocks_; ++column) {
    for (int row = 0; row <= blocks_; ++row) {
      const Crossing here(column, row);
      for (const Crossing& next : {Crossing(column + 1, row), Crossing(column, row + 1)}) {
        if (is_on_grid(next) && bare_.count(street(here, next)) == 0) streets.push_back({at_m(here), at_m(next)});
      }
    }
  }
  return streets;
}

bool Town::is_on_grid(Crossing crossing) const {
  const auto [column, row] = crossing;
  return column >= 0 && row >= 0 && column <= blocks_ && row <= blocks_;
}

std::vector<Town::Crossing> Town::neighbours(Crossing crossing) const {
  const auto [column, row] = crossing;
  std::vector<Crossing> all;
  for (const Crossing& one :
       {Crossing(column + 1, row), Crossing(column, row + 1), Crossing(column - 1, row), Crossing(column, row - 1)}) {
    if (is_on_grid(one)) all.push_back(one);
  }
  return all;
}

std::vector<Town::Crossing> Town::draw_crossings(double length_m, core::RandomStream& random) const {
  const double least_street_m = side_m_ - 2.0 * corner_radius_m;
  std::vector<Crossing> way{start_, {1, start_.second}};
  while (static_cast<double>(way.size() - 1) * least_street_m < length_m + side_m_) {
    std::vector<Crossing> next = neighbours(way.back());
    const Crossing from = way[way.size() - 2];
    next.erase(std::remove(next.begin(), next.end(), from), next.end());
    way.push_back(next[static_cast<std::size_t>(random.below(next.size()))]);
  }
  return way;
}

/// The crossing where it starts is the origin.
Eigen::Vector2d Town::at_m(Crossing crossing) const {
  return side_m_ * Eigen::Vector2d(crossing.first - start_.first, crossing.second - start_.second);
}

}  // namespace helixnav::sim
