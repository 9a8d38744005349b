// Dirt, snow or ice that builds up on a radar, and the blockage that the sensor reports.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "interfaces/messages/service_status.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/radar_effects.hpp"

namespace boresight::simulator::radar {

/// Blockage at an instant, within azimuths of the sensor's frame.
struct Dirt {
  double azimuth_min_rad, azimuth_max_rad;
  double loss_db;  ///< two-way
};

/// Two-way loss at `t_s`: linear from 0 at `begin_s` to `loss_db` at `full_s`; a jump if `full_s` is not later.
[[nodiscard]] inline double built_up_db(const RadarBlockage& blockage, double t_s) {
  if (t_s < blockage.begin_s) return 0.0;
  const double span = blockage.full_s - blockage.begin_s;
  return blockage.loss_db * (span > 0.0 ? std::min(1.0, (t_s - blockage.begin_s) / span) : 1.0);
}

inline void dirt_at(std::span<const RadarBlockage> blockages, std::uint32_t radar, double t_s,
                    std::vector<Dirt>& dirt) {
  dirt.clear();
  for (const RadarBlockage& b : blockages) {
    if (b.radar != radar) continue;
    const double loss = built_up_db(b, t_s);
    if (loss > 0.0) dirt.push_back({b.azimuth_min_rad, b.azimuth_max_rad, loss});
  }
}

/// Two-way loss in a direction; the losses of several layers add up.
[[nodiscard]] inline double loss_db(std::span<const Dirt> dirt, double azimuth_rad) {
  double loss = 0.0;
  for (const Dirt& d : dirt) {
    if (azimuth_rad >= d.azimuth_min_rad && azimuth_rad <= d.azimuth_max_rad) loss += d.loss_db;
  }
  return loss;
}

/// The condition that the sensor reports: source_condition bits. The sensor measures the loss of its cover itself.
/// Partly blocked: a tenth of the field of view or more loses at least 3 dB (a sixth of the range). Blocked: nine
/// tenths lose at least 15 dB (over half of the range).
[[nodiscard]] inline std::uint32_t stated_condition(std::span<const Dirt> dirt, const FieldOfView& view) {
  constexpr int kSamples = 64;
  int reduced = 0, blind = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double part = (i + 0.5) / kSamples;
    const double loss = loss_db(dirt, view.azimuth_min_rad + part * (view.azimuth_max_rad - view.azimuth_min_rad));
    reduced += loss >= 3.0 ? 1 : 0;
    blind += loss >= 15.0 ? 1 : 0;
  }
  if (10 * blind >= 9 * kSamples) return source_condition::kBlocked;
  return 10 * reduced >= kSamples ? source_condition::kPartlyBlocked : 0;
}

}  // namespace boresight::simulator::radar
