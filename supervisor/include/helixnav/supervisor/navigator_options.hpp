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

/// How a map too large for one filter is kept.
struct MapOptions {
  int whole = 1000;  ///< up to this many landmarks the filter holds all of them; …
  int window = 400;  ///< … beyond that, those nearest the vehicle, this many or as its drift requires, …
  int most = 1000;   ///< … but never more than this
};

/// How far identities are trusted.
struct NameOptions {
  double wrong = 1e-3;  ///< fraction of sightings that bear another landmark's name; 0: none can
};

/// Options of Navigator and NamedNavigator; the latter reads only filter, delayed, names, slip, map and
/// fix_probability. Every length here is for a sensor with a reach of reference_reach_m; the navigator scales it to the
/// sensor of the first scan (lengths.hpp).
struct NavigatorOptions {
  bool fit_lengths = true;  ///< false: lengths are used as given
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
  DelayedOptions delayed;            ///< for landmarks known by name and seen only as a range or a bearing
  double fix_probability = 0.999;    ///< χ² gate for an absolute fix
  double extraneous_per_scan = 1.0;  ///< observations not of a mapped landmark: clutter and new ones together
  double candidate_sigmas = 4.0;     ///< how far the search for candidates reaches
  double view_margin_m = 2.0;        ///< margin inside the field of view within which a landmark is expected to be seen
};

}  // namespace helixnav::supervisor
