#include "services/alignment_estimator/core/memory/codec.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string_view>

#include <Eigen/Cholesky>

#include "services/common/e2e/crc.hpp"

namespace boresight::alignment {

namespace {

constexpr std::string_view kMagic = "BORALIGN";

class Writer {
 public:
  explicit Writer(MemoryBytes& bytes) : bytes_(bytes) {}
  void u32(std::uint32_t value) { put(value, 4); }
  void u64(std::uint64_t value) { put(value, 8); }
  void f64(double value) { put(std::bit_cast<std::uint64_t>(value), 8); }
  void text(std::string_view value) {
    for (const char c : value) bytes_[size_++] = static_cast<std::uint8_t>(c);
  }
  [[nodiscard]] std::size_t size() const { return size_; }

 private:
  void put(std::uint64_t value, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) bytes_[size_++] = static_cast<std::uint8_t>(value >> (8 * i));
  }
  MemoryBytes& bytes_;
  std::size_t size_ = 0;
};

/// Reads within a length that the caller has checked.
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}
  std::uint32_t u32() { return static_cast<std::uint32_t>(get(4)); }
  std::uint64_t u64() { return get(8); }
  double f64() { return std::bit_cast<double>(get(8)); }

 private:
  std::uint64_t get(std::size_t count) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < count; ++i) value |= static_cast<std::uint64_t>(bytes_[at_++]) << (8 * i);
    return value;
  }
  std::span<const std::uint8_t> bytes_;
  std::size_t at_ = 0;
};

std::size_t length_of(std::size_t radars) {
  const std::size_t n = Memory::kShared + 3 * radars;
  return kMemoryHeaderBytes + radars * kMemoryRadarBytes + n * (n + 1) / 2 * 8 + 4;
}

/// Whether an estimator can produce these values; its own gates are much narrower.
bool is_plausible(const Memory& m) {
  const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
  if (!within(m.speed_scale, 0.5, 2.0) || !within(m.yaw_rate_bias_radps, -1.0, 1.0) ||
      !within(m.slip_coefficient_radps2pm, -1.0, 1.0)) {
    return false;
  }
  for (std::size_t i = 0; i < m.number_of_radars; ++i) {
    const Memory::Radar& r = m.radars[i];
    for (const double d : r.rotation_vehicle_rad) {
      if (!within(d, -M_PI, M_PI)) return false;
    }
    if (!within(r.angle_noise_scale, 1e-3, 1e3) || !within(r.seconds_of_drive, 0.0, 1e10)) return false;
  }
  // Positive definite as a correlation matrix, except for rounding.
  const auto n = static_cast<Eigen::Index>(m.number_of_parameters());
  Eigen::MatrixXd covariance = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
      m.covariance.data(), n, n);
  if (!covariance.allFinite() || !(covariance.diagonal().minCoeff() > 0.0) || covariance.diagonal().maxCoeff() > 1e6) {
    return false;
  }
  const Eigen::VectorXd scale = covariance.diagonal().cwiseSqrt().cwiseInverse();
  covariance = (scale.asDiagonal() * covariance * scale.asDiagonal()).eval();
  covariance.diagonal().array() += 1e-6;
  return Eigen::LLT<Eigen::MatrixXd>(covariance).info() == Eigen::Success;
}

