#include "services/health/core/function/levels_codec.hpp"

#include <array>
#include <cmath>

#include "services/common/state/fingerprint.hpp"
#include "services/common/state/frame.hpp"

namespace boresight::health {

namespace {

constexpr std::string_view kMagic = "BORLEVEL";

std::array<StoredLevel*, 3> levels_in(RadarLevels& radar) {
  return {&radar.sight.log_count, &radar.sight.log_range, &radar.log_unexplained};
}

/// No logarithm of a number or of a range in metres exceeds this.
constexpr double kLargestLog = 20.0;

bool is_possible(const StoredLevel& level) {
  return std::isfinite(level.mean) && std::abs(level.mean) <= kLargestLog && level.variance >= 0.0 &&
         level.variance <= kLargestLog * kLargestLog && level.learnt_s >= 0.0 && std::isfinite(level.learnt_s);
}

}  // namespace

LevelsIdentity levels_identity_of(const VehicleConfig& vehicle, const Config& config) {
  state::Fingerprint print;
  const ExplanationConfig& e = config.disturbance.explanation;
  for (const double value : {config.sight.range_quantile, config.sight.smoothing_s, config.disturbance.smoothing_s,
                             e.stationary_tolerance_mps, e.stationary_tolerance_ratio, e.neighbour_distance_m,
                             e.neighbour_range_rate_mps, e.fastest_reverse_mps}) {
    print.add(value);
  }
  return {.vehicle = identity_of(vehicle), .quantities = print.value()};
}

const char* describe(StoredLevels verdict) {
  switch (verdict) {
    case StoredLevels::kTaken:
      return "taken";
    case StoredLevels::kCorrupt:
      return "corrupt";
    case StoredLevels::kOtherVersion:
      return "of another version";
    case StoredLevels::kForeign:
      return "of another vehicle";
    case StoredLevels::kOtherConfiguration:
      return "of another configuration";
  }
  return "unknown";
}

std::size_t encode_levels(const VehicleLevels& levels, const LevelsIdentity& identity, std::span<std::uint8_t> out) {
  state::ByteWriter writer(out);
  state::begin_frame(writer, kMagic, kLevelsVersion);
  writer.u64(identity.vehicle.vehicle);
  writer.u64(identity.quantities);
  writer.u32(static_cast<std::uint32_t>(levels.number_of_radars));
  for (std::size_t i = 0; i < levels.number_of_radars; ++i) {
    RadarLevels radar = levels.radars[i];
    const std::uint64_t* const fingerprint = identity.vehicle.fingerprint(radar.radar_id);
    if (fingerprint == nullptr) return 0;
    writer.u32(radar.radar_id);
    writer.u64(*fingerprint);
    for (const StoredLevel* level : levels_in(radar)) {
      writer.f64(level->mean);
      writer.f64(level->variance);
      writer.f64(level->learnt_s);
    }
  }
  return state::end_frame(writer);
}

StoredLevels decode_levels(std::span<const std::uint8_t> bytes, const LevelsIdentity& identity, VehicleLevels& levels,
                           std::size_t& rejected_radars) {
  const state::Frame frame = state::open_frame(bytes, kMagic, kLevelsVersion);
  if (frame.verdict == state::FrameVerdict::kOtherVersion) return StoredLevels::kOtherVersion;
  if (frame.verdict != state::FrameVerdict::kIntact) return StoredLevels::kCorrupt;
  state::ByteReader reader(frame.content);
  const std::uint64_t vehicle = reader.u64(), quantities = reader.u64();
  const std::uint32_t count = reader.u32();
  if (!reader.fits() || count > kMaxRadars || reader.left() != count * kRadarLevelsBytes) return StoredLevels::kCorrupt;
  if (vehicle != identity.vehicle.vehicle) return StoredLevels::kForeign;
  if (quantities != identity.quantities) return StoredLevels::kOtherConfiguration;
  VehicleLevels read;
  for (std::uint32_t i = 0; i < count; ++i) {
    RadarLevels radar;
    radar.radar_id = reader.u32();
    const std::uint64_t fingerprint = reader.u64();
    for (StoredLevel* level : levels_in(radar)) {
      level->mean = reader.f64();
      level->variance = reader.f64();
      level->learnt_s = reader.f64();
      if (!is_possible(*level)) return StoredLevels::kCorrupt;
    }
    const std::uint64_t* const expected = identity.vehicle.fingerprint(radar.radar_id);
    if (expected != nullptr && *expected == fingerprint) read.radars[read.number_of_radars++] = radar;
  }
  rejected_radars = count - read.number_of_radars;
  levels = read;
  return StoredLevels::kTaken;
}

}  // namespace boresight::health
