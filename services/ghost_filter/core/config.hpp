// Settings of the ghost filter; the defaults are what config/services/ghost_filter.toml ships.
#pragma once

#include <cstdint>

#include "services/ghost_filter/core/published/config.hpp"

namespace boresight::ghosts {

enum class MethodName : std::uint8_t {
  kPublished,  ///< Report B: the baseline
};

struct Config {
  MethodName method = MethodName::kPublished;
  published::Config published;
};

}  // namespace boresight::ghosts
