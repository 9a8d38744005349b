#include "services/replay/server/someip_sender.hpp"

#include <algorithm>

#include "interfaces/wire/boresight_service.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/log.hpp"

namespace boresight::replay {

EventSink::EventSink(SomeIpServer& server) : server_(server), scan_(std::make_unique<RadarScan>()) {}

void EventSink::frame_begins(std::int64_t received_ns, std::int64_t due_ns) {
  received_ns_ = received_ns;
  due_ns_ = due_ns;
  heard_ = true;
}

SensorTime EventSink::stamp(const ingest::MeasurementTime& time) const {
  namespace sync_status = wire::boresight_service::sync_status;
  // Keeps the age of the data at their reception in the recording; the time of reception is that of the replay.
  const std::int64_t realtime_offset_ns = runtime::realtime_now_ns() - runtime::monotonic_now_ns();
  const bool synchronised = time.source == TimeSource::kSensorSynchronised;
  return {due_ns_ + realtime_offset_ns - (received_ns_ - time.time_ns),
          synchronised ? sync_status::kSynchronised : sync_status::kNever};
}

void EventSink::publish_scan(std::uint32_t radar_id, const ingest::MeasurementTime& time) {
  heard_ = server_.send(static_cast<std::uint16_t>(radar_id), *scan_, stamp(time)) && heard_;
}

void EventSink::publish_ego(const ingest::MeasurementTime& time) {
  heard_ = server_.send(ego_, stamp(time)) && heard_;
}

void EventSink::fault(Fault /*fault*/, std::string_view what, std::uint32_t radar_id) {
  constexpr std::uint64_t kShown = 10;
  if (++faults_ <= kShown) runtime::log::warning("recording, radar {}: {}", radar_id, what);
  if (faults_ == kShown) runtime::log::warning("further faults in the recordings' content are not logged");
}

SourceStatistics& EventSink::statistics(std::uint32_t radar_id) {
  return statistics_[std::min<std::size_t>(radar_id, kMaxRadars)];
}

SomeIpSender::SomeIpSender(const VehicleConfig& vehicle, SomeIpServer& server)
    : server_(server), sink_(server), gateway_(vehicle, sink_) {}

void SomeIpSender::wait_until(std::int64_t due_ns) {
  server_.serve_until(due_ns);
  due_ns_ = due_ns;
}

bool SomeIpSender::send(const recording::Frame& frame) {
  bool jumped = false;
  const ingest::FrameStamp stamp = clock_.map(frame.stamp_ns, due_ns_, jumped);
  sink_.frame_begins(stamp.received_ns, due_ns_);
  gateway_.take(frame, stamp);
  return sink_.heard();
}

void SomeIpSender::end_recording() {
  gateway_.finish();
  clock_.reset();
}

}  // namespace boresight::replay
