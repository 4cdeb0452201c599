// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/relocalize/answer.hpp"
#include "helixnav/relocalize/map_index.hpp"
#include "helixnav/relocalize/question.hpp"

namespace helixnav::relocalize {

struct AskOptions {
  double alpha = 1e-5;  ///< probability that one question is answered falsely
  /// Greatest density of the evidence, per nat, over questions whose place is on the map: 0.03 to 0.09 measured
  /// (docs/relocalize.md). 1 asks for what holds whatever the density: landmarks whose errors are not independent.
  double evidence_density = 0.1;
  double most_candidates = 1.5e6;  ///< triangles of the map looked at; the search is capped there
};

/// Evidence in nats that a place needs to be accepted. Evidence is the ratio of likelihoods of "somewhere on the map" and "not
/// on it", so P(E >= t | absent) = mean over the present of e^-E where E >= t, at most density * e^-t.
double evidence_needed(const AskOptions& options);

/// Where in the map is this constellation? Without a prior every place of the map is looked at; a prior only weighs places.
/// Deterministic; reads the index only, so that several threads may ask it. Cost: a few milliseconds for a map of 10⁴
/// landmarks, in proportion to the map beyond (docs/relocalize.md).
/// PreconditionError for a map without looked-at ground, values in the question that are not finite, covariances that
/// are not positive definite, a question with landmarks but without looked-at ground, or α or density outside (0, 1)
/// and (0, 1].
/// Test: relocalize/ask_test.cpp, relocalize/evidence_test.cpp, relocalize/campaign_test.cpp.
Answer ask(const MapIndex& map, const Question& question, const AskOptions& options = {});

}  // namespace helixnav::relocalize
