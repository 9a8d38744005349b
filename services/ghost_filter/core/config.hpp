// Settings of the ghost filter; the defaults are what config/services/ghost_filter.toml ships.
#pragma once

#include <cstdint>

#include "services/ghost_filter/core/evidence/config.hpp"
#include "services/ghost_filter/core/published/config.hpp"

namespace boresight::ghosts {

enum class MethodName : std::uint8_t {
  kEvidence,   ///< additive evidence: the product's own
  kPublished,  ///< Le Ba Thanh 2023: the baseline
};

struct Config {
  MethodName method = MethodName::kEvidence;
  EvidenceConfig evidence;
  published::Config published;
};

}  // namespace boresight::ghosts
