// Configuration keys that were renamed. A file that still has the former key gets an error that names the key of today.
#pragma once

#include <array>
#include <string_view>

namespace boresight::config {

struct RenamedKey {
  std::string_view former;
  std::string_view current;
};

/// The entry counts in every table where `current` is a known key and `former` is none.
constexpr std::array kRenamedKeys = {
    RenamedKey{"knock", "step_change"},       // filter of services/alignment_estimator.toml, radars of scenarios
    RenamedKey{"flank_low_m", "side_low_m"},  // body of scenarios
};

}  // namespace boresight::config
