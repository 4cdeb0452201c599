// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/reference_map.hpp"

#include <array>
#include <string>
#include <utility>

#include "helixnav/core/errors.hpp"
#include "helixnav/pf_relocalize/conservative_bound.hpp"

namespace helixnav::pf_relocalize {
namespace {

constexpr std::array<std::pair<Decorrelation, std::string_view>, 6> names{{
    {Decorrelation::relative_marginals, "relative-marginals"},
    {Decorrelation::scalar_bound, "scalar-bound"},
    {Decorrelation::trace_bound, "trace-bound"},
    {Decorrelation::whitened_bound, "whitened-bound"},
    {Decorrelation::constellations, "constellations"},
    {Decorrelation::latent_modes, "latent-modes"},
}};

/// Blocks of the decorrelated map; fills the latent parts of `map` where the rule has any.
Blocks decorrelate(const core::JointGaussian& relative, const ReferenceMapOptions& options, ReferenceMap& map) {
  const Eigen::Index size = relative.covariance.rows() - 3;
  const auto P = relative.covariance.bottomRightCorner(size, size);
  switch (options.decorrelation) {
    case Decorrelation::relative_marginals:
      return diagonal_blocks(P);
    case Decorrelation::scalar_bound:
      return scalar_bound(P);
    case Decorrelation::trace_bound:
      return trace_bound(P);
    case Decorrelation::whitened_bound:
      return whitened_bound(P, options.sweeps);
    case Decorrelation::constellations:
      return constellation_bound(P, constellations(relative.points_m, options.constellation_size), options.sweeps);
    case Decorrelation::latent_modes:
      break;
  }
  LatentBound bound = latent_bound(P, std::min<int>(options.latent_modes, static_cast<int>(size)), options.sweeps);
  map.latent = std::move(bound.V);
  map.prior_by_latent = relative.covariance.topRightCorner(3, size) * bound.regression;
  return bound.residual;
}

}  // namespace

std::string_view name_of(Decorrelation decorrelation) {
  for (const auto& [value, name] : names) {
    if (value == decorrelation) return name;
  }
  throw core::PreconditionError("name_of: not a Decorrelation");
}

Decorrelation decorrelation_from(std::string_view name) {
  std::string known;
  for (const auto& [value, word] : names) {
    if (word == name) return value;
    known += (known.empty() ? "" : ", ") + std::string(word);
  }
  throw core::InputError("decorrelation '" + std::string(name) + "' is unknown; one of: " + known);
}

ReferenceMap build_reference_map(const core::JointGaussian& joint, const ReferenceMapOptions& options) {
  return build_reference_map(joint, choose_bases(joint), options);
}

ReferenceMap build_reference_map(const core::JointGaussian& joint, const Bases& bases,
                                 const ReferenceMapOptions& options) {
  if (joint.points_m.size() < 3 || joint.ids.size() != joint.points_m.size()) {
    throw core::PreconditionError("build_reference_map: at least three landmarks with their ids are needed");
  }
  if (!core::is_symmetric_positive_semidefinite(joint.covariance)) {
    throw core::PreconditionError("build_reference_map: the joint covariance is not symmetric positive semidefinite");
  }
  const core::JointGaussian relative = in_base_frame(joint, bases);
  ReferenceMap map;
  map.T_world_base = base_frame(joint, bases);
  map.bases = bases;
  map.ids = joint.ids;
  map.prior = {relative.pose, relative.covariance.topLeftCorner<3, 3>()};
  map.latent.resize(2 * static_cast<Eigen::Index>(joint.points_m.size()), 0);
  map.prior_by_latent.resize(3, 0);
  const Blocks blocks = decorrelate(relative, options, map);
  for (std::size_t i = 0; i < blocks.size(); ++i) map.landmarks.push_back({relative.points_m[i], blocks[i]});
  return map;
}

}  // namespace helixnav::pf_relocalize
