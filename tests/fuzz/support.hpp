// Shared code of the fuzz targets: requirements, a parser of the input, a guard against allocation, checks of a scan.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <span>

#include <sanitizer/allocator_interface.h>
#include <sanitizer/common_interface_defs.h>

#include "interfaces/messages/radar_scan.hpp"

namespace boresight::fuzz {

/// Ends the process if the condition is false. libFuzzer treats this as a crash and keeps the input.
inline void require(bool condition) {
  if (!condition) std::abort();
}

/// Returns the input part by part. After its end it returns zeros and empty parts.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : rest_(data, size) {}

  [[nodiscard]] bool empty() const { return rest_.empty(); }
  [[nodiscard]] std::span<const std::uint8_t> rest() const { return rest_; }
  [[nodiscard]] std::span<const std::uint8_t> bytes(std::size_t most) {
    const auto taken = rest_.first(std::min(most, rest_.size()));
    rest_ = rest_.subspan(taken.size());
    return taken;
  }
  /// Big endian.
  [[nodiscard]] std::uint64_t number(std::size_t bytes_of_it) {
    std::uint64_t value = 0;
    for (; bytes_of_it > 0; --bytes_of_it) {
      const auto next = bytes(1);
      value = value << 8 | (next.empty() ? 0u : next[0]);
    }
    return value;
  }
  [[nodiscard]] std::uint8_t u8() { return static_cast<std::uint8_t>(number(1)); }

 private:
  std::span<const std::uint8_t> rest_;
};

namespace detail {

inline thread_local bool allocation_forbidden = false;
inline thread_local bool allocation_seen = false;
inline thread_local std::size_t allocations = 0;

/// Hook of the sanitizer. It does not end the process, since the report of another failure allocates too and must
/// finish.
inline void on_allocation(const volatile void*, std::size_t) {
  ++allocations;
  if (!allocation_forbidden) return;
  allocation_forbidden = false;
  allocation_seen = true;
  static constexpr char kText[] = "allocates where nothing may, unless a failure is being reported:\n";
  static_cast<void>(std::fwrite(kText, 1, sizeof(kText) - 1, stderr));
  __sanitizer_print_stack_trace();
}
inline void on_free(const volatile void*) {}

/// Installs the hook before the first input, and checks that it is called.
inline const bool kHookInstalled = [] {
  require(__sanitizer_install_malloc_and_free_hooks(on_allocation, on_free) != 0);
  const std::size_t before = allocations;
  void* (*volatile allocate)(std::size_t) = std::malloc;  // volatile, so that the compiler does not remove it
  std::free(allocate(1));
  require(allocations == before + 1);
  return true;
}();

}  // namespace detail

/// During the lifetime of this object, an allocation on this thread fails the input: decoders of wire data must not
/// allocate.
class NoAllocation {
 public:
  NoAllocation() : before_(detail::allocation_forbidden) { detail::allocation_forbidden = detail::kHookInstalled; }
  ~NoAllocation() {
    require(!detail::allocation_seen);
    detail::allocation_forbidden = before_;
  }
  NoAllocation(const NoAllocation&) = delete;
  NoAllocation& operator=(const NoAllocation&) = delete;

 private:
  bool before_;
};

/// Memory for a message, filled with NaN and absurd numbers, so that a field that the decoder omits is detected.
template <typename Message>
Message* stale(Message& message) {
  std::memset(reinterpret_cast<char*>(&message) + sizeof(MessageHeader), 0xFF, sizeof(Message) - sizeof(MessageHeader));
  return &message;
}

/// Requires that the scan is within its capacity and that each detection is physically possible or flagged.
inline void require_possible(const RadarScan& scan) {
  constexpr float kPi = 3.1415928F;
  require(scan.number_of_valid_detections <= kMaxDetections);
  require(scan.integrity < 1u << scan_integrity::kNumberOfBits && scan.fields < 1u << 6);
  require(std::isfinite(scan.range_rate_min_mps) && scan.range_rate_min_mps <= scan.range_rate_max_mps);
  require(std::isfinite(scan.range_rate_max_mps));
  for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
    for (const auto* std :
         {&scan.range_std_m, &scan.azimuth_std_rad, &scan.elevation_std_rad, &scan.range_rate_std_mps}) {
      require((*std)[i] >= 0.0F && std::isfinite((*std)[i]));
    }
    require(scan.detection_flags[i] < 1u << 3);
    if ((scan.detection_flags[i] & detection_flag::kUntrusted) != 0) continue;
    require(scan.range_m[i] >= 0.0F && scan.range_m[i] <= 1500.0F);
    require(std::abs(scan.azimuth_rad[i]) <= kPi && std::abs(scan.elevation_rad[i]) <= kPi / 2.0F);
    require(std::abs(scan.range_rate_mps[i]) <= 150.0F);
    require(std::isfinite(scan.rcs_dbsm[i]) && std::isfinite(scan.snr_db[i]));
    require(scan.existence_probability[i] >= 0.0F && scan.existence_probability[i] <= 1.0F);
  }
}

inline void require_finite(const RadarScan& scan) {
  for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
    for (const auto* column : {&scan.range_m, &scan.azimuth_rad, &scan.elevation_rad, &scan.range_rate_mps,
                               &scan.rcs_dbsm, &scan.snr_db, &scan.existence_probability}) {
      require(std::isfinite((*column)[i]));
    }
  }
}

}  // namespace boresight::fuzz
