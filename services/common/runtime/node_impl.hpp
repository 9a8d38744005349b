// Implementation of Node; for ports.cpp and node.cpp only.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <iceoryx_posh/popo/untyped_publisher.hpp>
#include <iceoryx_posh/popo/untyped_subscriber.hpp>
#include <iceoryx_posh/popo/wait_set.hpp>
#include <poll.h>

#include "services/common/runtime/newest_per_source.hpp"
#include "services/common/runtime/node.hpp"
#include "services/common/runtime/ports.hpp"
#include "services/common/runtime/progress_watch.hpp"
#include "services/common/runtime/wait_timer.hpp"
#include "services/common/runtime/writer_segments.hpp"

namespace boresight::runtime {

/// Detects losses as gaps in the sequence numbers of each writer of a topic.
class GapDetector {
 public:
  explicit GapDetector(bool several_writers) : several_writers_(several_writers) {}

  /// Messages lost before this one. A number that does not grow means a restarted writer, not a loss.
  [[nodiscard]] std::uint64_t observe(const MessageHeader& header) {
    const std::size_t slot = several_writers_ ? header.source_id % last_.size() : 0;
    const std::uint64_t number = several_writers_ ? header.source_sequence : header.sequence;
    const std::uint64_t previous = std::exchange(last_[slot], number);
    return previous == 0 || number <= previous ? 0 : number - previous - 1;
  }

 private:
  bool several_writers_;
  std::array<std::uint64_t, kMaxServices> last_{};
};

struct Input {
  Input(const catalogue::Topic& read_topic, const iox::capro::ServiceDescription& description,
        const iox::popo::SubscriberOptions& options, std::uint32_t message_version,
        std::function<void(const void*, std::uint64_t)> on_message)
      : topic(read_topic),
        port(description, options),
        queue_capacity(options.queueCapacity),
        version(message_version),
        gaps(topic.writers.size() > 1),
        handler(std::move(on_message)) {}

  const catalogue::Topic& topic;
  iox::popo::UntypedSubscriber port;
  std::uint64_t queue_capacity;
  std::uint32_t version;
  GapDetector gaps;
  std::optional<NewestPerSource> newest;  // for on_newest()
  std::function<void(const void*, std::uint64_t)> handler;
  std::uint64_t handled = 0;
  std::uint64_t refused = 0;  // of another layout version, or not in the memory of the topic's writer
  WatchedInput watched;
  WatchedOutput answers;  // for on_newest(): the outputs that follow from its messages
};

struct Timer {
  std::int64_t period_ns;
  std::int64_t next_ns;
  std::function<void()> callback;
};

struct Descriptor {
  int descriptor;
  std::function<void()> callback;
  std::uint64_t handled = 0;
  WatchedInput watched;
};

struct Node::Impl {
  explicit Impl(catalogue::Service service) : self(service) {}

  void take_all();
  bool take_one(Input& input);
  bool take_newest(Input& input);
  const MessageHeader* take_from_queue(Input& input);
  [[nodiscard]] std::optional<Fault> reason_to_refuse(const Input& input, const MessageHeader& message);
  void drop(Input& input, const MessageHeader& message);
  void handle(Input& input, const MessageHeader& message, std::uint64_t dropped);
  void run_timers();
  void wait_until(std::int64_t end_ns);
  void wait_for_descriptors(std::int64_t timeout_ns);
  [[nodiscard]] int poll_descriptors(std::int64_t timeout_ns);
  void count(std::int64_t processing_ns);
  void count_latency(std::int64_t latency_ns);
  void count_queueing(std::int64_t waited_ns);
  void heartbeat();
  void stroke_watchdog();
  void look_at_inputs();
  void look_at_outputs();
  void log_new_faults();
  [[nodiscard]] WatchedOutput& output(catalogue::TopicId topic) { return outputs[static_cast<std::size_t>(topic)]; }

  catalogue::Service self;
  WriterSegments segments;                      // as mapped on registering
  std::optional<iox::popo::WaitSet<>> waitset;  // with inputs that wake the service only, as is the timer
  std::optional<WaitTimer> wait_timer;
  std::vector<std::unique_ptr<Input>> inputs;  // in order of priority
  std::vector<Timer> timers;
  std::deque<Descriptor> descriptors;  // a callback may add one while it runs
  std::vector<pollfd> polled;          // room for all descriptors
  std::optional<Publisher<ServiceStatus>> status_port;

  std::int64_t event_begin_ns = 0;
  bool stopping = false;
  int exit_code = 0;

  ProgressWatch watch;
  std::array<WatchedOutput, catalogue::kNumberOfTopics> outputs{};
  std::array<bool, catalogue::kNumberOfTopics> is_periodic{};
  bool is_output_due = false;  // by the handler that runs
  bool is_stroke_withheld = false;

  ServiceStatus status{};
  bool degraded = false;
  double processing_sum_ns = 0.0;
  std::uint64_t processing_count = 0;
  std::int64_t processing_max_ns = 0;
  double latency_sum_ns = 0.0;
  std::uint32_t latency_count = 0;
  std::int64_t latency_max_ns = 0;
  std::int64_t queueing_max_ns = 0;
  std::array<std::uint64_t, kNumberOfFaults> logged_faults{};
  std::uint64_t logged_allocations = 0;
};

namespace detail {

struct PublisherPort {
  PublisherPort(Node& owner, const catalogue::Topic& published_topic, const iox::capro::ServiceDescription& description,
                const iox::popo::PublisherOptions& options)
      : node(owner), topic(published_topic), port(description, options) {}

  Node& node;
  const catalogue::Topic& topic;
  iox::popo::UntypedPublisher port;
  std::uint64_t sequence = 0;
  std::array<std::uint64_t, kMaxRadars + 1> source_sequence{};
};

/// iceoryx's name of a topic: (service, instance, event) = ("boresight", topic, type).
[[nodiscard]] iox::capro::ServiceDescription service_description(const catalogue::Topic& topic);

}  // namespace detail

}  // namespace boresight::runtime
