// The methods by name.
#pragma once

#include <array>

#include "services/ghost_filter/core/config.hpp"

namespace boresight::bench {

struct NamedMethod {
  const char* name;
  ghosts::MethodName method;
};

/// The last one is the product's own.
inline constexpr std::array<NamedMethod, 2> kMethods = {
    {{"published", ghosts::MethodName::kPublished}, {"evidence", ghosts::MethodName::kEvidence}}};

[[nodiscard]] inline ghosts::Config config_of(const NamedMethod& named, const ghosts::EvidenceWeights& weights) {
  ghosts::Config config;
  config.method = named.method;
  config.evidence.weights = weights;
  return config;
}

}  // namespace boresight::bench
