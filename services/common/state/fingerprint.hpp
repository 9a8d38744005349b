// A fingerprint (CRC-64) of values, to tell whether a stored state belongs to the present configuration.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <string_view>

#include "services/common/e2e/crc.hpp"

namespace boresight::state {

class Fingerprint {
 public:
  void add(std::uint64_t value) {
    std::array<std::uint8_t, 8> bytes;
    for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(value >> (8 * i));
    state_ = e2e::update_crc64(state_, bytes);
  }
  void add(double value) { add(std::bit_cast<std::uint64_t>(value + 0.0)); }  // −0 is 0
  void add(std::string_view text) {
    add(static_cast<std::uint64_t>(text.size()));
    state_ = e2e::update_crc64(state_, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  }
  [[nodiscard]] std::uint64_t value() const { return ~state_; }

 private:
  std::uint64_t state_ = ~std::uint64_t{0};
};

}  // namespace boresight::state
