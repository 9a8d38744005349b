// The table [evidence] of a radar profile: weights of the evidence, as fitted to drives of that radar.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "services/common/runtime/config/reader.hpp"
#include "services/ghost_filter/core/evidence/weights.hpp"

namespace boresight::ghosts {

/// Reads the table [evidence] of the file; other tables are the simulator's. Throws config::Error, also if the table is
/// absent.
[[nodiscard]] EvidenceWeights read_weights(const std::filesystem::path& profile);
[[nodiscard]] EvidenceWeights read_weights(config::Reader profile);

/// The table as TOML. `origin`: the drives of the fit.
[[nodiscard]] std::string weights_text(const EvidenceWeights& weights, const std::string& origin);

/// The text of a profile with the table `weights` (weights_text()) in the place of its table [evidence], or at its end.
/// All else stays. Throws config::Error if the result does not state these weights, for example because the profile
/// has the table in another form than under headings [evidence…], or is not TOML. `name`: of the profile, in errors.
[[nodiscard]] std::string with_weights(std::string_view profile, std::string_view weights, std::string_view name);

}  // namespace boresight::ghosts
