// SPDX-License-Identifier: BSD-3-Clause
#include "genealogy.hpp"

#include <algorithm>
#include <numeric>

namespace helixnav::fastslam {

void Genealogy::set_mark(std::size_t particles) {
  Mark mark;
  mark.at_m = driven_m_;
  mark.ancestor.resize(particles);
  std::iota(mark.ancestor.begin(), mark.ancestor.end(), 0U);
  marks_.push_back(std::move(mark));
}

void Genealogy::descend(const std::vector<std::uint32_t>& parents) {
  for (Mark& mark : marks_) {
    std::vector<std::uint32_t> ancestor(parents.size());
    for (std::size_t k = 0; k < parents.size(); ++k) ancestor[k] = mark.ancestor[parents[k]];
    mark.ancestor = std::move(ancestor);
  }
}

void Genealogy::drive(double length_m, std::size_t particles) {
  driven_m_ += length_m;
  if (driven_m_ - marks_.back().at_m >= back_m_ / 8.0) set_mark(particles);
  while (marks_.size() > 1 && driven_m_ - marks_[1].at_m >= back_m_) marks_.pop_front();
}

std::size_t Genealogy::distinct_ancestors() const {
  // Ancestors of children in order are in order: resampling keeps the order of the parents.
  const std::vector<std::uint32_t>& ancestor = marks_.front().ancestor;
  std::size_t distinct = ancestor.empty() ? 0 : 1;
  for (std::size_t k = 1; k < ancestor.size(); ++k) distinct += ancestor[k] != ancestor[k - 1];
  return distinct;
}

}  // namespace helixnav::fastslam
