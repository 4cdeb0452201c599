// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <optional>

#include "helixnav/supervisor/systematic_errors.hpp"
#include "systematic/stretch_evidence.hpp"

namespace helixnav::supervisor {

/// What stretches say together.
struct StretchSums {
  SystematicErrors::Matrix information = SystematicErrors::Matrix::Zero();
  SystematicErrors::Vector gradient = SystematicErrors::Vector::Zero();
};

/// Errors that are certain, the others at zero.
struct CertainErrors {
  SystematicErrors errors;
  double nats = 0.0;  ///< by which they explain the stretches better than none
};

/// Sums up what the stretches of a drive say of its systematic errors, and decides which are certain: the one that lowers χ²
/// most, then the one that lowers it most beside it, as long as each lowers it by 36 (six standard deviations). χ² is divided
/// by what the stretches scatter more than their covariances say. Errors that displace a single measurement by less than a quarter of its standard
/// deviation are left to the noise, and so is what the first stretches contradict: it began on the way. Those of odometry add up over a
/// loop, however small they are, and matter once one has been closed. O(1) memory and time.
/// Test: supervisor/systematic/systematic_learner_test.cpp.
class SystematicLearner {
 public:
  void add(const StretchEvidence& stretch);
  /// What a closing says beyond its stretches: from here on it counts with them.
  void add_closing(const StretchEvidence& closing);

  /// Errors that what is measured still has. Asked anew only after twice as many stretches: what is found has to be taken out of
  /// the whole drive.
  std::optional<CertainErrors> certain();
  /// Likewise right after a closing. Odometry may also not fit it because its noise is larger than assumed: five standard deviations in
  /// all, and the stretches alone have the error by two, or, if it was found before, do not contradict it by two.
  std::optional<CertainErrors> certain_after_closing();

  /// What was taken out and is not there any more: errors that, taken out as well, put it back, because the later half and more of the
  /// stretches since is explained better without by six standard deviations. A steering offset that changes slowly looks constant at
  /// first. Given up, it is not taken out again.
  std::optional<CertainErrors> contradicted() const;
  void give_up(const SystematicErrors& errors);

  /// From here on these are taken out of what is measured, and have been taken out of what was.
  void take_out(const SystematicErrors& errors);
  const SystematicErrors& taken_out() const { return taken_out_; }

  int stretches() const { return stretches_; }

 private:
  double scatter() const;
  bool is_constant(const std::array<bool, SystematicErrors::count>& chosen) const;
  bool matters(std::size_t error, const SystematicErrors::Vector& errors) const;
  bool stretches_have(const SystematicErrors::Vector& errors) const;
  std::optional<CertainErrors> best(const StretchSums& sums, double least_new) const;
  std::optional<CertainErrors> certain_by_closings() const;

  StretchSums all_;
  StretchSums closings_;
  StretchSums base_;     ///< of `all_`, when errors were last taken out
  StretchSums early_;    ///< of the first quarter or half of the stretches since
  StretchSums pending_;  ///< will be that when they have doubled
  int since_ = 0;        ///< stretches since
  SystematicErrors::Vector in_rows_ = SystematicErrors::Vector::Zero();
  double motions_ = 0.0, sightings_ = 0.0;
  double of_stretches_ = 0.0;  ///< sum of what each stretch's own errors take from its χ²
  int rank_ = 0;               ///< degrees of freedom of that
  int stretches_ = 0;
  int ask_at_ = 4;
  bool has_closed_ = false;
  SystematicErrors taken_out_;
  std::array<bool, SystematicErrors::count> given_up_{};
};

}  // namespace helixnav::supervisor