/// Removes the radars that are not `kept`.
void reduce(Memory& m, const std::array<bool, kMaxRadars>& kept) {
  std::array<std::size_t, Memory::kMaxParameters> from{};
  std::size_t n = 0, radars = 0;
  for (; n < Memory::kShared; ++n) from[n] = n;
  for (std::size_t i = 0; i < m.number_of_radars; ++i) {
    if (!kept[i]) continue;
    m.radars[radars++] = m.radars[i];
    for (std::size_t k = 0; k < 3; ++k) from[n++] = Memory::kShared + 3 * i + k;
  }
  // Entries move only towards the beginning, so none is overwritten before it is read.
  const std::size_t old_n = m.number_of_parameters();
  for (std::size_t r = 0; r < n; ++r) {
    for (std::size_t c = 0; c < n; ++c) m.covariance[r * n + c] = m.covariance[from[r] * old_n + from[c]];
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
  writer.text(kMagic);
  writer.u32(kMemoryVersion);
  writer.u32(static_cast<std::uint32_t>(length_of(memory.number_of_radars)));
  writer.u64(identity.vehicle);
  writer.u32(static_cast<std::uint32_t>(memory.number_of_radars));
  writer.u32(0);
  writer.f64(memory.speed_scale);
  writer.f64(memory.yaw_rate_bias_radps);
  writer.f64(memory.slip_coefficient_radps2pm);
  for (std::size_t i = 0; i < memory.number_of_radars; ++i) {
    const Memory::Radar& radar = memory.radars[i];
    const std::uint64_t* const fingerprint = identity.fingerprint(radar.id);
    if (fingerprint == nullptr) return 0;
    writer.u32(radar.id);
    writer.u32(0);
    writer.u64(*fingerprint);
    for (const double d : radar.rotation_vehicle_rad) writer.f64(d);
    writer.f64(radar.angle_noise_scale);
    writer.f64(radar.seconds_of_drive);
  }
  const std::size_t n = memory.number_of_parameters();
  for (std::size_t r = 0; r < n; ++r) {
    for (std::size_t c = r; c < n; ++c) writer.f64(memory.covariance[r * n + c]);
  }
  writer.u32(e2e::crc32_p4({out.data(), writer.size()}));
  return writer.size();
}

MemoryVerdict decode_memory(std::span<const std::uint8_t> bytes, const Identity& identity, Memory& out,
                            std::size_t& rejected_radars) {
  // The frame of magic, version, length and checksum is the same in every version.
  if (bytes.size() < 20 || !std::equal(kMagic.begin(), kMagic.end(), bytes.begin())) return MemoryVerdict::kCorrupt;
  Reader reader(bytes);
  static_cast<void>(reader.u64());
  const std::uint32_t version = reader.u32(), length = reader.u32();
  if (length != bytes.size()) return MemoryVerdict::kCorrupt;
  const auto covered = bytes.first(bytes.size() - 4);
  if (Reader(bytes.last(4)).u32() != e2e::crc32_p4(covered)) return MemoryVerdict::kCorrupt;
  if (version != kMemoryVersion) return MemoryVerdict::kOtherVersion;
  if (bytes.size() < kMemoryHeaderBytes) return MemoryVerdict::kCorrupt;
  const std::uint64_t vehicle = reader.u64();
  Memory m;
  m.number_of_radars = reader.u32();
  static_cast<void>(reader.u32());
  if (m.number_of_radars > kMaxRadars || bytes.size() != length_of(m.number_of_radars)) return MemoryVerdict::kCorrupt;
  if (vehicle != identity.vehicle) return MemoryVerdict::kForeign;
  m.speed_scale = reader.f64();
  m.yaw_rate_bias_radps = reader.f64();
  m.slip_coefficient_radps2pm = reader.f64();
  std::array<bool, kMaxRadars> kept{};
  std::size_t number_kept = 0;
  for (std::size_t i = 0; i < m.number_of_radars; ++i) {
    Memory::Radar& radar = m.radars[i];
    radar.id = reader.u32();
    static_cast<void>(reader.u32());
    const std::uint64_t fingerprint = reader.u64();
    const std::uint64_t* const expected = identity.fingerprint(radar.id);
    kept[i] = expected != nullptr && *expected == fingerprint;
    if (kept[i]) ++number_kept;
    for (double& d : radar.rotation_vehicle_rad) d = reader.f64();
    radar.angle_noise_scale = reader.f64();
    radar.seconds_of_drive = reader.f64();
  }
  const std::size_t n = m.number_of_parameters();
  for (std::size_t r = 0; r < n; ++r) {
    for (std::size_t c = r; c < n; ++c) m.covariance[r * n + c] = m.covariance[c * n + r] = reader.f64();
  }
  if (!is_plausible(m)) return MemoryVerdict::kImplausible;
  rejected_radars = m.number_of_radars - number_kept;
  reduce(m, kept);
  out = m;
  return MemoryVerdict::kTaken;
}

}  // namespace boresight::alignment
