// RCS by range, as a radar states it.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "services/simulator/radar/returns/draws.hpp"
#include "services/simulator/radar/returns/interpolate.hpp"
#include "services/simulator/radar/returns/object_class.hpp"

namespace boresight::simulator::radar {

inline constexpr double kNormal90 = 1.2815515655446004;  ///< 90 % quantile of the standard normal distribution

/// The RCS at a standard normal value: a normal distribution on either side of the median.
[[nodiscard]] inline double rcs_at(const StrengthSpec& spec, const StrengthQuantiles& quantiles, double range_m,
                                   double normal) {
  const double median = interpolated(spec.range_m, quantiles.median_dbsm, range_m);
  const double other = interpolated(spec.range_m, normal < 0.0 ? quantiles.low_dbsm : quantiles.high_dbsm, range_m);
  return median + std::abs(normal) / kNormal90 * (other - median);
}

/// Standard deviation of the RCS at a range.
[[nodiscard]] inline double rcs_std_db(const StrengthSpec& spec, const StrengthQuantiles& quantiles, double range_m) {
  return 0.5 / kNormal90 *
         (interpolated(spec.range_m, quantiles.high_dbsm, range_m) -
          interpolated(spec.range_m, quantiles.low_dbsm, range_m));
}

/// What the detections of an object have in common: a slowly changing part, and a part of the scan. Standard normal.
struct CommonStrength {
  double slow, scan;
};
[[nodiscard]] inline CommonStrength common_strength(const StrengthSpec& spec, std::uint32_t object,
                                                    const Draws& draws) {
  return {draws.held("rcs of object", object, spec.object_correlation).gaussian(),
          draws.once("rcs of scan", object).gaussian()};
}

/// RCS of one detection of an object: the common parts and a part of its own, which lasts as its place does. `part`:
/// key of the detection.
[[nodiscard]] inline double object_rcs(const StrengthSpec& spec, BodyKind kind, double range_m,
                                       const CommonStrength& common, std::uint64_t part, const Draws& draws) {
  const double std_db = std::max(0.1, is_vehicle(kind) ? rcs_std_db(spec, spec.vehicle, range_m) : spec.person_std_db);
  const double own = std::min(1.0, std::pow(spec.detection_std_db / std_db, 2));
  const double scan = std::min(1.0 - own, std::pow(spec.scan_std_db / std_db, 2));
  const double slow = std::max(0.0, 1.0 - own - scan);
  const double normal = std::sqrt(slow) * common.slow + std::sqrt(scan) * common.scan +
                        std::sqrt(own) * draws.held("rcs", part, spec.detection_correlation).gaussian();
  if (is_vehicle(kind)) return rcs_at(spec, spec.vehicle, range_m, normal);
  return (kind == BodyKind::kPedestrian ? spec.pedestrian_dbsm : spec.two_wheeler_dbsm) + std_db * normal;
}

/// Level of the strongest detection of an object of this kind: the expected maximum of two detections.
[[nodiscard]] inline double strongest_level_dbsm(const StrengthSpec& spec, BodyKind kind, double range_m) {
  constexpr double kMaximumOfTwo = 0.5641895835477563;  // of standard normal values, 1/√π
  if (is_vehicle(kind)) return rcs_at(spec, spec.vehicle, range_m, kMaximumOfTwo);
  return (kind == BodyKind::kPedestrian ? spec.pedestrian_dbsm : spec.two_wheeler_dbsm) +
         kMaximumOfTwo * spec.person_std_db;
}

/// RCS at which half of the detections are reported: the weakest tenth of the stationary world lies below it.
[[nodiscard]] inline double sensitivity_dbsm(const StrengthSpec& spec, double range_m) {
  return rcs_at(spec, spec.stationary, range_m, -kNormal90);
}

/// RCS of a stationary reflector: `place` is its own standard normal value, which lasts.
[[nodiscard]] inline double stationary_rcs(const StrengthSpec& spec, double range_m, double place,
                                           std::uint64_t reflector, const Draws& draws) {
  const double std_db = std::max(0.1, rcs_std_db(spec, spec.stationary, range_m));
  const double scan = std::min(1.0, std::pow(spec.scan_std_db / std_db, 2));
  const double normal = std::sqrt(1.0 - scan) * place + std::sqrt(scan) * draws.once("glint", reflector).gaussian();
  return rcs_at(spec, spec.stationary, range_m, normal);
}

[[nodiscard]] inline double false_rcs(const StrengthSpec& spec, double range_m, Stream& stream) {
  return rcs_at(spec, spec.false_mover, range_m, stream.gaussian());
}

/// Offset of a radar's scale, for the whole drive.
[[nodiscard]] inline double radar_offset_db(const StrengthSpec& spec, const Draws& draws) {
  if (!spec.on) return 0.0;
  return draws.always("rcs of radar").uniform(-spec.radar_offset_db, spec.radar_offset_db);
}

}  // namespace boresight::simulator::radar
