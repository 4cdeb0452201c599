// SPDX-License-Identifier: BSD-3-Clause
#include "navigator_options.hpp"

#include <algorithm>

#include "helixnav/supervisor/lengths.hpp"
#include "option_names.hpp"

namespace helixnav::mrpt_adapter {

namespace {

/// Of one version ago: the reach of the sensor over 30 m, now taken from the observations where it is 1.
void apply_old_scale(double search_scale, supervisor::NavigatorOptions& options) {
  if (search_scale == 1.0) return;
  options = supervisor::fit_lengths(options, {0.0, search_scale * supervisor::reference_reach_m});
  options.fit_lengths = false;
}

void set_search(const MapBuilderOptions& options, supervisor::SearchOptions& search) {
  search.enabled = options.search_enabled;
  search.seed = options.search_seed;
  search.relocalizer.threads = static_cast<unsigned>(options.search_threads);
  constexpr double among_reflectors = 0.5;  // hardly anything else shines
  if (options.detector == "reflectors") search.extraneous_per_scan = among_reflectors;
  if (options.search_extraneous_per_scan > 0.0) {
    search.extraneous_per_scan = options.search_extraneous_per_scan;
    search.relocalizer.sensor.extraneous_per_scan = options.search_extraneous_per_scan;
  }
  if (options.search_view_area > 0.0) {
    search.rivals.extraneous_per_m2 = search.extraneous_per_scan / options.search_view_area;
  }
}

}  // namespace

supervisor::NavigatorOptions navigator_options(const MapBuilderOptions& options) {
  supervisor::NavigatorOptions result;
  result.filter.retraction = retraction_of(options.retraction);
  result.filter.cell_side_m = options.cell_side;
  result.filter.hysteresis_m = options.hysteresis;
  result.method = method_of(options.association);
  result.extraneous_per_scan = options.extraneous_per_scan;
  result.gates.match_probability = options.data_assoc_IC_chi2_thres;
  // The gate for new landmarks stays outside that for pairs, as many times as it is by default.
  const association::Gates defaults;
  const double share = (1.0 - defaults.new_probability) / (1.0 - defaults.match_probability);
  const double widest = 1.0 - share * (1.0 - options.data_assoc_IC_chi2_thres);
  result.gates.new_probability = std::max(defaults.new_probability, widest);
  result.fix_probability = options.gps_probability;
  result.search.old_after_m = options.search_old_after;
  apply_old_scale(options.search_scale, result);
  set_search(options, result.search);
  return result;
}

fastslam::Options fastslam_options(const MapBuilderOptions& options) {
  fastslam::Options result;
  result.particles = options.fastslam_particles;
  result.proposal = options.fastslam_version == 1 ? fastslam::Proposal::motion : fastslam::Proposal::motion_and_scan;
  result.threads = static_cast<unsigned>(options.fastslam_threads);
  result.association = fastslam_association_of(options.fastslam_association);
  result.weigh_unseen = options.fastslam_weigh_unseen;
  result.detection_probability = options.fastslam_detection_probability;
  result.new_density = options.fastslam_new_density;
  result.clutter_density = options.fastslam_clutter_density;
  return result;
}

}  // namespace helixnav::mrpt_adapter
