#include "services/ingest_gateway/core/sd_peers.hpp"

namespace boresight::ingest::someip {

namespace {

constexpr std::int64_t kNetworkCopy_ns = 10'000'000;

}  // namespace

bool RebootDetector::take(bool by_multicast, std::uint16_t session, bool reboot_flag, std::int64_t now_ns) {
  Last& last = last_[by_multicast ? 1 : 0];
  const Last before = last;
  last = {true, reboot_flag, session, now_ns};
  if (!before.known || !reboot_flag) return false;
  const bool is_copy =
      before.reboot_flag && session == before.session && now_ns - before.received_ns <= kNetworkCopy_ns;
  if (is_copy || (before.reboot_flag && session > before.session)) return false;
  last_[by_multicast ? 0 : 1] = {};
  return true;
}

}  // namespace boresight::ingest::someip
