// SPDX-License-Identifier: BSD-3-Clause
#include "placing/map_questions.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "placing/question_landmarks.hpp"

namespace helixnav::supervisor {
namespace {

constexpr std::size_t least_in_question = 8;
constexpr std::size_t most_in_question = 40;

using Near = std::vector<std::pair<double, std::size_t>>;

/// The landmarks nearest to one of them, by distance.
Near nearest(const core::JointGaussian& landmarks, std::size_t centre) {
  Near near;
  for (std::size_t i = 0; i < landmarks.ids.size(); ++i) {
    near.emplace_back((landmarks.points_m[i] - landmarks.points_m[centre]).norm(), i);
  }
  const std::size_t kept = std::min(most_in_question, near.size());
  std::partial_sort(near.begin(), near.begin() + static_cast<std::ptrdiff_t>(kept), near.end());
  near.resize(kept);
  return near;
}

}  // namespace

std::vector<relocalize::Question> map_questions(const EarlierMap& map, const relocalize::IndexOptions& lengths) {
  const core::JointGaussian& landmarks = map.landmarks();
  std::vector<relocalize::Question> questions;
  if (landmarks.ids.size() < least_in_question) return questions;
  std::vector<bool> asked(landmarks.ids.size(), false);
  for (std::size_t centre = 0; centre < asked.size(); ++centre) {
    if (asked[centre]) continue;
    const Near near = nearest(landmarks, centre);
    std::vector<std::size_t> chosen;
    for (const auto& [distance_m, i] : near) {
      if (chosen.size() < near.size() / 2) asked[i] = true;
      chosen.push_back(i);
    }
    relocalize::Question question;
    question.landmarks = question_landmarks(landmarks, chosen, lengths.pair_noise_m, map.appearance());
    std::vector<Eigen::Vector2d> points_m;
    for (const std::size_t i : chosen) points_m.push_back(landmarks.points_m[i]);
    question.looked = relocalize::ground_around(points_m, lengths.reach_m);
    if (!question.looked.empty()) questions.push_back(std::move(question));
  }
  return questions;
}

}  // namespace helixnav::supervisor
