// Two reflectors that are one.
#pragma once

#include "services/ghost_filter/core/reflector_map/config.hpp"
#include "services/ghost_filter/core/reflector_map/reflector.hpp"

namespace boresight::ghosts {

/// Whether `shorter` runs along `longer`, beside it or on from one of its ends, as well as is known.
[[nodiscard]] bool runs_along(const Reflector& longer, const Reflector& shorter, const MapConfig& config);

/// Makes `shorter` a part of `longer`. False if they would be too long together; `longer` is unchanged then.
[[nodiscard]] bool join(Reflector& longer, const Reflector& shorter);

}  // namespace boresight::ghosts
