// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/math/CMatrixDynamic.h>
#include <mrpt/math/CVectorDynamic.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/poses/CPosePDFGaussian.h>

#include "map_builder_impl.hpp"
#include "pose_pdf.hpp"

namespace helixnav::mrpt_adapter {
namespace {

DataAssociation::Outcome outcome_of(core::Outcome outcome) {
  switch (outcome) {
    case core::Outcome::matched:
      return DataAssociation::Outcome::matched;
    case core::Outcome::augmented:
      return DataAssociation::Outcome::inserted;
    case core::Outcome::ambiguous:
      return DataAssociation::Outcome::ambiguous;
    default:
      return DataAssociation::Outcome::rejected;
  }
}

void copy(const Eigen::MatrixXd& from, mrpt::math::CMatrixDouble& to) {
  to.resize(from.rows(), from.cols());
  for (Eigen::Index c = 0; c < from.cols(); ++c) {
    for (Eigen::Index r = 0; r < from.rows(); ++r) to(r, c) = from(r, c);
  }
}

}  // namespace

void MapBuilder::getCurrentState(mrpt::poses::CPosePDFGaussian& out_robotPose,
                                 std::vector<mrpt::math::TPoint2D>& out_landmarksPositions,
                                 std::map<unsigned int, LandmarkNumber>& out_landmarkIDs,
                                 mrpt::math::CVectorDouble& out_fullState,
                                 mrpt::math::CMatrixDouble* out_fullCovariance) const {
  const Impl::Lock lock(impl_->lock);
  const core::PoseGaussian pose = impl_->navigator->pose();
  out_robotPose = planar_pdf(pose);
  out_landmarksPositions.clear();
  out_landmarkIDs.clear();
  std::vector<core::LandmarkId> ids;
  std::vector<double> state{pose.mean.x_m, pose.mean.y_m, pose.mean.heading_rad};
  for (const core::MapLandmark& landmark : impl_->navigator->map()) {
    const Eigen::Vector2d& point_m = landmark.point.mean_m;
    out_landmarkIDs[static_cast<unsigned int>(ids.size())] = impl_->number_of(landmark.id);
    out_landmarksPositions.emplace_back(point_m.x(), point_m.y());
    state.insert(state.end(), {point_m.x(), point_m.y()});
    ids.push_back(landmark.id);
  }
  out_fullState.resize(state.size());
  for (std::size_t i = 0; i < state.size(); ++i) out_fullState[i] = state[i];
  if (out_fullCovariance != nullptr) copy(impl_->navigator->joint(ids).covariance, *out_fullCovariance);
}

DataAssociation MapBuilder::getLastDataAssociation() const {
  const Impl::Lock lock(impl_->lock);
  DataAssociation result;
  if (!impl_->last) return result;
  const core::StepReport& report = *impl_->last;
  result.step = report.step;
  result.searching = report.mode == core::Mode::searching;
  result.joint_mahalanobis2 = report.joint_nis;
  result.joint_dof = report.joint_dof;
  for (const core::AssociationReport& association : report.associations) {
    DataAssociation::Pairing pairing;
    pairing.measurement = impl_->last_measurements[static_cast<std::size_t>(association.observation)];
    pairing.outcome = outcome_of(association.outcome);
    const bool named = association.landmark != core::no_landmark;
    pairing.landmark = named ? impl_->number_of(association.landmark) : -1;
    pairing.mahalanobis2 = association.nis;
    pairing.margin_nats = association.margin_nats;
    result.pairings.push_back(pairing);
  }
  return result;
}

}  // namespace helixnav::mrpt_adapter
