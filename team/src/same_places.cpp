// SPDX-License-Identifier: BSD-3-Clause
#include "same_places.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/LU>

#include "helixnav/core/angle.hpp"
#include "helixnav/core/chi2.hpp"

namespace helixnav::team {
namespace {

const double needed_nats = std::log(20.0);  ///< of a pair, and over a rival

Eigen::Index column(std::size_t landmark) { return static_cast<Eigen::Index>(2 * landmark); }

struct Difference {
  Eigen::Vector2d d_m;
  Eigen::Matrix2d C;
};

Difference difference_of(std::size_t i, std::size_t j, const Places& places) {
  const Eigen::MatrixXd& P = places.covariance;
  const Eigen::Index a = column(i);
  const Eigen::Index b = column(j);
  Eigen::Matrix2d C = P.block<2, 2>(a, a) + P.block<2, 2>(b, b) - P.block<2, 2>(a, b) - P.block<2, 2>(b, a);
  if (!places.split_m2.empty()) C += 0.5 * (places.split_m2[i] + places.split_m2[j]) * Eigen::Matrix2d::Identity();
  return {places.at_m[i] - places.at_m[j], 0.5 * (C + C.transpose())};
}

/// ln of the likelihood ratio, nothing outside the gate.
std::optional<double> nats_of(std::size_t i, std::size_t j, double gate, const Places& places) {
  const Difference difference = difference_of(i, j, places);
  const double determinant = difference.C.determinant();
  if (!(determinant > 0.0)) return std::nullopt;
  const double nis = difference.d_m.dot(difference.C.inverse() * difference.d_m);
  if (!(nis <= gate)) return std::nullopt;
  const double density = std::max(places.density_per_m2[i], places.density_per_m2[j]);
  return -0.5 * nis - std::log(2.0 * core::pi * std::sqrt(determinant)) - std::log(density);
}

struct Scored {
  std::size_t i = 0, j = 0;
  double nats = 0.0;
};

std::vector<Scored> scored_pairs(const std::vector<bool>& gone, const Places& places) {
  constexpr double match_probability = 0.999;
  const double gate = core::chi2_quantile(match_probability, 2);
  std::vector<Scored> pairs;
  for (std::size_t i = 0; i < places.ids.size(); ++i) {
    for (std::size_t j = i + 1; j < places.ids.size() && !gone[i]; ++j) {
      if (gone[j]) continue;
      const std::optional<double> nats = nats_of(i, j, gate, places);
      if (nats && !places.are_two(i, j)) pairs.push_back({i, j, *nats});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Scored& a, const Scored& b) { return a.nats > b.nats; });
  return pairs;
}

/// Whether an alternative for one of the pair is known to be distinct from the other of the pair.
bool has_rival(const Scored& pair, const std::vector<Scored>& pairs, const Places& places) {
  return std::any_of(pairs.begin(), pairs.end(), [&](const Scored& other) {
    if (pair.nats - other.nats >= needed_nats) return false;
    const auto is_rival = [&](std::size_t shared, std::size_t left) {
      if (other.i != shared && other.j != shared) return false;
      const std::size_t third = other.i == shared ? other.j : other.i;
      return third != left && places.are_two(third, left);
    };
    return is_rival(pair.i, pair.j) || is_rival(pair.j, pair.i);
  });
}

/// The map given that i and j are one.
void condition(std::size_t i, std::size_t j, Places& places) {
  const Difference difference = difference_of(i, j, places);
  Eigen::MatrixXd& P = places.covariance;
  const Eigen::MatrixXd PHt = P.middleCols<2>(column(i)) - P.middleCols<2>(column(j));
  const Eigen::Matrix2d C_inverse = difference.C.inverse();
  const Eigen::VectorXd step = PHt * (C_inverse * difference.d_m);
  P -= (PHt * C_inverse * PHt.transpose()).eval();
  for (std::size_t k = 0; k < places.at_m.size(); ++k) places.at_m[k] -= step.segment<2>(column(k));
}

}  // namespace

std::vector<SamePlace> same_places(Places places, double probability) {
  std::vector<bool> gone(places.ids.size(), false);
  std::vector<SamePlace> same;
  double total_nats = 0.0;
  for (;;) {
    const std::vector<Scored> pairs = scored_pairs(gone, places);
    const auto best = std::find_if(pairs.begin(), pairs.end(), [&](const Scored& pair) {
      return pair.nats >= needed_nats && !has_rival(pair, pairs, places);
    });
    if (best == pairs.end()) break;
    const bool in_order = places.ids[best->i] < places.ids[best->j];
    same.push_back({in_order ? best->i : best->j, in_order ? best->j : best->i, best->nats});
    total_nats += best->nats;
    condition(best->i, best->j, places);
    gone[same.back().removed] = true;
  }
  if (total_nats < -std::log(1.0 - probability)) same.clear();
  return same;
}

}  // namespace helixnav::team
