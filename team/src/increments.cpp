// SPDX-License-Identifier: BSD-3-Clause
#include "increments.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

#include "split_motion.hpp"

namespace helixnav::team {
namespace {

bool ends_before(const core::Odometry& motion, core::Nanoseconds t_ns) { return motion.t_ns < t_ns; }
bool is_before_end(core::Nanoseconds t_ns, const core::Odometry& motion) { return t_ns < motion.t_ns; }

}  // namespace

bool Increments::ends_after_all(core::Nanoseconds t_ns) const {
  return motions_.empty() || motions_.back().t_ns <= t_ns;
}

std::size_t Increments::add(const core::Odometry& motion) {
  const auto at = std::upper_bound(motions_.begin(), motions_.end(), motion.t_ns, is_before_end);
  return static_cast<std::size_t>(motions_.insert(at, motion) - motions_.begin());
}

void Increments::take_out(std::size_t place) { motions_.erase(motions_.begin() + static_cast<std::ptrdiff_t>(place)); }

bool Increments::cut(core::Nanoseconds t_ns) {
  if (!cuts_ns_.insert(t_ns).second || motions_.empty() || motions_.front().t_ns >= t_ns) return false;
  const auto over = std::lower_bound(motions_.begin(), motions_.end(), t_ns, ends_before);
  return over != motions_.end() && over->t_ns != t_ns;
}

void Increments::mend(core::Nanoseconds t_ns) { cuts_ns_.erase(t_ns); }

void Increments::cut_to_pieces(std::size_t place, Pieces& pieces) const {
  core::Odometry rest = motions_[place];
  if (place > 0) {
    core::Nanoseconds from_ns = motions_[place - 1].t_ns;
    const core::Nanoseconds to_ns = rest.t_ns;
    for (auto cut = cuts_ns_.upper_bound(from_ns); cut != cuts_ns_.end() && *cut < to_ns; ++cut) {
      const auto [first, second] =
          split_motion(rest, core::seconds(*cut - from_ns) / core::seconds(to_ns - from_ns), *cut);
      pieces.motions.push_back(first);
      rest = second;
      from_ns = *cut;
    }
  }
  pieces.motions.push_back(rest);
}

Increments::Pieces Increments::pieces_about(core::Nanoseconds t_ns) const {
  const auto begin = std::lower_bound(motions_.begin(), motions_.end(), t_ns, ends_before);
  const auto next = std::upper_bound(begin, motions_.end(), t_ns, is_before_end);
  Pieces pieces;
  pieces.after_ns = begin == motions_.begin() ? std::numeric_limits<core::Nanoseconds>::min() : std::prev(begin)->t_ns;
  pieces.until_ns = next == motions_.end() ? t_ns : next->t_ns;
  for (auto one = begin; one != motions_.end() && one->t_ns <= pieces.until_ns; ++one) {
    cut_to_pieces(static_cast<std::size_t>(one - motions_.begin()), pieces);
  }
  return pieces;
}

}  // namespace helixnav::team
