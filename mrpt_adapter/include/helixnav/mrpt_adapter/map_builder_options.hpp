// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>

#include <mrpt/config/CLoadableOptions.h>

#include "helixnav/core/angle.hpp"

namespace helixnav::mrpt_adapter {

/// Everything that a configuration file may set for MapBuilder. Members are in metres and radians; keys that end in
/// `_deg` are in degrees in files. Keys of MRPT's kf-slam keep their name and meaning ([RangeBearingKFSLAM] may be
/// loaded as it is), the others are ours; keys that are not listed here are left to other readers of the section.
/// Loading throws core::InputError, naming section, key, value and range, with the options as they were.
/// Test: mrpt_adapter/options_test.cpp.
class MapBuilderOptions : public mrpt::config::CLoadableOptions {
 public:
  void loadFromConfigFile(const mrpt::config::CConfigFileBase& source, const std::string& section) override;
  void saveToConfigFile(mrpt::config::CConfigFileBase& target, const std::string& section) const override;

  // Keys of kf-slam.
  double stdXY_no_odo = 0.10;                         ///< of the motion between frames where no action states more
  double stdPhi_no_odo_rad = 4.0 * core::pi / 180.0;  ///< key stdPhi_no_odo_deg
  bool force_ignore_odometry = false;                 ///< treat every motion as unknown
  double std_sensor_range = 0.0;             ///< of bearing-range measurements without covariance; 0: as they state
  double std_sensor_yaw_rad = 0.0;           ///< key std_sensor_yaw_deg; 0: as they state
  double quantiles_3D_representation = 3.0;  ///< size of ellipses in pictures, in standard deviations
  bool create_simplemap = true;              ///< keep all sensory frames for getCurrentlyBuiltMap
  double data_assoc_IC_chi2_thres = 0.999;   ///< gate of a pair, as the probability that a right one is inside

  // Association.
  std::string association = "likelihood-ratio";  ///< a method's name as in association::name
  double extraneous_per_scan = 1.0;              ///< expected observations of no mapped landmark in a scan
  bool use_landmark_ids = true;                  ///< landmarkID of bearing-range measurements names the landmark

  // The sensor.
  double max_sensor_range = 0.0;   ///< a landmark nearer is expected to be seen; 0: as the observation states
  std::string detector = "trees";  ///< of landmarks in 2D range scans: trees, reflectors, none
  // Of what a detector finds; 0: as measured for it, see logs::AcfrSettings and logs::car_park_settings.
  double std_detector_range = 0.0;
  double std_detector_yaw_rad = 0.0;
  double detector_view_range = 0.0;  ///< instead of max_sensor_range

  // CObservationOdometry, which states no uncertainty: MRPT's Gaussian motion model.
  double odo_a1 = 0.01;                                 ///< [m/m]
  double odo_a2 = 0.001 * 180.0 / core::pi;             ///< [m/rad]
  double odo_a3 = core::pi / 180.0;                     ///< [rad/m]
  double odo_a4 = 0.05;                                 ///< [rad/rad]
  double odo_min_std_xy = 0.01;                         ///< of each increment
  double odo_min_std_phi_rad = 0.2 * core::pi / 180.0;  ///< likewise

  // CObservationGPS. The map frame is then east, north of the reference: give MapBuilder::initialize the start there.
  bool gps_use = false;
  double gps_std_xy = 0.5;
  double gps_probability = 0.999;  ///< χ² gate of a fix
  double gps_latitude_deg = 0.0;   ///< reference; both 0: the first fix
  double gps_longitude_deg = 0.0;
  double gps_altitude = 0.0;

  std::string filter =
      "compressed-ekf";  ///< or fastslam, with the keys that begin like this and no others of filter and search
  // As in `helixnav replay --filter fastslam` (docs/fastslam.md).
  std::uint64_t fastslam_particles = 200;
  std::uint64_t fastslam_version = 2;  ///< 1: poses drawn from odometry; 2: corrected by the landmarks matched
  std::uint64_t fastslam_seed = 1;
  std::uint64_t fastslam_threads = 1;                     ///< results do not depend on it
  std::string fastslam_association = "likelihood-ratio";  ///< where landmarks have no landmarkID
  bool fastslam_weigh_unseen = true;
  double fastslam_detection_probability = 0.9;
  double fastslam_new_density = 0.01;
  double fastslam_clutter_density = 0.01;

  // The compressed EKF and the search for old ground.
  std::string retraction = "right-invariant";  ///< or standard: as kf-slam corrects
  // Lengths that are left at their defaults follow the reach that the first observation states (supervisor/lengths.hpp).
  double cell_side = 20.0;
  double hysteresis = 20.0;
  bool search_enabled = true;
  std::uint64_t search_seed = 1;
  double search_old_after = 60.0;
  std::uint64_t search_threads = 2;         ///< results do not depend on it
  double search_scale = 1.0;                ///< obsolete: reach over 30 m, instead of what observations state
  double search_extraneous_per_scan = 0.0;  ///< observations of no old landmark in a scan; 0: 2.5, of reflectors 0.5
  double search_view_area = 0.0;            ///< [m²] where these are seen; 0: by the reach

  bool enable_profiler = false;  ///< of MapBuilder::getProfiler
};

}  // namespace helixnav::mrpt_adapter
