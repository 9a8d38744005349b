// Times that may be infinite.
#pragma once

#include <cstdint>
#include <limits>

#include "services/ingest_gateway/codecs/someip/sd.hpp"

namespace boresight::ingest::someip {

inline constexpr std::int64_t kSecond_ns = 1'000'000'000;
inline constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::max();

/// `now_ns` + `duration_ns` (not negative), without overflow.
[[nodiscard]] constexpr std::int64_t after(std::int64_t now_ns, std::int64_t duration_ns) {
  return now_ns > kNever_ns - duration_ns ? kNever_ns : now_ns + duration_ns;
}

[[nodiscard]] constexpr std::int64_t expiry(std::int64_t now_ns, std::uint32_t ttl_s) {
  return ttl_s == kForever_s ? kNever_ns : after(now_ns, ttl_s * kSecond_ns);
}

}  // namespace boresight::ingest::someip
