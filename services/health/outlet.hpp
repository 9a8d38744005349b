// Sends reports by DDS when they are due, and tries to join the domain again while that is impossible.
#pragma once

#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "services/common/runtime/node.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/health/core/faults/fault_memory.hpp"
#include "services/health/dds/diagnostics_writer.hpp"
#include "services/health/dds/fault_memory_server.hpp"
#include "services/health/dds/participant.hpp"
#include "services/health/dds/topic_publisher.hpp"

namespace boresight::health {

/// The secret of those who may command; empty if none is configured. Throws config::Error if its file cannot be used.
[[nodiscard]] dds::CommandKey command_key_of(const dds::Config& config);

/// Supervision on the ECU works without DDS. Each failure is reported as a fault of the node, and the participant is
/// created again later.
class Outlet {
 public:
  /// All references must outlive this object. `key`: the secret of those who may command.
  Outlet(runtime::Node& node, const VehicleConfig& vehicle, const dds::Config& config, FaultMemory& faults,
         dds::CommandKey key)
      : node_(node), vehicle_(vehicle), config_(config), faults_(faults), key_(std::move(key)) {}

  /// Sends if `at_once`, or if the configured period has passed since the last report.
  void write(const HealthReport& report, bool at_once, std::int64_t now_ns);
  /// Takes a TrackList, AlignmentEstimate or ServiceStatus to be passed on by serve().
  template <typename Message>
  void pass_on(const Message& message, std::int64_t now_ns) {
    if (channel_) channel_->topics.take(message, moment(now_ns));
  }
  /// Sends what was taken and what changed in the fault memory, and executes commands that were received.
  void serve(std::int64_t now_ns);
  /// At the orderly end of the service: tells the readers.
  void end();

 private:
  /// Everything that exists only with a participant.
  struct Channel {
    Channel(std::unique_ptr<dds::Participant> joined, const dds::Config& config, const VehicleConfig& vehicle,
            FaultMemory& faults, const dds::CommandKey& key)
        : participant(std::move(joined)),
          reports(*participant, vehicle),
          topics(*participant, config, vehicle),
          faults(*participant, vehicle, faults, key) {}
    std::unique_ptr<dds::Participant> participant;  // first member: it outlives its writers
    dds::DiagnosticsWriter reports;
    dds::TopicPublisher topics;
    dds::FaultMemoryServer faults;
  };

  [[nodiscard]] static dds::Now moment(std::int64_t now_ns);
  /// Compares the interfaces with those of the participant; leaves the domain if it must be joined anew. Returns what
  /// is wrong with them.
  std::string look_at_interfaces();
  /// A participant, and the end of the validity of its files in seconds since the epoch.
  struct Joined {
    std::unique_ptr<dds::Participant> participant;
    std::int64_t valid_until_s;
  };
  /// Begins to join the domain, in a thread of its own: the middleware needs more than a second on a busy machine, and
  /// supervision must not wait for it.
  void begin_to_join();
  /// If that has ended: makes the writers, or keeps the reason why it is impossible.
  void end_joining(std::int64_t now_ns);
  /// Whether new readers refuse this participant, because a certificate or its permissions have expired.
  [[nodiscard]] bool has_expired() const;
  /// `problem`: why readers cannot receive; "" if they can.
  void report_mute(const std::string& problem, std::int64_t now_ns);

  runtime::Node& node_;
  const VehicleConfig& vehicle_;
  const dds::Config& config_;
  FaultMemory& faults_;
  dds::CommandKey key_;
  std::optional<Channel> channel_;
  std::future<Joined> joining_;
  std::string obstacle_;                    ///< why the domain could not be joined; "" if it was, or not tried yet
  std::int64_t valid_until_s_ = INT64_MAX;  // since the epoch
  std::int64_t next_ns_ = 0;
  std::int64_t retry_ns_ = 0;
  std::vector<std::string> used_addresses_;  ///< of the participant, as far as they were never lost
  std::string problem_;                      ///< the latest reported
};

}  // namespace boresight::health
