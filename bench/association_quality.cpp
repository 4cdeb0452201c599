// SPDX-License-Identifier: BSD-3-Clause
//
// Share of right and wrong matches of each method on single ambiguous scans whose truth is known. The defaults of
// association::Options were chosen from this table.
#include <algorithm>
#include <cstdio>
#include <string>

#include "helixnav/association/associate.hpp"
#include "scenes.hpp"

namespace {

using namespace helixnav;
using association::Method;

struct World {
  int observations;
  int landmarks;
  double sigma_m;
  double patch_m;
};

void print_row(const std::string& what, const World& world, Method method, const association::Options& options) {
  core::RandomStream random(3, "quality");
  int seen = 0;
  int right = 0;
  int wrong = 0;
  int budget_hits = 0;
  for (int t = 0; t < 400; ++t) {
    const association::Scene scene =
        association::crowded_scene(random, world.observations, world.landmarks, world.sigma_m, world.patch_m);
    const association::Assignment a =
        association::associate(method, association::make_innovation_problem(scene.map, scene.scan), options);
    budget_hits += a.budget_hit;
    for (std::size_t i = 0; i < scene.truth.size(); ++i) {
      seen += scene.truth[i] >= 0;
      if (a.observations[i].outcome != association::Outcome::matched) continue;
      ++(a.observations[i].candidate == scene.truth[i] ? right : wrong);
    }
  }
  std::printf("  %-42s right %5.1f %%   wrong of the matched %5.2f %%   budget hit %d\n", what.c_str(),
              100.0 * right / seen, 100.0 * wrong / std::max(1, right + wrong), budget_hits);
}

}  // namespace

int main() {
  for (const World& world : {World{15, 30, 0.3, 20.0}, World{14, 20, 0.3, 8.5}, World{8, 12, 0.6, 8.0}}) {
    std::printf("%d observations, %d landmarks, errors %.1f m, patch %.1f m, 400 scans\n", world.observations,
                world.landmarks, world.sigma_m, world.patch_m);
    for (const Method method : {Method::nearest_neighbour, Method::nearest_neighbour_unique, Method::ihgr_published,
                                Method::likelihood_ratio, Method::jcbb, Method::joint_likelihood_ratio}) {
      print_row(std::string(name(method)), world, method, {});
    }
    association::Options options;
    options.joint_test = false;
    print_row("likelihood-ratio without joint test", world, Method::likelihood_ratio, options);
    options = {};
    options.joint_alternatives = 0;
    print_row("likelihood-ratio, dropping only", world, Method::likelihood_ratio, options);
    options = {};
    options.min_margin_nats = 1.0;
    print_row("likelihood-ratio, margin 1 nat", world, Method::likelihood_ratio, options);
    print_row("joint-likelihood-ratio, margin 1 nat", world, Method::joint_likelihood_ratio, options);
  }
}
