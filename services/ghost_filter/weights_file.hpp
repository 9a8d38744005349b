// The table [evidence] of a radar profile: weights of the evidence, as fitted to drives of that radar.
#pragma once

#include <filesystem>

#include "services/common/runtime/config/reader.hpp"
#include "services/ghost_filter/core/evidence/weights.hpp"

namespace boresight::ghosts {

/// Reads the table [evidence] of the file; other tables are the simulator's. Throws config::Error, also if the table is
/// absent.
[[nodiscard]] EvidenceWeights read_weights(const std::filesystem::path& profile);
[[nodiscard]] EvidenceWeights read_weights(config::Reader profile);

}  // namespace boresight::ghosts
