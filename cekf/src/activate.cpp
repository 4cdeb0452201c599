// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/cekf/compressed_ekf.hpp"

namespace helixnav::cekf {

void CompressedEkf::activate(core::LandmarkId id) {
  const Place place = place_of(id, "activate");
  if (place.where == Whereabouts::active) return;
  const int slot = place.index;
  const Eigen::MatrixXd start_columns = phase_start_columns({slot});
  const Eigen::MatrixXd e = basis_rows({slot});  // 2 × q
  const Eigen::MatrixXd Me = active_.M.view().selfadjointView<Eigen::Lower>() * e.transpose();
  const Eigen::Matrix2d own = phases_.back().own_covariance_m2.middleRows<2>(2 * slot) + e * Me;
  const Eigen::Vector2d mean_m = passive_mean(slot);

  const int n = active_.dimension();
  active_.P.resize(n + 2, n + 2);
  auto P = active_.P.view();
  P.block(0, n, n, 2).noalias() = active_.A.view().transpose() * e.transpose();
  P.block(n, 0, 2, n) = P.block(0, n, n, 2).transpose();
  P.block<2, 2>(n, n) = 0.5 * (own + own.transpose());
  active_.A.resize(active_.weights(), n + 2);
  active_.A.view().rightCols<2>() = Me;

  places_[static_cast<std::size_t>(id)] = {Whereabouts::active, active_count()};
  active_.ids.push_back(id);
  active_.slots.push_back(slot);
  active_.points_m.push_back(mean_m);
  active_.left_passive.push_back(id);
  active_.late_anchors.push_back(slot);
  phases_.back().late_anchors.push_back(slot);
  append_columns(phases_.back(), start_columns);
  append_weights_for(n);
}

/// Takes back the activations since `active_before` landmarks were active: an activation only appends.
void CompressedEkf::undo_activations(int active_before) {
  Phase& phase = phases_.back();
  const int undone = active_count() - active_before;
  if (undone == 0) return;
  for (int i = active_before; i < active_count(); ++i) {
    const std::size_t k = static_cast<std::size_t>(i);
    places_[static_cast<std::size_t>(active_.ids[k])] = {Whereabouts::passive, active_.slots[k]};
  }
  const std::size_t n = static_cast<std::size_t>(active_before);
  const std::size_t late = phase.late_anchors.size() - static_cast<std::size_t>(undone);
  active_.ids.resize(n);
  active_.slots.resize(n);
  active_.points_m.resize(n);
  active_.left_passive.resize(active_.left_passive.size() - static_cast<std::size_t>(undone));
  active_.late_anchors.resize(late);
  phase.late_anchors.resize(late);
  const int q = active_.weights() - 2 * weights_per_anchor() * undone;
  active_.P.resize(active_.dimension(), active_.dimension());
  active_.A.resize(q, active_.dimension());
  active_.M.resize(q, q);
  active_.theta.conservativeResize(q);
  phase.basis.resize(phase.basis.rows(), q);
}

/// New anchors, given how all slots were correlated with them when the phase began.
void CompressedEkf::append_columns(Phase& phase, const Eigen::MatrixXd& start_columns) const {
  const int w = weights_per_anchor();
  Eigen::Index q = phase.basis.cols();
  phase.basis.resize(phase.basis.rows(), q + w * start_columns.cols());
  auto basis = phase.basis.view();
  for (Eigen::Index k = 0; k < start_columns.cols(); ++k, q += w) {
    basis.col(q) = start_columns.col(k);
    if (w == 2) {
      basis.col(q + 1)(Eigen::seq(0, Eigen::last, 2)) = -start_columns.col(k)(Eigen::seq(1, Eigen::last, 2));
      basis.col(q + 1)(Eigen::seq(1, Eigen::last, 2)) = start_columns.col(k)(Eigen::seq(0, Eigen::last, 2));
    }
  }
}

/// Weights of anchors that are the active columns from `first_column` on: uncorrelated but for the anchor itself.
void CompressedEkf::append_weights_for(int first_column) {
  const int w = weights_per_anchor();
  const int n = active_.dimension();
  int q = active_.weights();
  const int q_after = q + w * (n - first_column);
  active_.A.resize(q_after, n);
  active_.M.resize(q_after, q_after);
  active_.theta.conservativeResizeLike(Eigen::VectorXd::Zero(q_after));
  for (int column = first_column; column < n; ++column, q += w) active_.A.view()(q, column) = 1.0;
}

}  // namespace helixnav::cekf
