// Echoes: the wave travels out by one path and back by the same or another path.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "services/simulator/detection_truth.hpp"
#include "services/simulator/radar/antenna.hpp"
#include "services/simulator/radar/key.hpp"
#include "services/simulator/radar/one_way.hpp"
#include "services/simulator/radar/target.hpp"

namespace boresight::simulator::radar {

struct Echo {
  double range_m;
  double azimuth_rad, elevation_rad;  ///< of arrival, sensor frame as really mounted
  double range_rate_mps;
  double power_db;  ///< relative to a 0 dBsm reflector at 10 m on boresight
  DetectionTruth truth;
  std::uint64_t key;  ///< of its random draws
};

/// The radar equation for paths of different length out and back: the power falls with the square of each length. In dB
/// relative to 0 dBsm at 10 m.
[[nodiscard]] inline double radar_equation_db(double rcs_dbsm, double out_m, double back_m) {
  return rcs_dbsm - 20.0 * std::log10(out_m * back_m / 100.0);
}

/// Bistatic loss of a reflection centre, dB ≥ 0: parabolic in the angle between incident and reflected path, 3 dB at
/// `half_power_rad`, at most 18 dB. Corners, the strong centres of vehicles, are retroreflectors. The path out and back
/// by the same mirror has no bistatic loss, so it can be stronger than a path with fewer bounces.
[[nodiscard]] inline double bistatic_loss_db(const Eigen::Vector3d& lit_from, const Eigen::Vector3d& seen_from,
                                             double half_power_rad) {
  constexpr double kMaxLoss_db = 18.0;
  if (half_power_rad <= 0.0) return 0.0;
  const double angle = std::acos(std::clamp(lit_from.dot(seen_from), -1.0, 1.0)) / half_power_rad;
  return std::min(kMaxLoss_db, 3.0 * angle * angle);
}

/// Truth of an echo (docs/algorithms/ghosts.md): the last reflection before the sensor decides. At the target, the echo
/// has the target's direction; it is a ghost of type 1 if the path out includes a mirror. At a mirror it is of type 2.
[[nodiscard]] inline DetectionTruth truth_of(const Target& target, const OneWay& out, const OneWay& back) {
  DetectionTruth truth;
  truth.object_id = target.body_id;
  truth.origin = target.origin;
  truth.bounces = static_cast<std::uint8_t>(out.mirrors + back.mirrors);
  if (back.mirrors > 0) {
    truth.provenance = Provenance::kGhostType2;
    truth.mirror_body = back.mirror_body;
  } else if (out.mirrors > 0) {
    truth.provenance = Provenance::kGhostType1;
    truth.mirror_body = out.mirror_body;
  } else {
    truth.provenance = target.moving ? Provenance::kMoving : Provenance::kStationary;
  }
  return truth;
}

/// Appends every combination of paths out and back that leaves and arrives within the antenna's field of view. The
/// number of reflections, including the one at the target, is at most `spec.max_bounces`.
inline void combine(const Target& target, std::span<const OneWay> paths, const MultipathSpec& spec,
                    const Antenna& antenna, const Eigen::Matrix3d& world_to_sensor, std::vector<Echo>& echoes) {
  for (const OneWay& back : paths) {
    const Look arrival = antenna.look(world_to_sensor * back.direction);
    if (!arrival.inside) continue;
    for (const OneWay& out : paths) {
      if (static_cast<unsigned>(out.mirrors) + back.mirrors + 1 > std::max(1u, spec.max_bounces)) continue;
      const Look departure = antenna.look(world_to_sensor * out.direction);
      const double range = 0.5 * (out.length_m + back.length_m);
      if (!departure.inside || range > antenna.view().range_max_m || range < 0.5) continue;
      echoes.push_back({range, arrival.azimuth_rad, arrival.elevation_rad, 0.5 * (out.rate_mps + back.rate_mps),
                        radar_equation_db(target.rcs_dbsm, out.length_m, back.length_m) - out.loss_db - back.loss_db -
                            departure.loss_db - arrival.loss_db -
                            (&out == &back ? 0.0 : bistatic_loss_db(out.incidence, back.incidence, spec.bistatic_rad)),
                        truth_of(target, out, back), key_of(target.key, key_of(out.key, back.key))});
    }
  }
}

}  // namespace boresight::simulator::radar
