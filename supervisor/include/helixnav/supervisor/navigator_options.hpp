// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "helixnav/association/associate.hpp"
#include "helixnav/association/landmark_life.hpp"
#include "helixnav/cekf/filter_options.hpp"
#include "helixnav/supervisor/delayed_landmarks.hpp"
#include "helixnav/supervisor/moving_options.hpp"
#include "helixnav/supervisor/noise_options.hpp"
#include "helixnav/supervisor/search_options.hpp"
#include "helixnav/supervisor/slip_options.hpp"

namespace helixnav::supervisor {

/// How a map is kept that is too large for one filter.
struct MapOptions {
  int whole = 1000;  ///< landmarks up to which the filter holds all of them; …
  int window = 400;  ///< … of more those nearest the vehicle, so many or as its drift asks for, …
  int most = 1000;   ///< … but not more than this
};

/// How far identities are trusted.
struct NameOptions {
  double wrong = 1e-3;  ///< share of sightings that are of another landmark than their name says; 0: none can be
};

/// Options of Navigator and NamedNavigator; the latter reads filter, delayed, names, slip, map and fix_probability only. Every length here is
/// for a sensor with a reach of reference_reach_m; the navigator scales it to the sensor of the first scan (lengths.hpp).
struct NavigatorOptions {
  bool fit_lengths = true;  ///< false: they are used as they stand
  cekf::FilterOptions filter;
  association::Method method = association::Method::likelihood_ratio;
  association::Options association;
  association::Gates gates;
  association::LifeOptions life;
  SearchOptions search;
  SlipOptions slip;
  NoiseOptions noise;
  MovingOptions moving;
  MapOptions map;
  NameOptions names;
  DelayedOptions delayed;            ///< of landmarks known by name and seen as a range or a bearing only
  double fix_probability = 0.999;    ///< χ² gate of an absolute fix
  double extraneous_per_scan = 1.0;  ///< observations of no mapped landmark: clutter and new ones together
  double candidate_sigmas = 4.0;     ///< how far the search for candidates reaches
  double view_margin_m = 2.0;        ///< margin inside the field of view within which a landmark is expected to be seen
};

}  // namespace helixnav::supervisor
