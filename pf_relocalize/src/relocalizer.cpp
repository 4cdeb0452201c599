// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/relocalizer.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <Eigen/Eigenvalues>

#include "helixnav/core/errors.hpp"
#include "helixnav/core/random.hpp"
#include "helixnav/core/resampling.hpp"
#include "helixnav/core/worker_pool.hpp"
#include "helixnav/pf_relocalize/resample.hpp"

namespace helixnav::pf_relocalize {
namespace {

/// Particles are shared out to threads, and fed by random streams, in blocks of this size: a multiple of tile_size.
constexpr std::size_t block_size = 256;

void check(const RelocalizerOptions& options) {
  const bool valid = options.least_particles >= 1 && options.most_particles >= options.least_particles &&
                     options.resample_below >= 0.0 && options.resample_below <= 1.0 && options.kld_error > 0.0 &&
                     options.bin_m > 0.0 && options.bin_rad > 0.0 && options.motion_noise_scale >= 0.0 &&
                     options.threads >= 1 && options.most_modes >= 1;
  if (!valid) throw core::PreconditionError("relocalizer: an option is out of its range");
}

/// L with L Lᵀ = covariance, of any rank.
Eigen::Matrix3d noise_root(const Eigen::Matrix3d& covariance) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(covariance);
  return eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal();
}

/// x ← x ∘ (motion + noise) for particles [begin, end).
void move(Particles& particles, std::size_t begin, std::size_t end, const Eigen::Vector3d& motion,
          const Eigen::Matrix3d& root, core::RandomStream& random) {
  for (std::size_t i = begin; i < end; ++i) {
    const double n0 = random.normal(), n1 = random.normal(), n2 = random.normal();
    const Eigen::Vector3d u = motion + root * Eigen::Vector3d(n0, n1, n2);
    const double c = std::cos(particles.heading_rad[i]), s = std::sin(particles.heading_rad[i]);
    particles.x_m[i] += c * u.x() - s * u.y();
    particles.y_m[i] += s * u.x() + c * u.y();
    particles.heading_rad[i] = core::wrap_to_pi(particles.heading_rad[i] + u.z());
  }
}

}  // namespace

struct Relocalizer::Impl {
  Impl(ReferenceMap reference, const RelocalizerOptions& chosen, std::uint64_t seed);

  void start(const core::Scan& scan);
  void step(const core::Odometry& motion, const core::Scan& scan);
  void absorb_weights(core::Nanoseconds t_ns);
  void resample_when_due();

  /// f(block, begin, end) on all threads.
  template <typename Function>
  void for_each_block(Function&& f) {
    const std::size_t n = particles.size();
    pool.for_each((n + block_size - 1) / block_size,
                  [&](std::size_t block) { f(block, block * block_size, std::min(n, (block + 1) * block_size)); });
  }

  RelocalizerOptions options;
  ReferenceMap map;
  ScanLikelihood likelihood;
  core::WorkerPool pool;
  core::RandomStream random;
  std::vector<core::RandomStream> block_random;  // one per block of particles, whichever thread takes it
  Particles particles, resampled;
  std::vector<double> log_likelihood;
  std::vector<std::uint32_t> parents;
  std::vector<std::uint64_t> keys;
  std::vector<std::uint8_t> taken;
  CloudState state;
  std::size_t helix_pairs = 0;
};

Relocalizer::Impl::Impl(ReferenceMap reference, const RelocalizerOptions& chosen, std::uint64_t seed)
    : options(chosen),
      map(std::move(reference)),
      likelihood(map, chosen.sensor),
      pool(chosen.threads),
      random(seed, "relocalizer") {
  for (std::size_t first = 0; first < options.most_particles; first += block_size) {
    block_random.emplace_back(seed, "relocalizer block " + std::to_string(first / block_size));
  }
  for (Particles* cloud : {&particles, &resampled}) {
    cloud->latent.resize(static_cast<std::size_t>(map.latent_modes()));
    cloud->resize(options.most_particles);
  }
  log_likelihood.resize(options.most_particles);
  parents.reserve(options.most_particles);
  keys.reserve(options.most_particles);
  taken.reserve(options.most_particles);
  state.modes.reserve(options.most_modes);
}

void Relocalizer::Impl::start(const core::Scan& scan) {
  likelihood.set_scan(scan);
  HelixProposal proposal(map, likelihood, options.helix);
  helix_pairs = proposal.pairs();
  proposal.allot(particles.size(), random.uniform());
  for_each_block([&](std::size_t block, std::size_t begin, std::size_t end) {
    proposal.sample(particles, begin, end, block_random[block]);
  });
  order_by_place(particles);
  for_each_block([&](std::size_t, std::size_t begin, std::size_t end) {
    proposal.weigh(particles, begin, end);
    likelihood.evaluate(particles, begin, end, log_likelihood.data() + begin);
    for (std::size_t i = begin; i < end; ++i) particles.log_weight[i] += log_likelihood[i];
  });
  // Weights are Λ·prior/q with normalised densities; their mean is the evidence of the scan.
  state.log_evidence = -std::log(static_cast<double>(particles.size()));
  absorb_weights(scan.t_ns);
}

