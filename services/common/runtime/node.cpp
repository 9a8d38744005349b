#include "services/common/runtime/node.hpp"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <thread>

#include <iceoryx_hoofs/error_handling/error_handling.hpp>
#include <iceoryx_hoofs/log/logmanager.hpp>
#include <iceoryx_posh/runtime/posh_runtime.hpp>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/exit_codes.hpp"
#include "services/common/runtime/log.hpp"
#include "services/common/runtime/node_impl.hpp"
#include "services/common/runtime/queueing.hpp"
#include "services/common/runtime/stop_signal.hpp"
#include "services/common/runtime/systemd.hpp"

namespace boresight::runtime {

namespace {

// Inputs of one kind that may allocate during warm-up: buffers and caches are created at first use.
constexpr std::uint64_t kWarmUpInputs = 20;
// A longer sleep would delay the reaction to SIGTERM, as the middleware may hide the interruption.
constexpr std::int64_t kLongestWait_ns = 50'000'000;
constexpr std::int64_t kInputPollPeriod_ns = 10'000'000;

/// Debian's iceoryx aborts on severe errors. Here, callers count recoverable errors (a failed loan). Any other error
/// ends the process with a log line and an exit code, and the supervisor restarts it.
void install_error_handler() {
  static auto handler =
      iox::HandlerFunction([](const iox::Error error, const std::function<void()>&, const iox::ErrorLevel level) {
        const char* const name = iox::ErrorHandler::toString(error);
        if (level == iox::ErrorLevel::MODERATE) {
          log::debug("middleware: {}", name);
          return;
        }
        log::error("unrecoverable error of the middleware: {}", name);
        log::flush();
        std::_Exit(exit_code::kMiddleware);
      });
  static auto guard = iox::ErrorHandler::setTemporaryErrorHandler(handler);
}

/// True if RouDi accepts datagrams at its socket, which it does as soon as it can register applications.
bool roudi_accepts_datagrams() {
  const int descriptor = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (descriptor < 0) return false;
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  const std::string path = std::string(iox::platform::IOX_UDS_SOCKET_PATH_PREFIX) + iox::roudi::IPC_CHANNEL_ROUDI_NAME;
  std::strncpy(address.sun_path, path.c_str(), sizeof(address.sun_path) - 1);
  const bool reachable = connect(descriptor, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0;
  close(descriptor);
  return reachable;
}

/// Waits for RouDi, so that a service may start first. iceoryx itself aborts after a minute without RouDi.
void wait_for_roudi() {
  bool is_logged = false;
  while (!roudi_accepts_datagrams()) {
    if (stop_signalled()) throw std::runtime_error("stopped while waiting for RouDi");
    if (!is_logged) log::info("waiting for RouDi");
    is_logged = true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

/// The segments of shared memory that iceoryx mapped into this process.
WriterSegments mapped_segments() {
  std::ifstream maps("/proc/self/maps");
  return WriterSegments(std::string(std::istreambuf_iterator<char>(maps), {}));
}

/// Lowers the priority of services outside the data path. A scan wakes the corrector and all other readers at the same
/// time; on few cores the scan would wait for the other readers. Needs no privilege. If a unit's system call filter
/// forbids it, the unit sets `Nice=`.
void give_way_to_data_path(catalogue::Service self) {
  constexpr int kNice = 5;
  if (!catalogue::is_on_data_path(self)) static_cast<void>(setpriority(PRIO_PROCESS, 0, kNice));
}

}  // namespace

Node::Node(catalogue::Service self, std::string_view name_suffix) : impl_(std::make_unique<Impl>(self)) {
  install_stop_signals();
  install_error_handler();
  give_way_to_data_path(self);
  iox::log::LogManager::GetLogManager().SetDefaultLogLevel(iox::log::LogLevel::kError,
                                                           iox::log::LogLevelOutput::kHideLogLevel);
  wait_for_roudi();
  const std::string name = "boresight-" + std::string(catalogue::name_of(self)) + std::string(name_suffix);
  iox::runtime::PoshRuntime::initRuntime(iox::RuntimeName_t(iox::cxx::TruncateToCapacity, name.c_str(), name.size()));
  impl_->segments = mapped_segments();
  impl_->status.incarnation_ns = monotonic_now_ns();
  impl_->status.pid = getpid();
  impl_->status.state = ServiceState::kStarting;
  const catalogue::Topic& status_topic = catalogue::topic(catalogue::TopicId::kServiceStatus);
  if (status_topic.writers.contains(self)) {
    impl_->status_port.emplace(*this);
    every(status_topic.period_ns, [this] { impl_->heartbeat(); });
    impl_->heartbeat();
  }
}

Node::~Node() = default;

bool Node::roudi_is_reachable() {
  return roudi_accepts_datagrams();
}

catalogue::Service Node::self() const {
  return impl_->self;
}

void Node::add_input(const catalogue::Topic& topic, std::uint32_t version, RawHandler handler) {
  if (!topic.readers.contains(impl_->self)) {
    throw std::logic_error(std::string(catalogue::name_of(impl_->self)) + " is not a reader of " +
                           std::string(topic.name) + " in the catalogue");
  }
  iox::popo::SubscriberOptions options;
  options.queueCapacity = catalogue::queue_capacity(topic);
  options.historyRequest = topic.history;
  options.queueFullPolicy = iox::popo::QueueFullPolicy::DISCARD_OLDEST_DATA;
  impl_->inputs.push_back(
      std::make_unique<Input>(topic, detail::service_description(topic), options, version, std::move(handler)));
  // A service outside the data path polls its queues. Waking it would cost every writer a system call per message, and
  // the scan would compete with the other readers for a core.
  if (!catalogue::is_on_data_path(impl_->self)) return;
  if (!impl_->waitset) {
    impl_->waitset.emplace();
    impl_->wait_timer.emplace(*impl_->waitset);
  }
  impl_->waitset->attachState(impl_->inputs.back()->port, iox::popo::SubscriberState::HAS_DATA).or_else([](auto) {
    throw std::logic_error("too many inputs for one node");
  });
}

void Node::add_newest_input(const catalogue::Topic& topic, std::uint32_t version, RawHandler handler) {
  if (!topic.newest_first.contains(impl_->self)) {
    throw std::logic_error(std::string(catalogue::name_of(impl_->self)) + " is not in newest_first of " +
                           std::string(topic.name) + " in the catalogue");
  }
  add_input(topic, version, std::move(handler));
  impl_->inputs.back()->newest.emplace();
}

void Node::every(std::int64_t period_ns, std::function<void()> callback) {
  impl_->timers.push_back({period_ns, monotonic_now_ns() + period_ns, std::move(callback)});
}

void Node::on_readable(int descriptor, std::function<void()> callback) {
  impl_->descriptors.push_back({.descriptor = descriptor, .callback = std::move(callback), .watched = {}});
  if (impl_->polled.size() < impl_->descriptors.size()) impl_->polled.resize(impl_->descriptors.size());
}

void Node::remove_descriptor(int descriptor) {
  // Only marked here: the running callback may be the one to be removed.
  for (Descriptor& entry : impl_->descriptors) {
    if (entry.descriptor == descriptor) entry.descriptor = -1;
  }
}

int Node::spin() {
  if (impl_->status.state == ServiceState::kStarting) impl_->status.state = ServiceState::kRunning;
  impl_->heartbeat();
  systemd::notify_ready();
  while (!stop_requested()) {
    std::int64_t end_ns = monotonic_now_ns() + kLongestWait_ns;
    for (const Timer& timer : impl_->timers) end_ns = std::min(end_ns, timer.next_ns);
    impl_->wait_until(end_ns);
    impl_->take_all();
    impl_->run_timers();
  }
  systemd::notify_stopping();
  impl_->status.state = ServiceState::kStopping;
  impl_->heartbeat();
  return impl_->exit_code;
}

void Node::serve() {
  impl_->take_all();
  impl_->run_timers();
}

void Node::stop(int exit_code) {
  impl_->stopping = true;
  impl_->exit_code = exit_code;
}

bool Node::stop_requested() const {
  return impl_->stopping || stop_signalled();
}

void Node::fault(Fault fault, std::string_view what, std::uint64_t count) {
  impl_->status.faults[static_cast<std::size_t>(fault)] += count;
  auto& text = impl_->status.last_fault;
  const std::size_t length = std::min(what.size(), text.size() - 1);
  std::copy_n(what.data(), length, text.data());
  std::fill(text.begin() + static_cast<std::ptrdiff_t>(length), text.end(), '\0');
}

void Node::count_input(std::int64_t processing_ns) {
  impl_->count(processing_ns);
}

void Node::count_queueing(std::int64_t waited_ns) {
  impl_->count_queueing(waited_ns);
}

SourceStatistics& Node::source_statistics(std::uint32_t source_id) {
  auto& sources = impl_->status.sources;
  const auto found = std::find_if(sources.begin(), sources.end(), [source_id](const SourceStatistics& s) {
    return s.source_id == source_id || s.source_id == 0;
  });
  SourceStatistics& entry = found == sources.end() ? sources.back() : *found;
  entry.source_id = source_id;
  return entry;
}

void Node::nothing_to_publish() {
  impl_->is_output_due = false;
}

void Node::publishes_periodically(catalogue::TopicId topic) {
  impl_->is_periodic[static_cast<std::size_t>(topic)] = true;
}

void Node::set_degraded(bool degraded) {
  impl_->degraded = degraded;
}

/// Why a message is refused: another process than the topic's writer wrote it, or it has another layout version.
std::optional<Fault> Node::Impl::reason_to_refuse(const Input& input, const MessageHeader& message) {
  if (!segments.accept(input.topic, message)) {
    std::snprintf(status.last_fault.data(), status.last_fault.size(), "%.*s refused: not in the memory of its writer",
                  static_cast<int>(input.topic.name.size()), input.topic.name.data());
    return Fault::kForeignMemory;
  }
  if (message.version != input.version) return Fault::kVersionMismatch;
  return std::nullopt;
}

/// The next acceptable message, whose loss or arrival is counted; nullptr if none waits.
const MessageHeader* Node::Impl::take_from_queue(Input& input) {
  for (auto result = input.port.take(); !result.has_error(); result = input.port.take()) {
    const auto& header = *static_cast<const MessageHeader*>(result.value());
    if (const std::optional<Fault> refusal = reason_to_refuse(input, header)) {
      ++status.faults[static_cast<std::size_t>(*refusal)];
      ++input.refused;
      input.port.release(&header);
      continue;
    }
    const std::uint64_t lost = input.gaps.observe(header);
    status.faults[static_cast<std::size_t>(Fault::kInputLost)] += lost;
    if (lost > 0) {
      std::snprintf(status.last_fault.data(), status.last_fault.size(), "gap in the sequence of %.*s",
                    static_cast<int>(input.topic.name.size()), input.topic.name.data());
    }
    return &header;
  }
  return nullptr;
}

void Node::Impl::handle(Input& input, const MessageHeader& message, std::uint64_t dropped) {
  event_begin_ns = monotonic_now_ns();
  const std::uint64_t outputs_before = status.outputs;
  is_output_due = input.newest.has_value();
  if (input.newest) count_queueing(queueing_ns(message, event_begin_ns));
  {
    const CountAllocations counting(input.handled >= kWarmUpInputs);
    input.handler(&message, dropped);
  }
  const std::int64_t end_ns = monotonic_now_ns();
  if (status.outputs != outputs_before) {
    input.answers.published();
  } else if (is_output_due) {
    input.answers.missed(end_ns, input.topic.deadline_ns);
  }
  ++input.handled;
  count(end_ns - event_begin_ns);
  input.port.release(&message);
}

void Node::Impl::drop(Input& input, const MessageHeader& message) {
  ++status.faults[static_cast<std::size_t>(Fault::kInputDropped)];
  std::snprintf(status.last_fault.data(), status.last_fault.size(),
                "%.*s of radar %u superseded by a newer one: the service was too slow",
                static_cast<int>(input.topic.name.size()), input.topic.name.data(), message.source_id);
  input.port.release(&message);
}

bool Node::Impl::take_one(Input& input) {
  if (input.newest) return take_newest(input);
  const MessageHeader* const message = take_from_queue(input);
  if (message == nullptr) return false;
  handle(input, *message, 0);
  return true;
}

bool Node::Impl::take_newest(Input& input) {
  // At most one queue at a time: a writer that never pauses must not keep the service here.
  for (std::uint64_t i = 0; i < input.queue_capacity; ++i) {
    const MessageHeader* const message = take_from_queue(input);
    if (message == nullptr) break;
    if (const MessageHeader* const superseded = input.newest->add(*message)) drop(input, *superseded);
  }
  const NewestPerSource::Next next = input.newest->take();
  if (next.message == nullptr) return false;
  handle(input, *next.message, next.superseded);
  return true;
}

void Node::Impl::take_all() {
  // After every message the search starts at the first input again, so that a side input is handled before the next
  // scan. Timers are served in between, so that many messages cannot stop the heartbeat.
  for (bool found = true; found && !stopping && !stop_signalled();) {
    found = false;
    for (auto& input : inputs) {
      if (take_one(*input)) {
        found = true;
        break;
      }
    }
    if (found) run_timers();
  }
}

void Node::Impl::run_timers() {
  const std::int64_t now_ns = monotonic_now_ns();
  for (Timer& timer : timers) {
    if (now_ns < timer.next_ns) continue;
    // Missed periods are skipped: the next one starts on the grid after now.
    timer.next_ns += ((now_ns - timer.next_ns) / timer.period_ns + 1) * timer.period_ns;
    timer.callback();
  }
}

/// Waits for an input that wakes the service, or for a descriptor, at most until `end_ns` of the monotonic clock.
void Node::Impl::wait_until(std::int64_t end_ns) {
  const std::int64_t now_ns = monotonic_now_ns();
  if (waitset && descriptors.empty()) {
    wait_timer->end_wait_at(end_ns, now_ns);
    static_cast<void>(waitset->wait());
    return;
  }
  const std::int64_t longest_ns = inputs.empty() ? kLongestWait_ns : kInputPollPeriod_ns;
  wait_for_descriptors(std::clamp<std::int64_t>(end_ns - now_ns, 0, longest_ns));
}

/// Fills the first entries of `polled`; returns the result of ppoll(), which waits by the monotonic clock.
int Node::Impl::poll_descriptors(std::int64_t timeout_ns) {
  for (std::size_t i = 0; i < descriptors.size(); ++i) {
    polled[i] = {.fd = descriptors[i].descriptor, .events = POLLIN, .revents = 0};
  }
  const timespec timeout{.tv_sec = timeout_ns / 1'000'000'000, .tv_nsec = timeout_ns % 1'000'000'000};
  return ppoll(polled.data(), descriptors.size(), &timeout, nullptr);
}

void Node::Impl::wait_for_descriptors(std::int64_t timeout_ns) {
  std::erase_if(descriptors, [](const Descriptor& entry) { return entry.descriptor < 0; });
  const std::size_t count_of_descriptors = descriptors.size();
  if (poll_descriptors(timeout_ns) <= 0) return;
  for (std::size_t i = 0; i < count_of_descriptors; ++i) {
    // By index and descriptor: a callback may add or remove entries.
    if (polled[i].revents == 0 || descriptors[i].descriptor != polled[i].fd) continue;
    event_begin_ns = monotonic_now_ns();
    const std::function<void()>& callback = descriptors[i].callback;
    const CountAllocations counting(descriptors[i].handled++ >= kWarmUpInputs);
    callback();
  }
}

}  // namespace boresight::runtime
