// SPDX-License-Identifier: BSD-3-Clause
#include "systematic/systematic_learner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include <Eigen/Eigenvalues>

namespace helixnav::supervisor {
namespace {

constexpr std::size_t errors_count = SystematicErrors::count;
using Chosen = std::array<bool, errors_count>;

constexpr double new_one = 36.0;            // of χ²: six standard deviations
constexpr double with_closings_one = 25.0;  // with two kinds of evidence
constexpr double known_one = 9.0;           // an error that was found before is only made more precise

/// The errors that minimise χ², and by how much they lower it.
struct Fit {
  SystematicErrors::Vector errors = SystematicErrors::Vector::Zero();
  double lowers = 0.0;
  int rank = 0;
};

/// Of errors that only a combination is known of (turning per second and per metre at constant speed), the shortest.
Fit fit(const SystematicErrors::Matrix& information, const SystematicErrors::Vector& gradient) {
  SystematicErrors::Vector unit;  // so that metres and radians compare
  for (Eigen::Index i = 0; i < unit.size(); ++i)
    unit(i) = information(i, i) > 0.0 ? 1.0 / std::sqrt(information(i, i)) : 0.0;
  const Eigen::SelfAdjointEigenSolver<SystematicErrors::Matrix> parts(
      SystematicErrors::Matrix(unit.asDiagonal() * information * unit.asDiagonal()));
  constexpr double undetermined = 1e-6;
  Fit found;
  for (Eigen::Index i = 0; i < unit.size(); ++i) {
    const double value = parts.eigenvalues()(i);
    if (!(value > undetermined)) continue;
    const SystematicErrors::Vector direction = unit.cwiseProduct(parts.eigenvectors().col(i));
    const double along = direction.dot(gradient);
    found.errors += direction * (along / value);
    found.lowers += along * along / value;
    ++found.rank;
  }
  return found;
}

/// The others held at zero.
Fit fit(SystematicErrors::Matrix information, SystematicErrors::Vector gradient, const Chosen& chosen) {
  for (std::size_t i = 0; i < errors_count; ++i) {
    if (chosen[i]) continue;
    const auto row = static_cast<Eigen::Index>(i);
    information.row(row).setZero();
    information.col(row).setZero();
    gradient(row) = 0.0;
  }
  return fit(information, gradient);
}

/// A distance m becomes m (1 − e) in the linear model, and m/(1 + too_long) when the error is taken out.
SystematicErrors of_linear(const SystematicErrors::Vector& e) {
  SystematicErrors errors(e);
  constexpr double most = 0.5;
  const double share = std::clamp(e(0), -most, most);
  errors.too_long = share / (1.0 - share);
  return errors;
}

SystematicErrors::Vector linear(const SystematicErrors& errors) {
  SystematicErrors::Vector e = errors.vector();
  e(0) /= 1.0 + errors.too_long;
  return e;
}

}  // namespace

void SystematicLearner::add(const StretchEvidence& stretch) {
  const Fit own = fit(stretch.information, stretch.gradient);
  const double worse =
      std::max(1.0, (stretch.chi2 - own.lowers) / std::max(1, stretch.dof));  // than its covariances say
  all_.information += stretch.information / worse;
  all_.gradient += stretch.gradient / worse;
  in_rows_ += stretch.in_rows;
  motions_ += stretch.motions;
  sightings_ += stretch.sightings;
  of_stretches_ += own.lowers / worse;
  rank_ += own.rank;
  ++stretches_;
  ++since_;
  const bool is_power_of_two = (since_ & (since_ - 1)) == 0;
  if (is_power_of_two) early_ = std::exchange(pending_, all_);
}

void SystematicLearner::add_closing(const StretchEvidence& closing) {
  const Fit own = fit(closing.information, closing.gradient);
  const double worse = std::max(1.0, (closing.chi2 - own.lowers) / std::max(1, closing.dof));
  closings_.information += closing.information / worse;
  closings_.gradient += closing.gradient / worse;
  has_closed_ = true;
}

/// Of the stretches about what they say together, per degree of freedom.
double SystematicLearner::scatter() const {
  const Fit together = fit(all_.information, all_.gradient);
  return std::max(1.0, (of_stretches_ - together.lowers) / std::max(1, rank_ - together.rank));
}

/// Whether it displaces a measurement by a quarter of its standard deviation.
bool SystematicLearner::matters(std::size_t error, const SystematicErrors::Vector& errors) const {
  constexpr double quarter = 0.25;
  constexpr std::size_t errors_of_odometry = 3;
  if (has_closed_ && error < errors_of_odometry) return true;
  const double rows = error < errors_of_odometry ? motions_ : sightings_;
  const auto i = static_cast<Eigen::Index>(error);
  return errors(i) * errors(i) * in_rows_(i) >= quarter * quarter * rows;
}

/// Whether the first stretches and the others, since errors were last taken out, have the same errors: by how much χ² would be lower
/// if each had their own.
bool SystematicLearner::is_constant(const Chosen& chosen) const {
  constexpr double most = 16.0;  // four standard deviations
  const auto lowers = [&](const StretchSums& until, const StretchSums& since) {
    return fit(until.information - since.information, until.gradient - since.gradient, chosen).lowers;
  };
  return lowers(early_, base_) + lowers(all_, early_) - lowers(all_, base_) < most * scatter();
}

std::optional<CertainErrors> SystematicLearner::certain() {
  if (stretches_ < ask_at_) return std::nullopt;
  std::optional<CertainErrors> found = best(all_, new_one);
  if (!found && has_closed_) found = certain_by_closings();
  if (found) ask_at_ = 2 * stretches_;
  return found;
}

std::optional<CertainErrors> SystematicLearner::certain_after_closing() {
  std::optional<CertainErrors> found = certain_by_closings();
  if (found) ask_at_ = std::max(ask_at_, 2 * stretches_);
  return found;
}

std::optional<CertainErrors> SystematicLearner::certain_by_closings() const {
  std::optional<CertainErrors> found =
      best({all_.information + closings_.information, all_.gradient + closings_.gradient}, with_closings_one);
  if (found && !stretches_have(linear(found->errors))) found.reset();
  return found;
}

/// Two standard deviations of a new error; of what is left of one that was found before, that they do not contradict it by as much.
bool SystematicLearner::stretches_have(const SystematicErrors::Vector& errors) const {
  constexpr double two_sigmas = 4.0;  // of χ²
  const SystematicErrors::Vector known = taken_out_.vector();
  const bool is_any_new = (errors.array() != 0.0 && known.array() == 0.0).any();
  const double lowers = 2.0 * errors.dot(all_.gradient) - errors.dot(all_.information * errors);
  return lowers >= (is_any_new ? two_sigmas : -two_sigmas) * scatter();
}

std::optional<CertainErrors> SystematicLearner::best(const StretchSums& sums, double least_new) const {
  const double unit = scatter();
  const SystematicErrors::Vector known = taken_out_.vector();
  Chosen chosen{};
  Fit best;
  for (std::size_t count = 0; count < errors_count; ++count) {
    std::size_t next = errors_count;
    double most = 0.0;
    for (std::size_t i = 0; i < errors_count; ++i) {
      if (chosen[i] || given_up_[i]) continue;
      Chosen more = chosen;
      more[i] = true;
      const Fit with = fit(sums.information, sums.gradient, more);
      if (!matters(i, with.errors)) continue;
      const double lowers = with.lowers - best.lowers;
      const double least = known(static_cast<Eigen::Index>(i)) == 0.0 ? least_new : known_one;
      if (lowers > unit * least && lowers > most) {
        next = i;
        most = lowers;
      }
    }
    if (next == errors_count) break;
    chosen[next] = true;
    best = fit(sums.information, sums.gradient, chosen);
  }
  if (!(best.lowers > 0.0) || !is_constant(chosen)) return std::nullopt;
  return CertainErrors{of_linear(best.errors), 0.5 * best.lowers / unit};
}

std::optional<CertainErrors> SystematicLearner::contradicted() const {
  constexpr int least_stretches = 4;
  if (since_ < least_stretches) return std::nullopt;
  const SystematicErrors::Matrix information = all_.information - early_.information;
  const SystematicErrors::Vector gradient = all_.gradient - early_.gradient;
  const SystematicErrors::Vector known = linear(taken_out_);
  SystematicErrors::Vector back = SystematicErrors::Vector::Zero();
  double lowers = 0.0;
  for (Eigen::Index i = 0; i < known.size(); ++i) {
    const double without = -2.0 * known(i) * gradient(i) - known(i) * known(i) * information(i, i);
    if (without < new_one) continue;
    back(i) = -taken_out_.vector()(i);
    lowers += without;
  }
  if (back.isZero(0.0)) return std::nullopt;
  SystematicErrors errors(back);
  errors.too_long = 1.0 / (1.0 - back(0)) - 1.0;
  return CertainErrors{errors, 0.5 * lowers};
}

void SystematicLearner::give_up(const SystematicErrors& errors) {
  take_out(errors);
  SystematicErrors::Vector left = taken_out_.vector();
  for (Eigen::Index i = 0; i < left.size(); ++i) {
    if (errors.vector()(i) == 0.0) continue;
    left(i) = 0.0;  // to the last bit
    given_up_[static_cast<std::size_t>(i)] = true;
  }
  taken_out_ = SystematicErrors(left);
}

void SystematicLearner::take_out(const SystematicErrors& errors) {
  const SystematicErrors::Vector e = linear(errors);
  of_stretches_ += e.dot(all_.information * e) - 2.0 * e.dot(all_.gradient);
  all_.gradient -= all_.information * e;
  closings_.gradient -= closings_.information * e;
  base_ = early_ = pending_ = all_;
  since_ = 0;
  taken_out_ = both(taken_out_, errors);
}

}  // namespace helixnav::supervisor
