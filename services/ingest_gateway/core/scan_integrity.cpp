#include "services/ingest_gateway/core/scan_integrity.hpp"

#include <algorithm>
#include <cmath>

namespace boresight::ingest {

namespace {

/// Largest age of usable data: at 30 m/s the vehicle moves 15 m in this time.
constexpr double kStale_ns = 500e6;
/// Frames closer together than this part of a cycle belong to one burst.
constexpr double kBurst = 0.25;
/// Without a counter, a scan is missing if it is late by half a cycle.
constexpr double kCyclesToGap = 1.5;
/// A counter that is constant for this number of scans since the start is not used: some firmware leaves it at 0.
constexpr std::uint64_t kScansToDisown = 10;
/// Narrower counters wrap so often that time does not give the number of wraps.
constexpr unsigned kLeastBitsToUnwrap = 4;

/// If more scans are lost than this, compared with the elapsed time, the sensor restarted its counter.
constexpr double kMostLostToTime = 4.0, kMostLostAtOnce = 64.0;

/// Few coarsely quantised tracks can be equal in two scans by chance; noise makes four such scans impossible …
constexpr std::size_t kFrozenDetections = 4;
constexpr std::uint64_t kFrozenRepeats = 3;
/// … except for a radar that filters, in a vehicle at standstill.
constexpr std::size_t kFrozenDetectionsStanding = 8;
constexpr std::uint64_t kFrozenRepeatsStanding = 10;
constexpr float kStanding_mps = 1.0F;

/// Tolerance beyond the field of view of the vehicle file: the edges of an antenna's pattern are not sharp.
constexpr double kAngleMargin_rad = 10.0 * M_PI / 180.0;
constexpr double kRangeMargin = 1.2;
/// Beyond the range of all radars, and beyond all range rates on roads (two cars at 270 km/h each).
constexpr float kMaxRange_m = 1500.0F, kMaxRangeRate_mps = 150.0F;
/// Single implausible detections are clutter, a fifth of a scan is a fault.
constexpr std::size_t kLeastImplausible = 3, kImplausiblePart = 5;

/// Coarsely quantised clusters of one car may be equal in pairs, but not a quarter of a scan.
constexpr std::size_t kLeastCopies = 8, kCopiesPart = 4;

}  // namespace

ScanJudge::ScanJudge(const RadarConfig& radar, const ContradictionConfig& contradiction)
    : field_of_view_(radar.field_of_view),
      cycle_ns_(std::max(radar.cycle_time_s, 1e-3) * 1e9),
      contradiction_(radar, contradiction) {}

std::uint16_t ScanJudge::judge(const RadarScan& scan, std::int64_t measurement_time_ns, std::int64_t received_ns,
                               unsigned cycle_counter_bits, const EgoMotion* latest_ego) {
  using namespace scan_integrity;
  const std::size_t detections = std::min<std::size_t>(scan.number_of_valid_detections, kMaxDetections);
  std::uint16_t verdict = scan.integrity;
  const auto accuse = [&verdict](bool guilty, std::uint16_t bit) {
    if (guilty) verdict = static_cast<std::uint16_t>(verdict | bit);
  };
  compare(fingerprint(scan, detections));
  if (has_last_) {
    accuse(true, judge_order(scan, measurement_time_ns, std::min(cycle_counter_bits, 32u)));
  }
  accuse(is_stale(measurement_time_ns, received_ns), kStale);
  accuse(is_frozen(detections, latest_ego), kFrozen);
  accuse(is_implausible(scan, detections), kImplausible);
  const std::size_t copies = copies_.count(scan, detections);
  accuse(copies >= kLeastCopies && copies * kCopiesPart >= detections, kImpossibleCopies);
  // A repeated or implausible scan is not used for the comparison with the vehicle's motion.
  const bool is_measurement = (verdict & (kRepeated | kFrozen | kStale | kImplausible | kImpossibleCopies)) == 0;
  if (latest_ego != nullptr && is_measurement) {
    accuse(contradiction_.judge(scan, measurement_time_ns, *latest_ego), kContradictsEgo);
  }

  has_last_ = true;
  last_counter_ = scan.cycle_counter;
  last_counter_bits_ = cycle_counter_bits;
  last_measured_ns_ = measurement_time_ns;
  last_received_ns_ = received_ns;
  ++counters_.scans;
  for (std::size_t bit = 0; bit < kNumberOfBits; ++bit) counters_.by_bit[bit] += verdict >> bit & 1u;
  return verdict;
}

std::uint16_t ScanJudge::judge_order(const RadarScan& scan, std::int64_t measurement_time_ns, unsigned bits) {
  const double cycles = (static_cast<double>(measurement_time_ns) - static_cast<double>(last_measured_ns_)) / cycle_ns_;
  // A counter that passes 0 looks like a missing counter for one scan.
  const bool has_counter = bits > 0 && last_counter_bits_ > 0;
  if (has_counter) {
    const std::uint32_t mask = bits == 32 ? ~0u : (1u << bits) - 1;
    const std::uint32_t steps = (scan.cycle_counter - last_counter_) & mask;
    counter_moves_ = counter_moves_ || steps != 0;
    if (!counter_moves_) ++repeats_since_start_;
    if (counter_moves_ || repeats_since_start_ <= kScansToDisown) return judge_counter(steps, bits, cycles);
  }
  // The same content with the same stamp was sent or read twice.
  if (equal_scans_ > 0 && measurement_time_ns <= last_measured_ns_ && scan.number_of_valid_detections > 0) {
    return scan_integrity::kRepeated;
  }
  if (cycles <= kCyclesToGap) return 0;
  counters_.lost_scans += static_cast<std::uint64_t>(std::max(1.0, std::round(cycles) - 1.0));
  return scan_integrity::kCounterGap;
}

std::uint16_t ScanJudge::judge_counter(std::uint32_t steps, unsigned bits, double cycles) {
  const double period = std::ldexp(1.0, static_cast<int>(bits));
  const double by_time = std::max(0.0, std::round(cycles) - 1.0);
  double lost = static_cast<double>(steps) - 1.0;  // -1: a repetition
  // The counter gives the number modulo its period, the time the approximate number of periods.
  if (bits >= kLeastBitsToUnwrap) lost += period * std::max(0.0, std::round((by_time - lost) / period));
  if (lost == 0.0) return 0;
  if (lost < 0.0) return scan_integrity::kRepeated;
  const bool restarted = lost > kMostLostToTime * by_time + kMostLostAtOnce;
  counters_.lost_scans += static_cast<std::uint64_t>(restarted ? by_time : lost);
  return scan_integrity::kCounterGap;
}

bool ScanJudge::is_stale(std::int64_t measurement_time_ns, std::int64_t received_ns) const {
  const auto received = static_cast<double>(received_ns);
  if (received - static_cast<double>(measurement_time_ns) > kStale_ns) return true;
  const bool frames_come = received - static_cast<double>(last_received_ns_) > kBurst * cycle_ns_;
  return has_last_ && frames_come && measurement_time_ns <= last_measured_ns_;
}

void ScanJudge::compare(std::uint64_t now) {
  equal_scans_ = has_last_ && now == last_fingerprint_ ? equal_scans_ + 1 : 0;
  last_fingerprint_ = now;
}

bool ScanJudge::is_frozen(std::size_t detections, const EgoMotion* ego) const {
  const bool may_stand = ego == nullptr || !ego->has(ego_field::kSpeed) || !(std::abs(ego->speed_mps) > kStanding_mps);
  return equal_scans_ >= (may_stand ? kFrozenRepeatsStanding : kFrozenRepeats) &&
         detections >= (may_stand ? kFrozenDetectionsStanding : kFrozenDetections);
}

bool ScanJudge::is_implausible(const RadarScan& scan, std::size_t detections) const {
  const FieldOfView& fov = field_of_view_;
  const auto range_max = static_cast<float>(fov.range_max_m * kRangeMargin);
  const auto azimuth_min = static_cast<float>(fov.azimuth_min_rad - kAngleMargin_rad);
  const auto azimuth_max = static_cast<float>(fov.azimuth_max_rad + kAngleMargin_rad);
  const auto elevation_min = static_cast<float>(fov.elevation_min_rad - kAngleMargin_rad);
  const auto elevation_max = static_cast<float>(fov.elevation_max_rad + kAngleMargin_rad);
  constexpr float kPi = 3.1415927F;
  const bool has_elevation = scan.has(scan_field::kElevation);
  std::size_t implausible = 0;
  for (std::size_t i = 0; i < detections; ++i) {
    const float range = scan.range_m[i], azimuth = scan.azimuth_rad[i];
    const float elevation = has_elevation ? scan.elevation_rad[i] : 0.0F;
    // NaN fails every comparison.
    const bool possible = range >= 0.0F && range <= kMaxRange_m && std::abs(azimuth) <= kPi &&
                          std::abs(elevation) <= kPi / 2.0F && std::abs(scan.range_rate_mps[i]) <= kMaxRangeRate_mps;
    const bool visible = range <= range_max && azimuth >= azimuth_min && azimuth <= azimuth_max &&
                         elevation >= elevation_min && elevation <= elevation_max;
    // A quantity that the sensor marks as invalid may have any value.
    const bool marked = (scan.detection_flags[i] & detection_flag::kUntrusted) != 0;
    implausible += possible && (visible || marked) ? 0u : 1u;
  }
  return implausible >= kLeastImplausible && implausible * kImplausiblePart >= detections;
}

}  // namespace boresight::ingest
