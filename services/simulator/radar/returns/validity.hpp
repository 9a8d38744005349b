// The sensor's own verdicts on a detection: validity, ambiguity, probability of existence.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "interfaces/messages/radar_scan.hpp"
#include "services/simulator/radar/profile.hpp"
#include "services/simulator/radar/returns/draws.hpp"
#include "services/simulator/radar/returns/place.hpp"

namespace boresight::simulator::radar {

struct Verdict {
  std::uint16_t flags = 0;  ///< detection_flag bits
  double existence = 1.0;
};

/// `real`: the direct echo of a moving or stationary object. The existence probability is Φ(z), z normal about
/// ±separation / 2, so it separates real from false by an AUC of Φ(separation / √2).
[[nodiscard]] inline Verdict verdict_on(const ValiditySpec& spec, bool real, std::uint64_t key, const Draws& draws) {
  if (!spec.on) return {};
  Verdict v;
  Stream stream = draws.once("validity", key);
  if (stream.uniform() >= (real ? spec.valid_real : spec.valid_false)) v.flags |= detection_flag::kInvalid;
  if (stream.uniform() >= (real ? spec.unambiguous_real : spec.unambiguous_false)) {
    v.flags |= detection_flag::kAmbiguous;
  }
  const double normal = stream.gaussian() + (real ? 0.5 : -0.5) * spec.existence_separation;
  v.existence = std::clamp(0.5 * std::erfc(-normal / std::sqrt(2.0)), 0.01, 1.0);
  return v;
}

}  // namespace boresight::simulator::radar
