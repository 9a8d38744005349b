// Weights of the evidence as text, alone and in the place of those of a radar profile.
#pragma once

#include <string>
#include <string_view>

#include "services/ghost_filter/core/evidence/weights.hpp"

namespace boresight::fit_evidence {

/// The table as TOML. `origin`: the drives of the fit.
[[nodiscard]] std::string weights_text(const ghosts::EvidenceWeights& weights, const std::string& origin);

/// The text of a profile with the table `weights` (weights_text()) in the place of its table [evidence], or at its end.
/// All else stays. Throws config::Error if the result does not state these weights, for example because the profile
/// has the table in another form than under headings [evidence…], or is not TOML. `name`: of the profile, in errors.
[[nodiscard]] std::string with_weights(std::string_view profile, std::string_view weights, std::string_view name);

}  // namespace boresight::fit_evidence
