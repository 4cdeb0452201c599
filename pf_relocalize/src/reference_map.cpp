// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/reference_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include <Eigen/Eigenvalues>

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

/// Share of the largest element that core takes for rounding of a covariance.
constexpr double rounding = 1e-9;

std::string in_digits(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

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

std::string unusable(const core::JointGaussian& joint) {
  const std::size_t n = joint.points_m.size();
  if (n < 3 || joint.ids.size() != n) {
    return "at least three landmarks with their ids are needed, there are " + std::to_string(n);
  }
  const Eigen::MatrixXd& P = joint.covariance;
  if (P.rows() != 3 + 2 * static_cast<Eigen::Index>(n) || P.cols() != P.rows()) {
    return "the joint covariance has the wrong size";
  }
  const bool finite = P.allFinite() && joint.pose.vector().allFinite() &&
                      std::all_of(joint.points_m.begin(), joint.points_m.end(),
                                  [](const Eigen::Vector2d& point) { return point.allFinite(); });
  if (!finite) return "the joint estimate is not finite";
  const double off = core::asymmetry(P);
  if (off > rounding * P.cwiseAbs().maxCoeff()) {
    return "the joint covariance is not symmetric: off by " + in_digits(off);
  }
  return {};
}

/// How much the change of frame can enlarge an error of the covariance: |J|² by rows, a position relative to the bases
/// being (its own) − (the first base's) − (lever)·(the difference of the bases).
double enlargement(const core::JointGaussian& relative, const Bases& bases) {
  double furthest_m = relative.pose.position_m().norm();
  for (const Eigen::Vector2d& point : relative.points_m) furthest_m = std::max(furthest_m, point.norm());
  const double row = 2.0 + 2.0 * furthest_m / relative.points_m[static_cast<std::size_t>(bases.b)].norm();
  return row * row;
}

/// Raises the eigenvalues that rounding made negative; the least one before.
double raise_to_zero(double tolerance, Eigen::MatrixXd& P) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(P);
  const double least = eigen.eigenvalues().minCoeff();
  if (least < -tolerance || !std::isfinite(least)) return least;
  const Eigen::MatrixXd V = eigen.eigenvectors();
  P = V * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * V.transpose();
  P = (0.5 * (P + P.transpose())).eval();
  return least;
}

/// As the covariance of all in the base frame would be judged, whose largest element is the largest variance: the first base, whose
/// own covariance is nothing but rounding, is not judged by that.
bool is_sound(const MarginalsInBaseFrame& marginals) {
  double largest = marginals.pose.covariance.diagonal().maxCoeff();
  for (const core::PointGaussian& point : marginals.points)
    largest = std::max(largest, point.covariance_m2.diagonal().maxCoeff());
  const auto is_covariance = [shift = rounding * largest](const auto& covariance) {
    auto raised = covariance.eval();
    raised.diagonal().array() += shift;
    return core::is_symmetric_positive_semidefinite(raised);
  };
  return is_covariance(marginals.pose.covariance) &&
         std::all_of(marginals.points.begin(), marginals.points.end(),
                     [&](const core::PointGaussian& point) { return is_covariance(point.covariance_m2); });
}

/// The marginals need neither the covariances between landmarks nor a joint test, O(n³).
std::optional<ReferenceMap> of_marginals(const core::JointGaussian& joint, const Bases& bases) {
  MarginalsInBaseFrame marginals = marginals_in_base_frame(joint, bases);
  if (!is_sound(marginals)) return std::nullopt;
  ReferenceMap map;
  map.T_world_base = base_frame(joint, bases);
  map.bases = bases;
  map.ids = joint.ids;
  map.prior = marginals.pose;
  map.latent.resize(2 * static_cast<Eigen::Index>(joint.points_m.size()), 0);
  map.prior_by_latent.resize(3, 0);
  map.landmarks = std::move(marginals.points);
  return map;
}

ReferenceMapResult on_bases(const core::JointGaussian& joint, const Bases& bases, const ReferenceMapOptions& options) {
  ReferenceMapResult result;
  if (options.decorrelation == Decorrelation::relative_marginals) {
    result.map = of_marginals(joint, bases);
    if (result.map) return result;
  }
  core::JointGaussian relative = in_base_frame(joint, bases);
  if (!core::is_symmetric_positive_semidefinite(relative.covariance)) {
    const double tolerance = rounding * joint.covariance.cwiseAbs().maxCoeff() * enlargement(relative, bases);
    result.least_eigenvalue = raise_to_zero(tolerance, relative.covariance);
    const bool is_rounding = result.least_eigenvalue >= -tolerance;
    if (!is_rounding) {
      result.reason = "the joint covariance is not positive semidefinite: in the base frame its least eigenvalue is " +
                      in_digits(result.least_eigenvalue) + ", which rounding explains down to " + in_digits(-tolerance);
      return result;
    }
  }
  ReferenceMap& map = result.map.emplace();
  map.T_world_base = base_frame(joint, bases);
  map.bases = bases;
  map.ids = joint.ids;
  map.prior = {relative.pose, relative.covariance.topLeftCorner<3, 3>()};
  map.latent.resize(2 * static_cast<Eigen::Index>(joint.points_m.size()), 0);
  map.prior_by_latent.resize(3, 0);
  const Blocks blocks = decorrelate(relative, options, map);
  for (std::size_t i = 0; i < blocks.size(); ++i) map.landmarks.push_back({relative.points_m[i], blocks[i]});
  return result;
}

ReferenceMap map_or_throw(ReferenceMapResult&& result) {
  if (!result.map) throw core::PreconditionError("build_reference_map: " + result.reason);
  return std::move(*result.map);
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

ReferenceMapResult try_reference_map(const core::JointGaussian& joint, const ReferenceMapOptions& options) {
  ReferenceMapResult result;
  result.reason = unusable(joint);
  if (!result.reason.empty()) return result;
  const Bases bases = choose_bases(joint);
  const Eigen::Vector2d base_m =
      joint.points_m[static_cast<std::size_t>(bases.b)] - joint.points_m[static_cast<std::size_t>(bases.a)];
  if (base_m.norm() < 1e-6) {
    result.reason = "all landmarks stand at one place";
    return result;
  }
  return on_bases(joint, bases, options);
}

ReferenceMap build_reference_map(const core::JointGaussian& joint, const ReferenceMapOptions& options) {
  return map_or_throw(try_reference_map(joint, options));
}

ReferenceMap build_reference_map(const core::JointGaussian& joint, const Bases& bases,
                                 const ReferenceMapOptions& options) {
  const std::string reason = unusable(joint);
  if (!reason.empty()) throw core::PreconditionError("build_reference_map: " + reason);
  return map_or_throw(on_bases(joint, bases, options));
}

}  // namespace helixnav::pf_relocalize
