// Heartbeat of one service, with counters of its inputs, outputs and faults.
#pragma once

#include "interfaces/messages/header.hpp"

namespace boresight {

enum class ServiceState : std::uint8_t { kStarting = 0, kRunning = 1, kDegraded = 2, kStopping = 3 };

/// Kinds of faults; each has a counter in `ServiceStatus::faults`.
enum class Fault : std::uint8_t {
  kInputLost = 0,         ///< sequence gaps: the queue overflowed, as the service was too slow
  kLoanFailed = 1,        ///< the memory pool was exhausted, so that an output was not sent
  kWireLength = 2,        ///< frame or datagram with a wrong length
  kWireValue = 3,         ///< field out of its range, bad checksum
  kWireUnknown = 4,       ///< unknown message on a configured link
  kRecordingSyntax = 5,   ///< unreadable line or block of a recording
  kSideInputMissing = 6,  ///< a scan was processed without one of its side inputs
  kTimeJump = 7,          ///< a clock jumped, or went back
  kVersionMismatch = 8,   ///< a message with another layout version
  kCapacity = 9,          ///< detections, clusters or tracks beyond capacity
  kLink = 10,             ///< socket error, interface down, kernel drops
  kInputDropped = 11,     ///< a waiting scan was superseded by a newer one of its radar: the service was too slow
  kWorkBudget = 12,       ///< the work on a scan ended before it was complete, to be in time
  kForeignMemory = 13,    ///< a message that does not lie in the memory of its topic's writer: refused
};
inline constexpr std::size_t kNumberOfFaults = 14;

/// A sensor's self-diagnosis in its status messages.
namespace source_condition {
inline constexpr std::uint32_t kBlocked = 1u << 0;           ///< blind or nearly blind
inline constexpr std::uint32_t kPartlyBlocked = 1u << 1;     ///< reduced performance, for example by dirt
inline constexpr std::uint32_t kDefective = 1u << 2;         ///< failed its self-test, or not in operation
inline constexpr std::uint32_t kSupply = 1u << 3;            ///< voltage out of range
inline constexpr std::uint32_t kTemperature = 1u << 4;       ///< temperature out of range
inline constexpr std::uint32_t kUnsynchronised = 1u << 5;    ///< its clock is not synchronised to another one
inline constexpr std::uint32_t kWithoutEgoMotion = 1u << 6;  ///< it lacks the vehicle's motion as input
/// The sensor has reported its self-diagnosis since the gateway's start. Without this bit the others say nothing.
inline constexpr std::uint32_t kReported = 1u << 31;
}  // namespace source_condition

/// Statistics of one radar as the writer of this status saw it; only the gateway fills them.
struct SourceStatistics {
  std::uint32_t source_id;     ///< 0: unused entry
  std::uint32_t conditions;    ///< source_condition bits, as last reported by the sensor
  std::uint64_t messages;      ///< scans published
  std::uint64_t rejected;      ///< rejected frames, lists and cycles
  std::uint64_t lost;          ///< scans sent according to the sensor's counter, but not received
  std::uint64_t suspect;       ///< scans published with an integrity fault other than a counter gap
  std::uint64_t e2e_lost;      ///< messages missing by the end-to-end counter
  std::uint64_t e2e_repeated;  ///< messages with the same end-to-end counter as the previous one
  std::uint64_t e2e_wrong;     ///< messages whose end-to-end CRC, length, Data ID or sequence is wrong
  std::int64_t last_measurement_time_ns;
};
static_assert(sizeof(SourceStatistics) == 72);

/// Published by every service each heartbeat period. Counters never decrease while a process lives. `incarnation_ns`
/// is its start time, so that a change shows a restart.
struct ServiceStatus {
  static constexpr std::uint32_t kVersion = 5;

  MessageHeader header;  ///< source_id is the service's index in the catalogue
  std::int64_t incarnation_ns;
  std::int32_t pid;
  ServiceState state;
  std::array<std::uint8_t, 3> reserved;
  std::uint64_t inputs;
  std::uint64_t outputs;
  std::uint64_t heap_allocations;  ///< on the main thread's data path since warm-up; 0 without a fault
  float processing_mean_us;        ///< of one input, since the last heartbeat
  float processing_max_us;
  /// From the arrival of a scan at the gateway (begin of Stage::kIngest) to the end of this stage, of the outputs since
  /// the last heartbeat. 0 without outputs, and of services that are no stage.
  float latency_mean_us;
  float latency_max_us;
  std::uint32_t latency_count;  ///< outputs in these figures
  float queueing_max_us;        ///< longest time between the end of the stage before and the begin of this one
  std::array<std::uint64_t, kNumberOfFaults> faults;
  std::array<SourceStatistics, kMaxRadars> sources;
  std::array<char, 128> last_fault;  ///< description of the latest rejected input, zero-terminated; empty if none
};

static_assert(kIsPlainMessage<ServiceStatus>);
static_assert(sizeof(ServiceStatus) == 104 + 8 + 8 + 24 + 8 + 16 + kNumberOfFaults * 8 + kMaxRadars * 72 + 128);

}  // namespace boresight
