// SPDX-License-Identifier: BSD-3-Clause
#include "history.hpp"

#include <limits>
#include <utility>

namespace helixnav::supervisor {

void History::note(Event event) {
  if (moment_) since_.push_back(std::move(event));
}

void History::settle(std::int64_t step, cekf::CompressedEkf& filter, const association::LandmarkLife& life) {
  constexpr std::int64_t stride = 10;
  if (moment_ && step - moment_->step < stride && filter.phase() == moment_->filter.phase) return;
  moment_ = Moment{step, filter.snapshot(), life};
  since_.clear();
  filter.keep_since(moment_->filter.phase);
}

void History::clear(cekf::CompressedEkf& filter) {
  moment_.reset();
  since_.clear();
  filter.keep_since(std::numeric_limits<long>::max());
}

std::vector<History::Event> History::rewind(cekf::CompressedEkf& filter, association::LandmarkLife& life) {
  filter.restore(moment_->filter);
  life = std::move(moment_->life);
  std::vector<Event> since = std::move(since_);
  clear(filter);
  return since;
}

}  // namespace helixnav::supervisor
