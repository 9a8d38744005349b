#include "services/ingest_gateway/core/source.hpp"

#include <utility>

namespace boresight::ingest {

Source::Source(const RadarConfig* radar, std::unique_ptr<Decoder> decoder, EgoReceiver& ego, Sink& sink)
    : id_(radar == nullptr ? 0 : radar->id),
      latency_ns_(radar == nullptr ? 0 : static_cast<std::int64_t>(radar->latency_s * 1e9)),
      decoder_(std::move(decoder)),
      ego_(ego),
      sink_(sink) {}

RadarScan* Source::begin_scan() {
  scan_ = sink_.begin_scan();
  return scan_;
}

void Source::publish_scan(const FrameStamp& reception, const std::optional<SensorStamp>& sensor,
                          unsigned cycle_counter_bits) {
  RadarScan& scan = *std::exchange(scan_, nullptr);
  if (cycle_counter_bits == 0) scan.cycle_counter = ++counted_cycles_;
  const MeasurementTime time = sensor ? measurement_time(sensor->time_ns, sensor->synchronised, reception, latency_ns_)
                                      : MeasurementTime{reception.received_ns - latency_ns_, reception.source};
  sink_.publish_scan(id_, time);
}

void Source::discard_scan() {
  scan_ = nullptr;
  sink_.discard_scan();
}

void Source::report_conditions(std::uint32_t conditions) {
  sink_.statistics(id_).conditions = conditions;
}

void Source::take_ego(const EgoReading& reading, const FrameStamp& reception) {
  ego_.take_ego(id_, reading, reception);
}

void Source::fault(Fault fault, std::string_view what) {
  sink_.fault(fault, what, id_);
}

}  // namespace boresight::ingest
