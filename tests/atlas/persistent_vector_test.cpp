// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <vector>

#include "helixnav/core/random.hpp"
#include "tree/persistent_vector.hpp"

namespace helixnav::atlas {
namespace {

TEST(PersistentVector, AndAllItsCopiesBehaveLikeVectors) {
  core::RandomStream random(22);
  std::vector<PersistentVector<int>> shared(1);
  std::vector<std::vector<int>> plain(1);
  for (int step = 0; step < 20000; ++step) {
    const std::size_t which = random.below(shared.size());
    const auto value = static_cast<int>(random.below(1000000));
    if (plain[which].empty() || random.uniform() < 0.4) {
      shared[which].push_back(value);
      plain[which].push_back(value);
    } else if (random.uniform() < 0.98) {
      const std::size_t at = random.below(plain[which].size());
      shared[which].write(at) = value;
      plain[which][at] = value;
    } else {
      const std::size_t to = random.below(8);
      if (to < shared.size()) {
        shared[to] = shared[which];
        plain[to] = plain[which];
      } else {
        shared.emplace_back(PersistentVector<int>(shared[which]));
        plain.push_back(std::vector<int>(plain[which]));
      }
    }
  }
  for (std::size_t which = 0; which < shared.size(); ++which) {
    ASSERT_EQ(shared[which].size(), plain[which].size());
    for (std::size_t i = 0; i < plain[which].size(); ++i) ASSERT_EQ(shared[which][i], plain[which][i]);
  }
}

}  // namespace
}  // namespace helixnav::atlas
