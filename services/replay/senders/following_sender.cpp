#include "services/replay/senders/following_sender.hpp"

#include <cstdio>

#include <sched.h>
#include <time.h>
#include <unistd.h>

#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/log.hpp"
#include "services/common/runtime/stop_signal.hpp"

namespace boresight::replay {

namespace {

// A scan takes about a millisecond through the pipeline. Polling wakes no reader and costs the tracker nothing.
constexpr std::int64_t kPollPeriod_ns = 200'000;
// The gateway reads a frame within microseconds if a processor is free. A sleep would cost more than the frame.
constexpr int kYieldsBeforeSleep = 100;
// After the end: the gateway's last scans, and the counters of every service in its heartbeat.
constexpr std::int64_t kLinger_ns = 3 * catalogue::topic(catalogue::TopicId::kServiceStatus).period_ns;

void sleep_for(std::int64_t duration_ns) {
  const timespec duration{.tv_sec = duration_ns / 1'000'000'000, .tv_nsec = duration_ns % 1'000'000'000};
  nanosleep(&duration, nullptr);
}

ScanId id_of(const MessageHeader& header) {
  return {.radar = header.source_id, .measurement_time_ns = header.measurement_time_ns};
}

std::string line_of(std::uint32_t radar, const ScanCounts& counts) {
  char text[160];
  std::snprintf(text, sizeof(text), "radar %u: %llu scans, %llu without a track list; waited for %llu of them\n", radar,
                static_cast<unsigned long long>(counts.published), static_cast<unsigned long long>(counts.missing),
                static_cast<unsigned long long>(counts.waits));
  return text;
}

}  // namespace

FollowingSender::FollowingSender(std::unique_ptr<Sender> receiver, const MaxSpeedConfig& config)
    : receiver_(std::move(receiver)),
      node_(catalogue::Service::kReplay, "-" + std::to_string(getpid())),
      window_(config.max_scans_in_flight, static_cast<std::int64_t>(config.timeout_s * 1e9)) {
  // A scan is handled before its track list: inputs declared earlier come first.
  node_.on<RadarScan>(
      [this](const RadarScan& scan) { window_.publish(id_of(scan.header), runtime::monotonic_now_ns()); });
  node_.on<TrackList>(
      [this](const TrackList& tracks) { window_.take_back(id_of(tracks.header), runtime::monotonic_now_ns()); });
  node_.on<ServiceStatus>([this](const ServiceStatus& status) {
    // A dropped scan has no track list either: its results are as incomplete as those of a lost one.
    input_losses_.see(status.header.source_id, status.incarnation_ns,
                      status.faults[static_cast<std::size_t>(Fault::kInputLost)] +
                          status.faults[static_cast<std::size_t>(Fault::kInputDropped)]);
  });
}

bool FollowingSender::send(const recording::Frame& frame) {
  // Scans of frames that the receiver has not read yet are not on the bus, so the window does not count them.
  wait_for_reading();
  wait_for_room();
  return receiver_->send(frame);
}

void FollowingSender::wait_for_reading() {
  for (int i = 0; !receiver_->all_read() && !runtime::stop_signalled(); ++i) {
    if (i < kYieldsBeforeSleep) {
      sched_yield();
    } else {
      sleep_for(kPollPeriod_ns);
    }
  }
}

void FollowingSender::wait_for_room() {
  serve();
  if (!window_.is_full()) return;
  window_.begin_wait();
  while (window_.is_full() && !runtime::stop_signalled()) {
    sleep_for(kPollPeriod_ns);
    serve();
  }
}

void FollowingSender::serve() {
  node_.serve();
  const bool was_silent = window_.is_silent();
  window_.expire(runtime::monotonic_now_ns());
  if (!window_.is_silent() || was_silent) return;
  runtime::log::warning("{}: the replay does not wait for scans", window_.is_answered()
                                                                      ? "no track list comes any more"
                                                                      : "no track list comes; no tracker runs");
}

void FollowingSender::finish() {
  receiver_.reset();
  const std::int64_t end_ns = runtime::monotonic_now_ns() + kLinger_ns;
  while (!runtime::stop_signalled() && (!window_.is_empty() || runtime::monotonic_now_ns() < end_ns)) {
    sleep_for(kPollPeriod_ns);
    serve();
  }
}

bool FollowingSender::has_losses() const {
  // Without a tracker no scan can come back.
  return (window_.is_answered() && window_.missing() > 0) || !input_losses_.losses().empty();
}

std::string FollowingSender::text() const {
  std::string text;
  for (const auto& [radar, counts] : window_.counts()) text += line_of(radar, counts);
  for (const auto& [service, lost] : input_losses_.losses()) {
    const bool is_known = service < catalogue::kNumberOfServices;
    text += std::string(is_known ? catalogue::kServiceNames[service] : "unknown service") + " lost " +
            std::to_string(lost) + " inputs, or dropped them as it was too slow\n";
  }
  return text;
}

}  // namespace boresight::replay
