// Inputs that services lost while a replay played, from the counters in their heartbeats.
#pragma once

#include <cstdint>
#include <map>

namespace boresight::replay {

class InputLosses {
 public:
  /// A heartbeat: `lost` counts since the start of the process, which `incarnation_ns` identifies. Losses before the
  /// first heartbeat of a service do not count.
  void see(std::uint32_t service, std::int64_t incarnation_ns, std::uint64_t lost) {
    const auto [entry, is_first] = services_.try_emplace(service, Entry{incarnation_ns, lost, 0});
    if (is_first) return;
    Entry& seen = entry->second;
    const bool restarted = seen.incarnation_ns != incarnation_ns;
    seen.sum += restarted ? lost : lost - seen.lost;
    seen.incarnation_ns = incarnation_ns;
    seen.lost = lost;
  }

  /// Services that lost inputs, and how many.
  [[nodiscard]] std::map<std::uint32_t, std::uint64_t> losses() const {
    std::map<std::uint32_t, std::uint64_t> result;
    for (const auto& [service, seen] : services_) {
      if (seen.sum > 0) result[service] = seen.sum;
    }
    return result;
  }

 private:
  struct Entry {
    std::int64_t incarnation_ns;
    std::uint64_t lost;  // of the latest heartbeat
    std::uint64_t sum;
  };
  std::map<std::uint32_t, Entry> services_;
};

}  // namespace boresight::replay
