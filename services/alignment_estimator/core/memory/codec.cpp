#include "services/alignment_estimator/core/memory/codec.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <Eigen/Cholesky>

#include "services/common/state/frame.hpp"

namespace boresight::alignment {

namespace {

constexpr std::string_view kMagic = "BORALIGN";
constexpr std::uint32_t kHasElevation = 1;  // bit of a radar's flags

using Writer = state::ByteWriter;
using Reader = state::ByteReader;

std::size_t length_of(std::size_t radars) {
  return kMemoryHeaderBytes + kMemoryVehicleBytes + radars * kMemoryRadarBytes + 4;
}

/// Calls `visit` with every number of the vehicle, or of a radar, in the order of the layout.
template <typename MemoryType, typename Visit>
void visit_vehicle(MemoryType& m, const Visit& visit) {
  for (auto* value : {&m.speed_scale, &m.yaw_rate_bias_radps, &m.yaw_rate_gain, &m.slip_coefficient_radps2pm,
                      &m.pitch_per_acceleration_radps2pm, &m.time_offset_s, &m.load_pitch_rad}) {
    visit(*value);
  }
  for (auto& value : m.fluctuation_variance) visit(value);
  for (auto& value : m.correlation_s) visit(value);
}
template <typename RadarType, typename Visit>
void visit_radar(RadarType& r, const Visit& visit) {
  for (auto& value : r.rotation_vehicle_rad) visit(value);
  visit(r.range_rate_scale);
  visit(r.time_offset_s);
  for (auto& value : r.position_error_m) visit(value);
  for (auto& value : r.azimuth_curve_rad) visit(value);
  for (auto* value :
       {&r.height_excess, &r.mirror_share, &r.angle_noise_scale, &r.range_rate_noise_scale, &r.seconds_of_drive}) {
    visit(*value);
  }
  for (auto& value : r.fluctuation_variance) visit(value);
}

template <std::size_t kSize>
void write_triangle(const std::array<double, kSize>& matrix, std::size_t n, Writer& writer) {
  for (std::size_t r = 0; r < n; ++r) {
    for (std::size_t c = r; c < n; ++c) writer.f64(matrix[r * n + c]);
  }
}
template <std::size_t kSize>
void read_triangle(Reader& reader, std::size_t n, std::array<double, kSize>& matrix) {
  for (std::size_t r = 0; r < n; ++r) {
    for (std::size_t c = r; c < n; ++c) matrix[r * n + c] = matrix[c * n + r] = reader.f64();
  }
}

/// Positive semidefinite, except for rounding; a parameter that is not estimated has no covariances.
template <std::size_t kN>
bool is_covariance(const std::array<double, kN * kN>& values) {
  constexpr auto n = static_cast<Eigen::Index>(kN);
  using Square = Eigen::Matrix<double, n, n, Eigen::RowMajor>;
  Square covariance = Eigen::Map<const Square>(values.data());
  if (!covariance.allFinite() || covariance.diagonal().minCoeff() < 0.0 || covariance.diagonal().maxCoeff() > 1e6) {
    return false;
  }
  Eigen::Matrix<double, n, 1> scale;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double variance = covariance(i, i);
    if (variance == 0.0 && covariance.row(i).cwiseAbs().maxCoeff() > 0.0) return false;
    scale(i) = variance > 0.0 ? 1.0 / std::sqrt(variance) : 0.0;
  }
  covariance = (scale.asDiagonal() * covariance * scale.asDiagonal()).eval();
  covariance.diagonal().array() += 1e-6;
  return covariance.allFinite() && Eigen::LLT<Square>(covariance).info() == Eigen::Success;
}

bool within(double value, double low, double high) {
  return value >= low && value <= high;
}

bool is_plausible(const Memory::Radar& r) {
  for (const double d : r.rotation_vehicle_rad) {
    if (!within(d, -M_PI, M_PI)) return false;
  }
  for (const double x : r.position_error_m) {
    if (!within(x, -5.0, 5.0)) return false;
  }
  for (const double error : r.azimuth_curve_rad) {
    if (!within(error, -0.5, 0.5)) return false;
  }
  for (const double variance : r.fluctuation_variance) {
    if (!within(variance, 0.0, 1.0)) return false;
  }
  return within(r.range_rate_scale, -0.5, 0.5) && within(r.time_offset_s, -5.0, 5.0) &&
         within(r.height_excess, -100.0, 100.0) && within(r.mirror_share, -100.0, 100.0) &&
         within(r.angle_noise_scale, 1e-3, 1e3) && within(r.range_rate_noise_scale, 1e-3, 1e3) &&
         within(r.seconds_of_drive, 0.0, 1e10) && is_covariance<Memory::kOwn>(r.covariance);
}

/// Whether an estimator can produce these values; its own gates are much narrower.
bool is_plausible(const Memory& m) {
  if (!within(m.speed_scale, 0.5, 2.0) || !within(m.yaw_rate_bias_radps, -1.0, 1.0) ||
      !within(m.yaw_rate_gain, -0.9, 10.0) || !within(m.slip_coefficient_radps2pm, -1.0, 1.0) ||
      !within(m.pitch_per_acceleration_radps2pm, -1.0, 1.0) || !within(m.time_offset_s, -5.0, 5.0) ||
      !within(m.load_pitch_rad, -1.0, 1.0)) {
    return false;
  }
  for (const double variance : m.fluctuation_variance) {
    if (!within(variance, 0.0, 1.0)) return false;
  }
  for (const double time_s : m.correlation_s) {
    if (!within(time_s, 0.0, 1e5)) return false;
  }
  for (std::size_t i = 0; i < m.number_of_radars; ++i) {
    if (!is_plausible(m.radars[i])) return false;
  }
  return is_covariance<Memory::kShared>(m.covariance);
}

/// Removes the radars that are not `kept`.
void reduce(Memory& m, const std::array<bool, kMaxRadars>& kept) {
  std::size_t radars = 0;
  for (std::size_t i = 0; i < m.number_of_radars; ++i) {
    if (!kept[i]) continue;
    if (radars != i) m.radars[radars] = m.radars[i];
    ++radars;
  }
  m.number_of_radars = radars;
}

}  // namespace

