// Records the gateway's output in a process that is not on the data path.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "interfaces/messages/service_status.hpp"
#include "tests/system/harness/child.hpp"

namespace boresight::bench {

struct LoggedScan {
  std::uint32_t radar;
  std::uint16_t integrity;
  TimeSource time_source;
  std::int64_t measured_ns;  ///< time stamp of the radar, whose clock is this machine's
  std::int64_t taken_ns;     ///< the gateway received the last datagram
  std::int64_t published_ns;
};

class ScanLog {
 public:
  ScanLog();

  [[nodiscard]] bool is_attached() const { return log_->attached; }
  [[nodiscard]] std::size_t size() const { return log_->size; }
  [[nodiscard]] const LoggedScan& operator[](std::size_t i) const { return log_->scans[i]; }
  /// Latest status of the gateway; `pid` is 0 before the first one.
  [[nodiscard]] const ServiceStatus& gateway() const { return log_->gateway; }

 private:
  static constexpr std::size_t kMaxScans = 500'000;
  struct Log {
    volatile bool attached;
    volatile std::size_t size;
    ServiceStatus gateway;
    std::array<LoggedScan, kMaxScans> scans;
  };
  int observe();

  harness::Shared<Log> log_;
  std::unique_ptr<harness::Child> process_;
};

}  // namespace boresight::bench
