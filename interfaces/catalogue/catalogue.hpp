// The whole system on one page: each topic with its writers, readers, period, deadline and queue depth. Ports, RouDi's
// memory pools, health supervision and the diagram in the documentation are derived from this table.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "interfaces/messages/alignment_estimate.hpp"
#include "interfaces/messages/classified_scan.hpp"
#include "interfaces/messages/corrected_scan.hpp"
#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/messages/health_report.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "interfaces/messages/service_status.hpp"
#include "interfaces/messages/track_list.hpp"

namespace boresight::catalogue {

/// Every process of the system. The value is the service's index in messages and reports.
enum class Service : std::uint8_t {
  kIngestGateway = 0,
  kAlignmentEstimator = 1,
  kDetectionCorrector = 2,
  kGhostFilter = 3,
  kTracker = 4,
  kHealth = 5,
  kMonitor = 6,  ///< `boresight monitor`, tests, recorders: reads everything, writes nothing, may be absent
  kReplay = 7,   ///< `boresight-replay --speed max`: waits for the track list of each scan, may be absent
};
inline constexpr std::size_t kNumberOfServices = 8;
/// Supervised services: all except the optional monitor and replay.
inline constexpr std::size_t kNumberOfSupervisedServices = 6;
static_assert(kNumberOfServices <= kMaxServices);

/// Names as in binaries (`boresight-<name>`), directories under services/, configuration files and log lines.
inline constexpr std::array<std::string_view, kNumberOfServices> kServiceNames = {
    "ingest_gateway", "alignment_estimator", "detection_corrector", "ghost_filter", "tracker", "health", "monitor",
    "replay"};

[[nodiscard]] constexpr std::string_view name_of(Service service) {
  return kServiceNames[static_cast<std::size_t>(service)];
}

/// True for services that a scan passes before it updates the tracks. The others get less processor time if it is
/// short.
[[nodiscard]] constexpr bool is_on_data_path(Service service) {
  return service == Service::kIngestGateway || service == Service::kDetectionCorrector ||
         service == Service::kGhostFilter || service == Service::kTracker;
}

/// A set of services, as a bit mask.
class ServiceSet {
 public:
  template <typename... Services>
  constexpr explicit ServiceSet(Services... services) : bits_((0u | ... | bit(services))) {}
  [[nodiscard]] constexpr bool contains(Service service) const { return (bits_ & bit(service)) != 0; }
  [[nodiscard]] constexpr std::size_t size() const {
    std::size_t count = 0;
    for (std::size_t i = 0; i < kNumberOfServices; ++i) count += (bits_ >> i) & 1u;
    return count;
  }

