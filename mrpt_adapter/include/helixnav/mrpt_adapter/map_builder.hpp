// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <mrpt/math/TPoint2D.h>
#include <mrpt/slam/CMetricMapBuilder.h>

#include "helixnav/mrpt_adapter/data_association.hpp"
#include "helixnav/mrpt_adapter/map_builder_options.hpp"
#include "helixnav/mrpt_adapter/mrpt_version.hpp"

namespace mrpt::opengl {
class CSetOfObjects;
}
namespace mrpt::poses {
class CPosePDFGaussian;
}
namespace mrpt::system {
class CTimeLogger;
}

namespace helixnav::mrpt_adapter {

/// HelixNav's Navigator as a map builder of MRPT: landmark SLAM in the plane with a compressed EKF, unknown association,
/// and loops closed by a particle filter; or FastSLAM, where options.filter selects it. It takes the place of
/// CRangeBearingKFSLAM2D or another CMetricMapBuilder.
///
/// What it reads. Motion: the best CActionRobotMovement2D of the actions (else CActionRobotMovement3D, its planar part),
/// else the increments of CObservationOdometry among the observations, else unknown motion of options.stdXY_no_odo.
/// Landmarks: CObservationBearingRange (sensor pose, covariance of each measurement, field of view up to the full circle)
/// and what options.detector finds in CObservation2DRangeScan. Position: CObservationGPS when options.gps_use. Other
/// observations are skipped. A sensory frame is processed in the order of its time stamps; each landmark observation is
/// one step of the navigator.
///
/// Names. When the first measurements carry a landmarkID (and options.use_landmark_ids), association is known from then
/// on and measurements without one are skipped; otherwise it is unknown and later IDs are ignored.
///
/// Frames: the map frame is that of the pose given to `initialize`, (0, 0, 0°) without. SI units, headings in radians.
/// All calls lock critZoneChangingMap, so that one thread may read while another feeds; two builders share nothing.
/// Errors: core::InputError for what cannot be used at all (options, a tilted sensor, a movement that is not finite, no
/// noise figure), with pose and map as they were; single measurements that are not finite or not positive are dropped with a
/// warning. Cost: that of Navigator::observe; converting takes about 1 µs per measurement. Tests: tests/mrpt_adapter.
class MapBuilder : public mrpt::slam::CMetricMapBuilder {
 public:
  using LandmarkNumber = std::int64_t;  ///< as mrpt::maps::CLandmark::TLandmarkID

  explicit MapBuilder(const MapBuilderOptions& options = {});
  ~MapBuilder() override;
  MapBuilder(const MapBuilder&) = delete;
  MapBuilder& operator=(const MapBuilder&) = delete;

  const MapBuilderOptions& getOptions() const;

  // What CMetricMapBuilder requires.

  /// Forgets everything and starts at x0, at the origin without. A past map comes from a run folder (below): a CSimpleMap has
  /// no covariance between its frames, so InputError unless it is empty.
  void initialize(const mrpt::maps::CSimpleMap& initialMap = mrpt::maps::CSimpleMap(),
                  const mrpt::poses::CPosePDF* x0 = nullptr) override;

  /// CPose3DPDFGaussian while mapping; CPose3DPDFParticles, up to some 600 of equal weight, while a particle filter
  /// looks for the vehicle on old ground, and those of FastSLAM with their weights. The pose of the map that continues
  /// meanwhile is getCurrentState's. Either is as of the last landmark observation or fix: motion since then reaches
  /// the filter with the next.
  mrpt::poses::CPose3DPDF::Ptr getCurrentPoseEstimation() const override;

  /// PreconditionError while map updating is switched off: this filter does not localise without mapping.
  void processActionObservation(mrpt::obs::CActionCollection& action, mrpt::obs::CSensoryFrame& observations) override;

  /// The frames with landmarks, as pose (known then) and observations, if options.create_simplemap.
  void getCurrentlyBuiltMap(mrpt::maps::CSimpleMap& out_map) const override;
  unsigned int getCurrentlyBuiltMapSize() override;

