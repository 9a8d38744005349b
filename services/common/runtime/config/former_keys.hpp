// Configuration keys that were renamed or moved. A file that still has the former key gets an error that names the key
// of today.
#pragma once

#include <array>
#include <string_view>

namespace boresight::config {

struct RenamedKey {
  std::string_view former;
  std::string_view current;
};

/// The entry counts in every table where `current` is a known key and `former` is none.
inline constexpr std::array kRenamedKeys = {
    RenamedKey{"knock", "step_change"},            // filter of services/alignment_estimator.toml, radars of scenarios
    RenamedKey{"flank_low_m", "side_low_m"},       // body of scenarios
    RenamedKey{"confidence_sigma", "confidence"},  // misalignment of services/health.toml: a probability now
};

/// A key that is in another file now.
struct MovedKey {
  std::string_view former;
  std::string_view beside;   ///< a key of the table that the former key was in
  std::string_view current;  ///< where it is now
};

inline constexpr std::array kMovedKeys = {
    MovedKey{"inhibit_deg", "clear_ratio", "'limit' of each radar in the vehicle file"},
};

}  // namespace boresight::config