const char* describe(MemoryVerdict verdict) {
  switch (verdict) {
    case MemoryVerdict::kTaken:
      return "taken";
    case MemoryVerdict::kCorrupt:
      return "corrupt";
    case MemoryVerdict::kOtherVersion:
      return "of another version";
    case MemoryVerdict::kForeign:
      return "of another vehicle";
    case MemoryVerdict::kImplausible:
      return "implausible";
  }
  return "unknown";
}

std::size_t encode_memory(const Memory& memory, const Identity& identity, MemoryBytes& out) {
  if (memory.number_of_radars > kMaxRadars) return 0;
  Writer writer(out);
  state::begin_frame(writer, kMagic, kMemoryVersion);
  writer.u64(identity.vehicle);
  writer.u32(static_cast<std::uint32_t>(memory.number_of_radars));
  writer.u32(0);
  writer.u64(memory.boot);
  writer.u64(static_cast<std::uint64_t>(memory.since_boot_ns));
  const auto write = [&writer](double value) { writer.f64(value); };
  visit_vehicle(memory, write);
  write_triangle(memory.covariance, Memory::kShared, writer);
  for (std::size_t i = 0; i < memory.number_of_radars; ++i) {
    const Memory::Radar& radar = memory.radars[i];
    const std::uint64_t* const fingerprint = identity.fingerprint(radar.id);
    if (fingerprint == nullptr) return 0;
    writer.u32(radar.id);
    writer.u32(radar.has_elevation ? kHasElevation : 0);
    writer.u64(*fingerprint);
    visit_radar(radar, write);
    write_triangle(radar.covariance, Memory::kOwn, writer);
  }
  return state::end_frame(writer);
}

MemoryVerdict decode_memory(std::span<const std::uint8_t> bytes, const Identity& identity, Memory& out,
                            std::size_t& rejected_radars) {
  const state::Frame frame = state::open_frame(bytes, kMagic, kMemoryVersion);
  if (frame.verdict == state::FrameVerdict::kOtherVersion) return MemoryVerdict::kOtherVersion;
  if (frame.verdict != state::FrameVerdict::kIntact || bytes.size() < kMemoryHeaderBytes) {
    return MemoryVerdict::kCorrupt;
  }
  Reader reader(frame.content);
  const std::uint64_t vehicle = reader.u64();
  const std::size_t radars = reader.u32();
  static_cast<void>(reader.u32());
  if (radars > kMaxRadars || bytes.size() != length_of(radars)) return MemoryVerdict::kCorrupt;
  if (vehicle != identity.vehicle) return MemoryVerdict::kForeign;
  Memory m;
  m.number_of_radars = radars;
  m.boot = reader.u64();
  m.since_boot_ns = static_cast<std::int64_t>(reader.u64());
  const auto read = [&reader](double& value) { value = reader.f64(); };
  visit_vehicle(m, read);
  read_triangle(reader, Memory::kShared, m.covariance);
  std::array<bool, kMaxRadars> kept{};
  std::size_t number_kept = 0;
  for (std::size_t i = 0; i < m.number_of_radars; ++i) {
    Memory::Radar& radar = m.radars[i];
    radar.id = reader.u32();
    radar.has_elevation = (reader.u32() & kHasElevation) != 0;
    const std::uint64_t fingerprint = reader.u64();
    const std::uint64_t* const expected = identity.fingerprint(radar.id);
    kept[i] = expected != nullptr && *expected == fingerprint;
    if (kept[i]) ++number_kept;
    visit_radar(radar, read);
    read_triangle(reader, Memory::kOwn, radar.covariance);
  }
  if (!is_plausible(m)) return MemoryVerdict::kImplausible;
  rejected_radars = m.number_of_radars - number_kept;
  reduce(m, kept);
  out = m;
  return MemoryVerdict::kTaken;
}

}  // namespace boresight::alignment