  /// One CLandmarksMap with the mature landmarks, made anew by the first call after a step; what an earlier call
  /// returned changes with it.
  MetricMapResult getCurrentlyBuiltMetricMap() const override;

  /// Map, path and pose from above, in the format given by the ending of the file's name (png, jpg, bmp; else .png is
  /// appended). formatEMF_BMP is ignored: MRPT writes no EMF here. InputError when the file cannot be written.
  void saveCurrentEstimationToImage(const std::string& file, bool formatEMF_BMP = true) override;

  // Yesterday's map (docs/yesterdays_map.md). With FastSLAM all of these are PreconditionErrors.

  /// Forgets everything and continues in the map of a run folder (map.bin in it, as helixnav, helixnav-slam and
  /// saveMapToFolder write it), from x0 on that map. Without x0 the vehicle may be anywhere: it maps on its own, poses
  /// are in the frame of where it began, and the place is sought by landmarks until isPlaceKnown(); from then on there
  /// is one map, in the frame of the earlier one. Landmarks of the map have no names, so landmarkIDs are ignored.
  /// InputError where the folder has no map, or one with too few mature landmarks; everything is then as before.
  /// Test: mrpt_adapter/earlier_map_test.cpp.
  void initializeFromRun(const std::string& runFolder, const mrpt::poses::CPosePDF* x0 = nullptr);

  /// A run folder, or the map.bin in it, as initializeFromRun() does from anywhere; any other file as MRPT does, which loads a
  /// CSimpleMap (InputError unless it is empty, or if there is none). Hides MRPT's, which is not virtual: call it on a MapBuilder.
  void loadCurrentMapFromFile(const std::string& fileName);

  /// The vehicle is at x0 on the map: on the earlier one, as long as its place on that is sought (what was mapped meanwhile is
  /// dropped), else on the present one. The path begins anew; landmarks keep their numbers and correlations. O(N²).
  void setInitialPose(const mrpt::poses::CPosePDF& x0);

  /// The vehicle was carried, or is lost: its place on all that is mapped is sought from here on, without a prior, as
  /// supervisor::Navigator::lose describes. PreconditionError where landmarks are known by landmarkID.
  void relocalize();

  /// False from loading a map without a pose, or from relocalize(), until the place is found.
  bool isPlaceKnown() const;

  /// Writes map.csv and map.bin into a folder, which is created: what initializeFromRun() continues in. Where the place
  /// is still sought it is the map since then. InputError where it cannot be written, or has more than
  /// runs::most_joint_landmarks landmarks and its drive was not kept.
  void saveMapToFolder(const std::string& folder) const;

  // Beyond.

  /// One observation of a stream without actions, as in observation-only rawlogs.
  void processObservation(const mrpt::obs::CObservation::Ptr& observation);

  /// Pose and landmarks of the filter, tentative ones too, in order of number. out_fullState: (x, y, heading), then
  /// (x, y) of each landmark. out_fullCovariance: dense, in the order of out_fullState, only on request: O(landmarks²).
  /// In addition, per landmark: its number (the landmarkID where association is known).
  void getCurrentState(mrpt::poses::CPosePDFGaussian& out_robotPose,
                       std::vector<mrpt::math::TPoint2D>& out_landmarksPositions,
                       std::map<unsigned int, LandmarkNumber>& out_landmarkIDs,
                       mrpt::math::CVectorDouble& out_fullState,
                       mrpt::math::CMatrixDouble* out_fullCovariance = nullptr) const;

  /// Of the last step.
  DataAssociation getLastDataAssociation() const;

  /// Landmarks with ellipses of options.quantiles_3D_representation σ, path, vehicle, particles, and the mode in words.
  void getAs3DObject(std::shared_ptr<mrpt::opengl::CSetOfObjects>& outObj) const;

  /// Sections: complete_step, and inside it convert and navigate; refresh_map, get_as_3d_object.
  const mrpt::system::CTimeLogger& getProfiler() const;

 private:
  friend class RunAccess;
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace helixnav::mrpt_adapter
