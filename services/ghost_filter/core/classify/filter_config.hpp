// Settings of the mirror method; the defaults are what config/services/ghost_filter.toml ships.
#pragma once

#include "services/ghost_filter/core/classify/config.hpp"
#include "services/ghost_filter/core/reflector_map/config.hpp"

namespace boresight::ghosts {

struct MirrorConfig {
  MapConfig map;
  ClassConfig classes;
  double tracks_max_age_s = 0.5;
};

}  // namespace boresight::ghosts
