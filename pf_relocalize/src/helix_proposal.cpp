// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/pf_relocalize/helix_proposal.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "helixnav/core/errors.hpp"
#include "scan_likelihood_impl.hpp"

namespace helixnav::pf_relocalize {
namespace {

constexpr std::size_t heading_cells = 24;

/// Lower Cholesky factor of a positive semidefinite 2×2 matrix.
Eigen::Matrix2d lower_root(double xx, double xy, double yy) {
  const double l11 = std::sqrt(std::max(xx, 0.0));
  const double l21 = l11 > 0.0 ? xy / l11 : 0.0;
  Eigen::Matrix2d L;
  L << l11, 0.0, l21, std::sqrt(std::max(yy - l21 * l21, 0.0));
  return L;
}

Eigen::Vector3d pose_difference(const core::Pose2& a, const core::Pose2& b) {
  return {a.x_m - b.x_m, a.y_m - b.y_m, core::wrap_to_pi(a.heading_rad - b.heading_rad)};
}

/// One after another, not as arguments of a call, whose order the compiler chooses. The last one first: GCC chose this order,
/// and the published results were drawn in it.
template <int n>
Eigen::Matrix<double, n, 1> normals(core::RandomStream& random) {
  Eigen::Matrix<double, n, 1> drawn;
  for (int i = n; i-- > 0;) drawn[i] = random.normal();
  return drawn;
}

}  // namespace

HelixProposal::HelixProposal(const ReferenceMap& map, const ScanLikelihood& likelihood, const HelixOptions& options)
    : map_(map), likelihood_(likelihood), options_(options) {
  if (!(options.prior_share >= 0.0 && options.prior_share <= 1.0 && options.prior_inflation >= 1.0)) {
    throw core::PreconditionError("helix proposal: prior_share must lie in [0, 1] and prior_inflation be at least 1");
  }
  Eigen::Matrix3d given_latent = map.prior.covariance - map.prior_by_latent * map.prior_by_latent.transpose();
  given_latent.diagonal().array() += 1e-9;  // a pose known exactly in one direction still has a density
  const Eigen::LLT<Eigen::Matrix3d> llt(given_latent);
  if (llt.info() != Eigen::Success) {
    throw core::PreconditionError("helix proposal: the covariance of the prior is not positive semidefinite");
  }
  prior_L_ = llt.matrixL();
  prior_information_ = given_latent.inverse();
  log_prior_norm_ = -1.5 * std::log(2.0 * core::pi) - std::log(prior_L_.diagonal().prod());
  const double half_width = std::min(core::pi, options.sigmas * std::sqrt(map.prior.covariance(2, 2) + 1e-9));
  heading_min_rad_ = map.prior.mean.heading_rad - half_width;
  heading_step_rad_ = 2.0 * half_width / static_cast<double>(heading_cells);
  weigh_cells();
}

void HelixProposal::weigh_cells() {
  const LandmarkTable& table = likelihood_.impl_->table;
  const std::vector<RobotPoint>& points = likelihood_.impl_->points;
  double tube_variance = table.largest;
  for (const RobotPoint& point : points) tube_variance = std::max(tube_variance, largest_variance(point.covariance_m2));
  Eigen::Matrix3d spread = options_.prior_inflation * map_.prior.covariance;
  spread.diagonal() += Eigen::Vector3d(tube_variance, tube_variance, 1e-9);
  const Eigen::Matrix3d information = spread.inverse();
  weight_.assign(points.size() * table.size() * heading_cells, 0.0);
  double total = 0.0;
  for (std::size_t j = 0; j < points.size(); ++j) {
    std::array<Eigen::Vector3d, heading_cells> offset;  // pose minus (landmark, 0), minus the prior's mean
    for (std::size_t k = 0; k < heading_cells; ++k) {
      const double heading = heading_min_rad_ + (static_cast<double>(k) + 0.5) * heading_step_rad_;
      const Eigen::Vector2d position = -(core::rotation(heading) * points[j].mean_m);
      offset[k] = pose_difference({position.x(), position.y(), heading}, map_.prior.mean);
    }
    for (std::size_t i = 0; i < table.size(); ++i) {
      const std::size_t pair = j * table.size() + i;
      const std::size_t before = cells_.size();
      for (std::size_t k = 0; k < heading_cells; ++k) {
        const Eigen::Vector3d d = offset[k] + Eigen::Vector3d(table.x[i], table.y[i], 0.0);
        const double d2 = d.dot(information * d);
        if (d2 > options_.sigmas * options_.sigmas) continue;
        weight_[pair * heading_cells + k] = std::exp(-0.5 * d2);
        total += weight_[pair * heading_cells + k];
        cells_.push_back({static_cast<std::uint32_t>(pair), static_cast<std::uint32_t>(k)});
      }
      pairs_ += cells_.size() > before ? 1 : 0;
    }
  }
  for (double& weight : weight_) weight /= std::max(total, 1e-300);
}

void HelixProposal::allot(std::size_t n, double offset) {
  prior_share_ = cells_.empty() ? 1.0 : options_.prior_share;
  from_prior_ = static_cast<std::size_t>(std::lround(prior_share_ * static_cast<double>(n)));
  prior_share_ = static_cast<double>(from_prior_) / static_cast<double>(n);
  allotted_.clear();
  const double on_helices = static_cast<double>(n - from_prior_);
  double reached = 0.0;
  for (const Cell& cell : cells_) {
    reached += weight_[cell.pair * heading_cells + cell.heading] * on_helices;
    while (static_cast<double>(allotted_.size()) + offset < reached && allotted_.size() < n - from_prior_) {
      allotted_.push_back(cell);
    }
  }
  while (allotted_.size() < n - from_prior_) allotted_.push_back(cells_.back());  // round-off in the last sum
}

void HelixProposal::sample(Particles& particles, std::size_t begin, std::size_t end, core::RandomStream& random) const {
  const LandmarkTable& table = likelihood_.impl_->table;
  for (std::size_t i = begin; i < end; ++i) {
    Eigen::VectorXd xi(static_cast<Eigen::Index>(table.modes));
    for (std::size_t k = 0; k < table.modes; ++k) {
      particles.latent[k][i] = random.normal();
      xi[static_cast<Eigen::Index>(k)] = particles.latent[k][i];
    }
    if (i < from_prior_) {
      const Eigen::Vector3d noise = normals<3>(random);
      const Eigen::Vector3d shift = map_.prior_by_latent * xi;
      particles.set_pose(i, core::Pose2(map_.prior.mean.vector() + shift + prior_L_ * noise));
      continue;
    }
    const Cell cell = allotted_[i - from_prior_];
    const RobotPoint& point = likelihood_.impl_->points[cell.pair / table.size()];
    const std::size_t m = cell.pair % table.size();
    const double heading =
        heading_min_rad_ + (static_cast<double>(cell.heading) + random.uniform()) * heading_step_rad_;
    const Eigen::Matrix2d& R = point.covariance_m2;
    const Eigen::Vector2d map_noise = normals<2>(random);
    const Eigen::Vector2d noise = normals<2>(random);
    Eigen::Vector2d landmark(table.x[m], table.y[m]);
    if (table.modes > 0) landmark += map_.latent.middleRows<2>(2 * static_cast<Eigen::Index>(m)) * xi;
    landmark += lower_root(table.sxx[m], table.sxy[m], table.syy[m]) * map_noise;
    const Eigen::Vector2d seen = point.mean_m + lower_root(R(0, 0), R(0, 1), R(1, 1)) * noise;
    const Eigen::Vector2d position = landmark - core::rotation(heading) * seen;
    particles.set_pose(i, {position.x(), position.y(), heading});
  }
}

void HelixProposal::weigh(Particles& particles, std::size_t begin, std::size_t end) const {
  TileArray log_q;
  for (std::size_t first = begin; first < end; first += tile_size) {
    const std::size_t last = std::min(first + tile_size, end);
    log_proposal(particles, first, last, log_q.data());
    for (std::size_t i = first; i < last; ++i) particles.log_weight[i] = log_prior(particles, i) - log_q[i - first];
  }
}

double HelixProposal::log_prior(const Particles& particles, std::size_t i) const {
  Eigen::Vector3d d = pose_difference(particles.pose(i), map_.prior.mean);
  for (std::size_t k = 0; k < particles.latent.size(); ++k) {
    d -= particles.latent[k][i] * map_.prior_by_latent.col(static_cast<Eigen::Index>(k));
  }
  return log_prior_norm_ - 0.5 * d.dot(prior_information_ * d);
}

int HelixProposal::heading_cell(double heading_rad) const {
  const double middle = heading_min_rad_ + 0.5 * static_cast<double>(heading_cells) * heading_step_rad_;
  const double offset = core::wrap_to_pi(heading_rad - middle) + (middle - heading_min_rad_);
  const double cell = std::floor(offset / heading_step_rad_);
  return cell >= 0.0 && cell < static_cast<double>(heading_cells) ? static_cast<int>(cell) : -1;
}

void HelixProposal::log_proposal(const Particles& particles, std::size_t begin, std::size_t end, double* out) const {
  const ScanLikelihood::Impl& impl = *likelihood_.impl_;
  const double tube_share = (1.0 - prior_share_) / heading_step_rad_;
  TileArray density, factor{};
  std::array<int, tile_size> heading;
  for (std::size_t first = begin; first < end; first += tile_size) {
    ParticleTile tile(impl.table, particles, first, std::min(first + tile_size, end));
    for (std::size_t p = 0; p < tile.poses.n; ++p) {
      heading[p] = heading_cell(particles.heading_rad[first + p]);
      density[p] = prior_share_ * std::exp(log_prior(particles, first + p));
    }
    for (std::size_t j = 0; j < impl.points.size(); ++j) {
      const auto weight_of = [&](std::uint32_t i) {
        const double* cells = weight_.data() + (j * impl.table.size() + i) * heading_cells;
        for (std::size_t p = 0; p < tile.poses.n; ++p) {
          factor[p] = heading[p] < 0 ? 0.0 : tube_share * cells[static_cast<std::size_t>(heading[p])];
        }
        return factor.data();
      };
      add_point_densities(tile, impl.points[j], weight_of, density.data());
    }
    for (std::size_t p = 0; p < tile.poses.n; ++p) out[first - begin + p] = std::log(std::max(density[p], 1e-300));
  }
}

}  // namespace helixnav::pf_relocalize
