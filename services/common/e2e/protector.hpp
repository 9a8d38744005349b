// The sender's side of E2E protection.
#pragma once

#include <cstdint>
#include <span>

#include "services/common/e2e/profile.hpp"

namespace boresight::e2e {

/// Protects the messages of one sender.
class Protector {
 public:
  explicit Protector(const Config& config);

  /// Writes the header fields and the CRC into the data at offset_bytes, and advances the counter. Returns
  /// false without any change if the data are too short for the header, or too long for the length field (P04 and P06:
  /// 65,535 bytes).
  bool protect(std::span<std::uint8_t> data);

  /// The counter of the next protected message.
  [[nodiscard]] std::uint32_t counter() const { return counter_; }

 private:
  Config config_;
  std::uint32_t counter_;
};

}  // namespace boresight::e2e
