// Messages of the ECU out by DDS: tracks on boresight/track_list, alignment on boresight/alignment_estimate, heartbeats
// with their verdicts on boresight/service_status.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>

#include "interfaces/messages/alignment_estimate.hpp"
#include "interfaces/messages/health_report.hpp"
#include "interfaces/messages/service_status.hpp"
#include "interfaces/messages/track_list.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/health/dds/pace.hpp"
#include "services/health/dds/participant.hpp"

namespace boresight::dds {

/// One moment on both clocks.
struct Now {
  std::int64_t monotonic_ns;
  std::int64_t epoch_ns;
};

/// take() keeps what is due, without allocation or lock; send() and write() give it to the middleware. They return
/// false if it did not take a sample, and wait for no reader.
class TopicPublisher {
 public:
  /// Throws std::runtime_error if a topic or a writer cannot be created. `participant` must outlive this object.
  TopicPublisher(Participant& participant, const Config& config, const VehicleConfig& vehicle);
  ~TopicPublisher();

  /// The list is due if tracks are configured and the period of lists has passed. If too many wait, the oldest goes.
  void take(const TrackList& list, Now now);
  /// The estimate is due if the period has passed, or if state, wrong input, drift or a sudden change differ from what
  /// was taken.
  void take(const AlignmentEstimate& estimate, Now now);
  /// The heartbeat is for the next report. It is due at once if the process or its state is another one.
  void take(const ServiceStatus& status, Now now);
  /// Sends what is due; track lists only if somebody reads them.
  bool send();
  /// Sends the status of each service.
  bool write(const HealthReport& report, Now now);
  /// At the orderly end: readers see that the services are no longer observed.
  void end();

 private:
  struct Samples;
  /// What is sent at once when it changes.
  struct AlignmentEvent {
    AlignmentState state;
    AlignmentFinding finding;
    bool is_drifting;
    std::uint32_t step_changes;
    std::uint32_t load_changes;
    std::uint32_t speed_changes;
    bool operator==(const AlignmentEvent&) const = default;
  };
  struct Radar {
    Pace pace;
    std::optional<AlignmentEvent> taken;
    AlignmentEstimate estimate{};
    Now at{};
    bool is_due = false;
  };
  struct Service {
    ServiceHealth health{};
    ServiceStatus status{};
    bool has_health = false;
    bool has_status = false;
    Now at{};
    bool is_due = false;
  };
  struct List {
    TrackList list{};
    Now at{};
  };

  bool write_service(const Service& service, Now now);
  bool write_lists();

  VehicleConfig vehicle_;
  std::unique_ptr<Samples> samples_;  ///< used again and again, so that their memory stays
  Pace track_pace_;
  /// Lists that wait: one of each radar between two calls of send() leaves room.
  std::unique_ptr<std::array<List, kMaxRadars>> lists_ = std::make_unique<std::array<List, kMaxRadars>>();
  std::size_t first_list_ = 0, waiting_lists_ = 0;
  std::array<Radar, kMaxRadars + 1> radars_;  ///< by id
  std::array<Service, kMaxServices> services_;
  eprosima::fastdds::dds::DataWriter* tracks_;  ///< null if tracks are not configured
  eprosima::fastdds::dds::DataWriter& alignment_;
  eprosima::fastdds::dds::DataWriter& service_status_;
};

}  // namespace boresight::dds
