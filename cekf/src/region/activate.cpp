// SPDX-License-Identifier: BSD-3-Clause
#include "helixnav/cekf/compressed_ekf.hpp"
#include "matrices/make_room.hpp"

namespace helixnav::cekf {

void CompressedEkf::activate(core::LandmarkId id) {
  const Place place = place_of(id, "activate");
  if (place.where == Whereabouts::active) return;
  const int slot = place.index;
  Eigen::MatrixXd start_columns = phase_start_columns({slot});
  const Eigen::MatrixXd e = basis_rows({slot});  // 2 × q
  const Eigen::MatrixXd Me = active_.M.view().selfadjointView<Eigen::Lower>() * e.transpose();
  const Eigen::Matrix2d own = phases_.back().own_covariance_m2.middleRows<2>(2 * slot) + e * Me;
  const Eigen::Vector2d mean_m = passive_mean(slot);

  const int n = active_.dimension();
  const int q = active_.weights();
  const Eigen::MatrixXd cross = active_.A.view().transpose() * e.transpose();
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(q + 2 * weights_per_anchor());
  theta.head(q) = active_.theta;
  const std::vector<int> own_slot = {slot};
  const std::vector<Eigen::Vector2d> own_offset = {phases_.back().mean_m.segment<2>(2 * slot) - phases_.back().start_m};
  make_room_for_landmark(static_cast<int>(theta.size()));
  make_room(active_.left_passive, 1);
  make_room(active_.late_anchors, 1);
  make_room(phases_.back().late_anchors, 1);
  phases_.back().basis.make_room(phases_.back().basis.rows(), theta.size());

  // Nothing below allocates or throws.
  active_.P.resize(n + 2, n + 2);
  auto P = active_.P.view();
  P.block(0, n, n, 2) = cross;
  P.block(n, 0, 2, n) = P.block(0, n, n, 2).transpose();
  P.block<2, 2>(n, n) = 0.5 * (own + own.transpose());
  active_.A.resize(q, n + 2);
  active_.A.view().rightCols<2>() = Me;

  set_place(id, {Whereabouts::active, active_count()});
  active_.ids.push_back(id);
  active_.slots.push_back(slot);
  active_.points_m.push_back(mean_m);
  active_.left_passive.push_back(id);
  active_.late_anchors.push_back(slot);
  phases_.back().late_anchors.push_back(slot);
  append_late_columns(phases_.back(), own_slot, start_columns);
  active_.theta.swap(theta);
  append_weights_for(own_offset, false, active_);
}

/// For one more active landmark, and `weights` weights in all.
void CompressedEkf::make_room_for_landmark(int weights) {
  const int n = active_.dimension() + 2;
  active_.P.make_room(n, n);
  active_.A.make_room(weights, n);
  active_.M.make_room(weights, weights);
  make_room(active_.ids, 1);
  make_room(active_.slots, 1);
  make_room(active_.points_m, 1);
}

/// Allocates only where an activation will.
CompressedEkf::BeforeActivations CompressedEkf::before_activations(bool all_active) const {
  BeforeActivations before;
  before.active = active_count();
  if (!all_active) before.theta = active_.theta;
  return before;
}

/// Undoes the activations since then, and a landmark that was begun and not named: both only append.
void CompressedEkf::undo_activations(BeforeActivations& before) {
  Phase& phase = phases_.back();
  const int undone = active_count() - before.active;
  for (int i = before.active; i < active_count(); ++i) {
    const std::size_t k = static_cast<std::size_t>(i);
    set_place(active_.ids[k], {Whereabouts::passive, active_.slots[k]});
  }
  const std::size_t n = static_cast<std::size_t>(before.active);
  const std::size_t late = phase.late_anchors.size() - static_cast<std::size_t>(undone);
  active_.ids.resize(n);
  active_.slots.resize(n);
  active_.points_m.resize(n);
  active_.left_passive.resize(active_.left_passive.size() - static_cast<std::size_t>(undone));
  active_.late_anchors.resize(late);
  phase.late_anchors.resize(late);
  if (undone > 0) active_.theta.swap(before.theta);
  const int q = active_.weights();
  active_.P.resize(active_.dimension(), active_.dimension());
  active_.A.resize(q, active_.dimension());
  active_.M.resize(q, q);
  phase.basis.resize(phase.basis.rows(), q);
}

/// New anchors, given how all slots were correlated with them when the phase began.
void CompressedEkf::append_columns(Phase& phase, const Eigen::Ref<const Eigen::MatrixXd>& start_columns) const {
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

/// Weights of the newest landmarks, which stood at these places seen from the vehicle when the phase began, behind those of
/// the vehicle where it has none yet. theta has its new size already.
void CompressedEkf::append_weights_for(const std::vector<Eigen::Vector2d>& offsets_m, bool with_vehicle,
                                       ActivePart& part) const {
  const int w = weights_per_anchor();
  const int n = part.dimension();
  int column = n - 2 * static_cast<int>(offsets_m.size());
  const int first_column = with_vehicle ? 0 : column;
  int q = static_cast<int>(part.A.rows());
  const int q_after = q + w * (n - first_column);
  part.A.resize(q_after, n);
  part.M.resize(q_after, q_after);
  auto A = part.A.view();
  for (int own = first_column; own < n; ++own, q += w) A(q, own) = 1.0;
  for (const Eigen::Vector2d& offset_m : offsets_m) {
    A(0, column) += 1.0;
    A(w, column + 1) += 1.0;
    A(2 * w, column) -= offset_m.y();
    A(2 * w, column + 1) += offset_m.x();
    column += 2;
  }
}

/// Anchors of landmarks become relative to the vehicle; `vehicle` gives the columns of its x, y and heading.
template <class Vehicle>
void CompressedEkf::refer_to_vehicle(const Phase& phase, const std::vector<int>& slots, const Vehicle& vehicle,
                                     Eigen::Ref<Eigen::MatrixXd> columns) {
  Eigen::Index k = 0;
  for (const int slot : slots) {
    const Eigen::Vector2d offset_m = phase.mean_m.segment<2>(2 * slot) - phase.start_m;
    columns.col(k) -= vehicle(0);
    columns.col(k) += offset_m.y() * vehicle(2);
    columns.col(k + 1) -= vehicle(1);
    columns.col(k + 1) -= offset_m.x() * vehicle(2);
    k += 2;
  }
}

void CompressedEkf::append_first_columns(Phase& phase, const std::vector<int>& slots,
                                         Eigen::Ref<Eigen::MatrixXd> anchors) const {
  refer_to_vehicle(
      phase, slots, [&](int i) { return anchors.col(i); }, anchors.rightCols(anchors.cols() - 3));
  append_columns(phase, anchors);
}

void CompressedEkf::append_late_columns(Phase& phase, const std::vector<int>& slots,
                                        Eigen::MatrixXd& start_columns) const {
  const int w = weights_per_anchor();
  const auto basis = phase.basis.view();
  refer_to_vehicle(
      phase, slots, [&](int i) { return basis.col(w * i); }, start_columns);
  append_columns(phase, start_columns);
}

}  // namespace helixnav::cekf