void Relocalizer::Impl::step(const core::Odometry& motion, const core::Scan& scan) {
  const Eigen::Matrix3d root = options.motion_noise_scale * noise_root(motion.covariance);
  const Eigen::Vector3d increment = motion.T_before_after.vector();
  likelihood.set_scan(scan);
  for_each_block([&](std::size_t block, std::size_t begin, std::size_t end) {
    move(particles, begin, end, increment, root, block_random[block]);
    likelihood.evaluate(particles, begin, end, log_likelihood.data() + begin);
    for (std::size_t i = begin; i < end; ++i) particles.log_weight[i] += log_likelihood[i];
  });
  absorb_weights(scan.t_ns);
}

void Relocalizer::Impl::absorb_weights(core::Nanoseconds t_ns) {
  state.log_evidence += core::normalise(particles.log_weight);
  state.t_ns = t_ns;
  ++state.scans;
  state.particles = particles.size();
  state.effective_size = core::effective_sample_size(particles.log_weight);
  state.cloud = cloud_moments(particles);
  find_modes(particles, options.mode_radius, options.most_modes, 1e-4, taken, state.modes);
  resample_when_due();
}

void Relocalizer::Impl::resample_when_due() {
  const double n = static_cast<double>(particles.size());
  state.resampled = state.effective_size < options.resample_below * n;
  parents.clear();  // empty: every particle is its own parent
  if (!state.resampled) return;
  const double offset = random.uniform();
  core::systematic_parents(particles.log_weight, particles.size(), offset, parents);
  const std::size_t bins = occupied_bins(particles, parents, options.bin_m, options.bin_rad, keys);
  const std::size_t wanted =
      std::clamp(kld_sample_size(bins, options.kld_error), options.least_particles, options.most_particles);
  core::systematic_parents(particles.log_weight, wanted, offset, parents);
  take_parents(particles, parents, resampled);
  std::swap(particles, resampled);
}

Relocalizer::Relocalizer(ReferenceMap map, const core::Scan& first_scan, const RelocalizerOptions& options,
                         std::uint64_t seed) {
  check(options);
  impl_ = std::make_unique<Impl>(std::move(map), options, seed);
  impl_->start(first_scan);
}

Relocalizer::~Relocalizer() = default;
Relocalizer::Relocalizer(Relocalizer&&) noexcept = default;
Relocalizer& Relocalizer::operator=(Relocalizer&&) noexcept = default;

void Relocalizer::step(const core::Odometry& motion, const core::Scan& scan) { impl_->step(motion, scan); }
const CloudState& Relocalizer::state() const { return impl_->state; }
const ReferenceMap& Relocalizer::map() const { return impl_->map; }
std::size_t Relocalizer::helix_pairs() const { return impl_->helix_pairs; }
const Particles& Relocalizer::particles() const { return impl_->particles; }
const Particles& Relocalizer::weighted_particles() const {
  return impl_->state.resampled ? impl_->resampled : impl_->particles;
}

bool meets_paper_rule(const CloudState& state, const core::Odometry& motion) {
  const Eigen::Vector3d variance = state.cloud.covariance.diagonal();
  // The odometry's noise is in the vehicle's frame, the cloud's in the map's: for x and y the mean of both axes.
  const double noise_m2 = 0.5 * (motion.covariance(0, 0) + motion.covariance(1, 1));
  return variance[0] < 4.0 * noise_m2 && variance[1] < 4.0 * noise_m2 && variance[2] < 4.0 * motion.covariance(2, 2);
}

bool meets_gate(const CloudState& state, const GateLimits& limits) {
  if (state.modes.empty() || state.scans < limits.least_scans || state.log_evidence <= limits.log_evidence)
    return false;
  const Mode& mode = state.modes.front();
  const Eigen::Vector3d sigma = mode.pose.covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  return mode.mass > limits.least_mass && std::max(sigma.x(), sigma.y()) < limits.sigma_position_m &&
         sigma.z() < limits.sigma_heading_rad;
}

SearchOutcome judge_search(const CloudState& state, const GateLimits& gate, const GiveUpLimits& give_up) {
  if (state.scans >= give_up.null_after_scans && state.log_evidence < give_up.null_log_evidence) {
    return SearchOutcome::nothing_here;
  }
  if (meets_gate(state, gate)) return SearchOutcome::gate_met;
  return state.scans >= give_up.most_scans ? SearchOutcome::timed_out : SearchOutcome::searching;
}

}  // namespace helixnav::pf_relocalize
