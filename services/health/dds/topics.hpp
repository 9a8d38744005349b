// The topics off the ECU on one page: name, depth and quality of service of each. Writers and readers are made from
// this table, and services/health/README.md shows it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "interfaces/catalogue/catalogue.hpp"
#include "services/health/core/faults/event.hpp"

namespace boresight::dds {

/// Whether a sample that was lost on the network is sent again.
enum class Reliability : std::uint8_t { kReliable, kBestEffort };

/// What a reader gets that joins late: the samples that the writer keeps, or only new ones.
enum class Durability : std::uint8_t { kTransientLocal, kVolatile };

/// Quality of service of a topic. The times are multiples of its period; 0: none is offered or requested.
struct TopicQos {
  const char* name;
  int written_depth;         ///< samples of each instance that a writer keeps
  int read_depth;            ///< samples of each instance that wait in a reader of ours
  int most_instances;        ///< of a writer or reader; further ones are refused
  std::uint32_t most_bytes;  ///< a reader of ours refuses a larger sample
  Reliability reliability = Reliability::kReliable;
  Durability durability = Durability::kTransientLocal;
  double period_s = 0.0;  ///< nominal, of each instance; 0: `dds.period_s`. Without meaning if all times are 0.
  /// Longest time between two samples of an instance, as offered by the writer.
  double deadline_periods = 0.0;
  /// Time without a sign of life after which the writer counts as dead, as offered. The middleware gives the signs.
  double lease_periods = 0.0;
  /// Time after which a sample is no longer given to a reader that joins late.
  double lifespan_periods = 0.0;
  /// Deadline and lease that readers of ours request. At least what is offered: a reader that requests less gets
  /// nothing.
  double requested_periods = 0.0;
};

/// A topic that is sent in each period, and at once when a verdict changes. The times are a choice. One and a half
/// periods tolerate a sender that is late by half a period. A reader that requests two periods matches.
[[nodiscard]] constexpr TopicQos periodic(const char* name, int read_depth, int most_instances,
                                          std::uint32_t most_bytes) {
  return {.name = name,
          .written_depth = 1,
          .read_depth = read_depth,
          .most_instances = most_instances,
          .most_bytes = most_bytes,
          .deadline_periods = 1.5,
          .lease_periods = 1.5,
          .lifespan_periods = 3.0,
          .requested_periods = 1.75};
}

/// A topic that is sent when something changes has no period.
[[nodiscard]] constexpr TopicQos on_change(const char* name, int written_depth, int read_depth, int most_instances,
                                           std::uint32_t most_bytes, Durability durability) {
  return {.name = name,
          .written_depth = written_depth,
          .read_depth = read_depth,
          .most_instances = most_instances,
          .most_bytes = most_bytes,
          .durability = durability};
}

inline constexpr std::uint32_t kKibibyte = 1024;
/// Events of a vehicle with all radars and services; no kind has more subjects than that.
inline constexpr int kMostEvents =
    static_cast<int>(health::kNumberOfEventKinds * std::max(kMaxRadars, catalogue::kNumberOfServices));
/// Vehicles on one domain.
inline constexpr int kMostVehicles = 4;

inline constexpr TopicQos kSensorHealthTopic = periodic("boresight/sensor_health", 1, kMaxRadars, 16 * kKibibyte);
inline constexpr TopicQos kSystemHealthTopic = periodic("boresight/system_health", 1, kMostVehicles, 8 * kKibibyte);
// Written by every program of a ROS system.
inline constexpr TopicQos kDiagnosticsTopic = periodic("rt/diagnostics", 10, 1, 256 * kKibibyte);
inline constexpr TopicQos kFaultRecordTopic =
    on_change("boresight/fault_memory", 1, 1, kMostEvents, 8 * kKibibyte, Durability::kTransientLocal);
inline constexpr TopicQos kFaultMemoryStateTopic =
    on_change("boresight/fault_memory_state", 1, 1, 1, 4 * kKibibyte, Durability::kTransientLocal);
inline constexpr TopicQos kCommandTopic =
    on_change("boresight/fault_memory_command", 1, 4, 1, kKibibyte, Durability::kVolatile);
inline constexpr TopicQos kCommandReplyTopic =
    on_change("boresight/fault_memory_reply", 4, 16, 1, kKibibyte, Durability::kTransientLocal);

/// Lists replace one another, and come only while scans do: no deadline. The lifespan is that of `track_list` in the
/// catalogue: positions of earlier lists are of no use. The lease of 1.5 s is a choice, as in periodic().
inline constexpr TopicQos kTrackListTopic{.name = "boresight/track_list",
                                          .written_depth = 1,
                                          .read_depth = 1,
                                          .most_instances = kMostVehicles,
                                          .most_bytes = 48 * kKibibyte,
                                          .reliability = Reliability::kBestEffort,
                                          .durability = Durability::kVolatile,
                                          .period_s = 0.25,
                                          .lease_periods = 6.0,
                                          .lifespan_periods = 1.0};
/// Estimates come only while scans do: no deadline. The latest one stays of use.
inline constexpr TopicQos kAlignmentTopic{.name = "boresight/alignment_estimate",
                                          .written_depth = 1,
                                          .read_depth = 1,
                                          .most_instances = kMaxRadars,
                                          .most_bytes = 4 * kKibibyte,
                                          .lease_periods = 1.5};
inline constexpr TopicQos kServiceStatusTopic = periodic("boresight/service_status", 1, kMaxServices, 8 * kKibibyte);

/// All of them.
inline constexpr std::array kTopics = {
    kSensorHealthTopic, kSystemHealthTopic, kDiagnosticsTopic, kFaultRecordTopic, kFaultMemoryStateTopic,
    kCommandTopic,      kCommandReplyTopic, kTrackListTopic,   kAlignmentTopic,   kServiceStatusTopic};

namespace detail {
constexpr bool requests_match_offers() {
  for (const TopicQos& topic : kTopics) {
    if (topic.requested_periods <= 0.0) continue;  // anything is good enough
    if (topic.requested_periods < topic.deadline_periods || topic.requested_periods < topic.lease_periods) return false;
  }
  return true;
}
}  // namespace detail
static_assert(detail::requests_match_offers(), "a reader that requests less than is offered gets nothing");

}  // namespace boresight::dds
