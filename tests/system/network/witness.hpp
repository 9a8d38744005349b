// A monitor on the bus that compares every scan with that of the synthetic server, and keeps the gateway's status.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "interfaces/messages/service_status.hpp"
#include "tests/system/harness/child.hpp"

namespace boresight::network {

struct SeenScan {
  std::int64_t received_ns;
  std::int64_t age_ns;  ///< reception minus time of measurement
  std::uint32_t radar;
  std::uint32_t cycle;
  std::uint32_t detections;
  std::uint16_t integrity;
  bool is_as_sent;  ///< bitwise equal
};

class Witness {
 public:
  Witness();
  /// Leaves the bus; false after a failure.
  [[nodiscard]] bool stop() { return process_->stop() == 0; }

  [[nodiscard]] std::size_t size() const { return log_->size; }
  [[nodiscard]] const SeenScan& operator[](std::size_t i) const { return log_->scans[i]; }
  /// The first scan of that radar received at or after a time; nullptr if there is none yet.
  [[nodiscard]] const SeenScan* first_since(std::int64_t time_ns, std::uint32_t radar) const;
  /// The gateway's latest status.
  [[nodiscard]] ServiceStatus status() const { return log_->statuses[log_->number_of_statuses % 2]; }
  [[nodiscard]] std::size_t number_of_statuses() const { return log_->number_of_statuses; }

 private:
  static constexpr std::size_t kMaxScans = 60'000;
  struct Log {
    volatile bool attached;
    volatile std::size_t size;
    volatile std::size_t number_of_statuses;
    std::array<SeenScan, kMaxScans> scans;
    std::array<ServiceStatus, 2> statuses;  // alternating, so that readers and writer use different ones
  };
  int watch();
  harness::Shared<Log> log_;
  std::unique_ptr<harness::Child> process_;
};

}  // namespace boresight::network
