// An IPv4 or IPv6 address as a value.
#pragma once

#include <algorithm>
#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace boresight::recording {

/// Sixteen bytes as on the wire; IPv4 is stored as mapped address (::ffff:a.b.c.d). All zero: unspecified.
struct IpAddress {
  std::array<std::uint8_t, 16> bytes{};

  /// From an IPv4 address in host byte order; 0 gives the unspecified address.
  [[nodiscard]] static constexpr IpAddress v4(std::uint32_t host_order) {
    IpAddress address;
    if (host_order == 0) return address;
    address.bytes[10] = address.bytes[11] = 0xFF;
    for (std::size_t i = 0; i < 4; ++i) address.bytes[12 + i] = static_cast<std::uint8_t>(host_order >> (24 - 8 * i));
    return address;
  }
  [[nodiscard]] static constexpr IpAddress v6(std::span<const std::uint8_t, 16> wire) {
    IpAddress address;
    std::copy(wire.begin(), wire.end(), address.bytes.begin());
    return address;
  }
  [[nodiscard]] constexpr bool is_v4() const {
    return std::all_of(bytes.begin(), bytes.begin() + 10, [](std::uint8_t b) { return b == 0; }) && bytes[10] == 0xFF &&
           bytes[11] == 0xFF;
  }
  /// IPv4 address in host byte order; 0 for other addresses.
  [[nodiscard]] constexpr std::uint32_t to_v4() const {
    if (!is_v4()) return 0;
    return static_cast<std::uint32_t>(bytes[12]) << 24 | static_cast<std::uint32_t>(bytes[13]) << 16 |
           static_cast<std::uint32_t>(bytes[14]) << 8 | bytes[15];
  }
  [[nodiscard]] constexpr bool is_unspecified() const {
    return std::all_of(bytes.begin(), bytes.end(), [](std::uint8_t b) { return b == 0; });
  }
  [[nodiscard]] constexpr bool is_multicast() const { return is_v4() ? bytes[12] >> 4 == 0xE : bytes[0] == 0xFF; }
  friend constexpr auto operator<=>(const IpAddress&, const IpAddress&) = default;
};

/// "10.13.1.113" or "fd00::1"; nullopt if the text is neither.
[[nodiscard]] std::optional<IpAddress> parse_ip(std::string_view text);
/// The same for text that was checked before: unspecified for "" and for invalid text.
[[nodiscard]] inline IpAddress ip_or_unspecified(std::string_view text) {
  return parse_ip(text).value_or(IpAddress{});
}
/// The usual text; "" for the unspecified address.
[[nodiscard]] std::string to_text(const IpAddress& address);

/// Address and UDP port.
struct Endpoint {
  IpAddress address;
  std::uint16_t port = 0;
  friend constexpr auto operator<=>(const Endpoint&, const Endpoint&) = default;
};

}  // namespace boresight::recording