 private:
  [[nodiscard]] static constexpr std::uint32_t bit(Service s) { return 1u << static_cast<unsigned>(s); }
  std::uint32_t bits_;
};

inline constexpr std::int64_t kMillisecond_ns = 1'000'000;

enum class TopicId : std::uint8_t {
  kRadarScan,
  kEgoMotion,
  kAlignmentEstimate,
  kCorrectedScan,
  kClassifiedScan,
  kTrackList,
  kHealthReport,
  kServiceStatus,
};
inline constexpr std::size_t kNumberOfTopics = 8;

/// One topic. Periods and deadlines are per source (per radar where `per_radar`); a radar's own cycle time in the
/// vehicle file takes precedence over `period_ns` for the topics that carry its scans.
struct Topic {
  TopicId id;
  std::string_view name;
  std::string_view type;
  std::size_t payload_bytes;
  ServiceSet writers;
  ServiceSet readers;
  bool per_radar;             ///< one message per radar and period, otherwise one per writer and period
  std::int64_t period_ns;     ///< nominal
  std::int64_t deadline_ns;   ///< a source that is silent for longer is late
  std::uint32_t queue_depth;  ///< messages per source that a reader's queue holds; the oldest is discarded
  std::uint32_t history;      ///< messages that a late reader gets on subscribing (iceoryx: at most 16 per writer)
  /// Readers that handle only the newest of the scans of a radar that wait.
  ServiceSet newest_first = ServiceSet();
};

using enum Service;

inline constexpr std::array<Topic, kNumberOfTopics> kTopics = {{
    {.id = TopicId::kRadarScan,
     .name = "radar_scan",
     .type = "RadarScan",
     .payload_bytes = sizeof(RadarScan),
     .writers = ServiceSet(kIngestGateway),
     .readers = ServiceSet(kAlignmentEstimator, kDetectionCorrector, kHealth, kMonitor, kReplay),
     .per_radar = true,
     .period_ns = 50 * kMillisecond_ns,
     .deadline_ns = 250 * kMillisecond_ns,
     .queue_depth = 4,
     .history = 0,
     .newest_first = ServiceSet(kDetectionCorrector)},
    {.id = TopicId::kEgoMotion,
     .name = "ego_motion",
     .type = "EgoMotion",
     .payload_bytes = sizeof(EgoMotion),
     .writers = ServiceSet(kIngestGateway),
     .readers = ServiceSet(kAlignmentEstimator, kDetectionCorrector, kHealth, kMonitor),
     .per_radar = false,
     .period_ns = 10 * kMillisecond_ns,
     .deadline_ns = 200 * kMillisecond_ns,
     .queue_depth = 64,
     .history = 1},
    {.id = TopicId::kAlignmentEstimate,
     .name = "alignment_estimate",
     .type = "AlignmentEstimate",
     .payload_bytes = sizeof(AlignmentEstimate),
     .writers = ServiceSet(kAlignmentEstimator),
     .readers = ServiceSet(kDetectionCorrector, kHealth, kMonitor),
     .per_radar = true,
     .period_ns = 200 * kMillisecond_ns,
     .deadline_ns = 2000 * kMillisecond_ns,
     .queue_depth = 4,
     .history = 16},
    {.id = TopicId::kCorrectedScan,
     .name = "corrected_scan",
     .type = "CorrectedScan",
     .payload_bytes = sizeof(CorrectedScan),
     .writers = ServiceSet(kDetectionCorrector),
     .readers = ServiceSet(kGhostFilter, kMonitor),
     .per_radar = true,
     .period_ns = 50 * kMillisecond_ns,
     .deadline_ns = 250 * kMillisecond_ns,
     .queue_depth = 4,
     .history = 0,
     .newest_first = ServiceSet(kGhostFilter)},
    {.id = TopicId::kClassifiedScan,
     .name = "classified_scan",
     .type = "ClassifiedScan",
     .payload_bytes = sizeof(ClassifiedScan),
     .writers = ServiceSet(kGhostFilter),
     .readers = ServiceSet(kTracker, kMonitor),
     .per_radar = true,
     .period_ns = 50 * kMillisecond_ns,
     .deadline_ns = 250 * kMillisecond_ns,
     .queue_depth = 4,
     .history = 0,
     .newest_first = ServiceSet(kTracker)},
    {.id = TopicId::kTrackList,
     .name = "track_list",
     .type = "TrackList",
     .payload_bytes = sizeof(TrackList),
     .writers = ServiceSet(kTracker),
     .readers = ServiceSet(kGhostFilter, kHealth, kMonitor, kReplay),
     .per_radar = true,
     .period_ns = 50 * kMillisecond_ns,
     .deadline_ns = 250 * kMillisecond_ns,
     .queue_depth = 4,
     .history = 0},
    {.id = TopicId::kHealthReport,
     .name = "health_report",
     .type = "HealthReport",
     .payload_bytes = sizeof(HealthReport),
     .writers = ServiceSet(kHealth),
     .readers = ServiceSet(kMonitor),
     .per_radar = false,
     .period_ns = 100 * kMillisecond_ns,
     .deadline_ns = 500 * kMillisecond_ns,
     .queue_depth = 4,
     .history = 1},
    {.id = TopicId::kServiceStatus,
     .name = "service_status",
     .type = "ServiceStatus",
     .payload_bytes = sizeof(ServiceStatus),
     .writers = ServiceSet(kIngestGateway, kAlignmentEstimator, kDetectionCorrector, kGhostFilter, kTracker, kHealth),
     .readers = ServiceSet(kHealth, kMonitor, kReplay),
     .per_radar = false,
     .period_ns = 100 * kMillisecond_ns,
     .deadline_ns = 500 * kMillisecond_ns,
     .queue_depth = 4,
     .history = 1},
}};

[[nodiscard]] constexpr const Topic& topic(TopicId id) {
  return kTopics[static_cast<std::size_t>(id)];
}

/// Number of monitors that may read at the same time (live view, recorder, test).
inline constexpr std::size_t kMaxMonitors = 3;

/// Number of sources of one reader of the topic: radars, or writing services.
[[nodiscard]] constexpr std::size_t sources_of(const Topic& t) {
  return t.per_radar ? kMaxRadars : t.writers.size();
}

/// Length of one reader's queue; iceoryx allows 256.
[[nodiscard]] constexpr std::size_t queue_capacity(const Topic& t) {
  const std::size_t wanted = t.queue_depth * sources_of(t);
  return wanted < 256 ? wanted : 256;
}

/// Messages that all such readers of the topic may hold beside their queues: the one that is handled, and where only
/// the newest are handled, one of each source that waits.
[[nodiscard]] constexpr std::size_t held_messages(const Topic& t, std::size_t readers) {
  return readers + t.newest_first.size() * sources_of(t);
}

/// The topic that carries messages of type T.
template <typename T>
inline constexpr TopicId kTopicOf = [] { static_assert(sizeof(T) == 0, "no topic carries this type"); }();
template <>
inline constexpr TopicId kTopicOf<RadarScan> = TopicId::kRadarScan;
template <>
inline constexpr TopicId kTopicOf<EgoMotion> = TopicId::kEgoMotion;
template <>
inline constexpr TopicId kTopicOf<AlignmentEstimate> = TopicId::kAlignmentEstimate;
template <>
inline constexpr TopicId kTopicOf<CorrectedScan> = TopicId::kCorrectedScan;
template <>
inline constexpr TopicId kTopicOf<ClassifiedScan> = TopicId::kClassifiedScan;
template <>
inline constexpr TopicId kTopicOf<TrackList> = TopicId::kTrackList;
template <>
inline constexpr TopicId kTopicOf<HealthReport> = TopicId::kHealthReport;
template <>
inline constexpr TopicId kTopicOf<ServiceStatus> = TopicId::kServiceStatus;

namespace detail {
constexpr bool topics_are_in_order() {
  for (std::size_t i = 0; i < kNumberOfTopics; ++i) {
    if (static_cast<std::size_t>(kTopics[i].id) != i) return false;
  }
  return true;
}
}  // namespace detail
static_assert(detail::topics_are_in_order(), "topic(id) indexes kTopics by the id's value");

}  // namespace boresight::catalogue
