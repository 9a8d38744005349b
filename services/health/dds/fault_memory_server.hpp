// The fault memory on DDS: its events as instances, and the execution of authorised commands.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "generated/fault_memory.h"
#include "services/common/vehicle/vehicle.hpp"
#include "services/health/core/faults/fault_memory.hpp"
#include "services/health/dds/authentication.hpp"
#include "services/health/dds/participant.hpp"

namespace boresight::dds {

/// Everything happens in serve(), on the caller's thread.
class FaultMemoryServer {
 public:
  /// All references must outlive this object. Throws std::runtime_error if a topic, a writer or a reader cannot be
  /// created.
  FaultMemoryServer(Participant& participant, const VehicleConfig& vehicle, health::FaultMemory& memory,
                    const CommandKey& key);
  /// Executes the commands that were received, sends replies and what changed. Returns a line for the log of each
  /// command. `now_ns` is CLOCK_MONOTONIC.
  std::vector<std::string> serve(std::int64_t now_ns);

 private:
  void publish_records();
  void publish_state();
  [[nodiscard]] std::string execute(const diagnostics::ClearCommand& command, diagnostics::CommandReply& reply);

  const VehicleConfig& vehicle_;
  health::FaultMemory& memory_;
  const CommandKey& key_;
  eprosima::fastdds::dds::DataWriter& records_;
  eprosima::fastdds::dds::DataWriter& state_;
  eprosima::fastdds::dds::DataWriter& replies_;
  eprosima::fastdds::dds::DataReader& commands_;
  Challenge challenge_;
  std::vector<bool> is_sent_;                     // of each record of the memory
  std::vector<health::EventStatus> sent_status_;  //
  std::uint64_t sent_revision_ = 0;
  bool has_sent_ = false;
  std::int64_t next_command_ns_ = 0;
};

/// "radar front_right", "service tracker", "vehicle".
[[nodiscard]] std::string subject_text(health::Event event, const VehicleConfig& vehicle);
[[nodiscard]] diagnostics::FaultRecord to_fault_record(const health::FaultRecord& record, const VehicleConfig& vehicle);

/// Trouble code that stands for all (ISO 14229-1, service 0x14).
inline constexpr std::uint32_t kAllDtcs = 0xFFFFFF;

}  // namespace boresight::dds
