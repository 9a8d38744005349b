// One process on the bus: its connection to RouDi, its event loop, its heartbeat. Everything runs on the main thread.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string_view>

#include "interfaces/catalogue/catalogue.hpp"
#include "interfaces/messages/service_status.hpp"
#include "services/common/runtime/ports.hpp"

namespace boresight::runtime {

/// The event loop of a service. Inputs wake a service on the data path; other services poll their inputs every 10 ms.
/// Construct it once, declare inputs and timers, then call spin().
class Node {
 public:
  /// Connects to RouDi and waits for it until a stop is requested; then throws std::runtime_error. `name_suffix`
  /// distinguishes several monitors.
  explicit Node(catalogue::Service self, std::string_view name_suffix = {});
  /// Whether RouDi can be reached now. For programs that do without the bus if it is not there.
  [[nodiscard]] static bool roudi_is_reachable();
  ~Node();
  Node(const Node&) = delete;
  Node& operator=(const Node&) = delete;

  [[nodiscard]] catalogue::Service self() const;

  /// Calls `handler(const T&)` for every message of T, in the order of arrival. Waiting messages of inputs declared
  /// earlier are handled before those declared later, so declare side inputs first. The message is read in place and
  /// valid only during the call. Messages with another layout version, or outside the memory of the topic's writer, are
  /// counted and skipped; sequence gaps are counted as Fault::kInputLost.
  template <typename T, typename Handler>
  void on(Handler handler) {
    add_input(catalogue::topic(catalogue::kTopicOf<T>), T::kVersion,
              [handler = std::move(handler)](const void* payload, std::uint64_t) {
                handler(*static_cast<const T*>(payload));
              });
  }

  /// Like on(), for a service that a scan passes on its way to the tracks. If several messages wait, only the newest of
  /// each radar is handled, in the order of their measurement. A waiting message that a newer one of its radar
  /// supersedes is dropped and counted as Fault::kInputDropped. Calls `handler(const T&, std::uint64_t dropped)`, with
  /// the number of messages of this radar that were dropped since the one handled before. The catalogue must list this
  /// service in `newest_first` of the topic, because waiting messages occupy chunks of the memory pool.
  template <typename T, typename Handler>
  void on_newest(Handler handler) {
    add_newest_input(catalogue::topic(catalogue::kTopicOf<T>), T::kVersion,
                     [handler = std::move(handler)](const void* payload, std::uint64_t dropped) {
                       handler(*static_cast<const T*>(payload), dropped);
                     });
  }

  /// Calls `callback()` every `period_ns`.
  void every(std::int64_t period_ns, std::function<void()> callback);

  /// Calls `callback()` when the descriptor is readable. A node with descriptors waits for them by poll() and
  /// checks its inputs, if any, at least every 10 ms: for the gateway, which has no inputs on the bus.
  void on_readable(int descriptor, std::function<void()> callback);
  void remove_descriptor(int descriptor);

  /// Runs until SIGTERM, SIGINT or stop(); returns the process's exit code.
  int spin();
  /// In place of spin(), for a program with a loop of its own: handles all waiting messages and due timers, returns.
  void serve();
  void stop(int exit_code = 0);
  [[nodiscard]] bool stop_requested() const;

  /// Counts a fault; the heartbeat reports and logs it. Allocation-free; `what` is cut to 127 characters.
  void fault(Fault fault, std::string_view what, std::uint64_t count = 1);
  /// For inputs other than those of on(): counts one input and its processing time.
  void count_input(std::int64_t processing_ns);
  /// For inputs other than those of on_newest(): how long one waited before it was taken, in ns. The heartbeat states
  /// the longest time.
  void count_queueing(std::int64_t waited_ns);
  /// The gateway's per-radar statistics; the entry is created on first use.
  [[nodiscard]] SourceStatistics& source_statistics(std::uint32_t source_id);
  /// For a handler of on_newest() that rightly publishes nothing, for example because the radar is unknown. Without
  /// this call the watchdog ends a service whose handlers publish nothing.
  void nothing_to_publish();
  /// The service publishes this topic with or without inputs. The watchdog ends a service that publishes none for
  /// longer than the topic's deadline.
  void publishes_periodically(catalogue::TopicId topic);
  /// A service is starting until spin(), then running. This call reports or clears the degraded state.
  void set_degraded(bool degraded);

  struct Impl;
  [[nodiscard]] Impl& impl() { return *impl_; }

 private:
  using RawHandler = std::function<void(const void* payload, std::uint64_t dropped)>;
  void add_input(const catalogue::Topic& topic, std::uint32_t version, RawHandler handler);
  void add_newest_input(const catalogue::Topic& topic, std::uint32_t version, RawHandler handler);
  std::unique_ptr<Impl> impl_;
};

}  // namespace boresight::runtime
