#include "services/ingest_gateway/core/source.hpp"

#include <utility>

namespace boresight::ingest {

Source::Source(const RadarConfig* radar, std::unique_ptr<Decoder> decoder, EgoReceiver& ego, Sink& sink,
               const ContradictionConfig& contradiction)
    : id_(radar == nullptr ? 0 : radar->id),
      clock_(radar == nullptr ? RadarConfig{} : *radar),
      judge_(radar == nullptr ? RadarConfig{} : *radar, contradiction),
      decoder_(std::move(decoder)),
      ego_(ego),
      sink_(sink) {}

RadarScan* Source::begin_scan() {
  // A radar may be configured for its ego signals only.
  if (id_ == 0) return nullptr;
  scan_ = sink_.begin_scan();
  return scan_;
}

void Source::publish_scan(const FrameStamp& reception, const std::optional<SensorStamp>& sensor,
                          unsigned cycle_counter_bits) {
  RadarScan& scan = *std::exchange(scan_, nullptr);
  if (cycle_counter_bits == 0) scan.cycle_counter = ++counted_cycles_;
  const SensorClock::Result time = clock_.map(sensor, reception);
  report(time);
  scan.integrity = judge_.judge(scan, time.time.time_ns, reception.received_ns, cycle_counter_bits,
                                ego_.latest_ego(time.time.time_ns));
  SourceStatistics& statistics = sink_.statistics(id_);
  statistics.lost = judge_.counters().lost_scans;
  // Missing scans before this one are no fault of this scan.
  if ((scan.integrity & ~scan_integrity::kCounterGap) != 0) ++statistics.suspect;
  sink_.publish_scan(id_, time.time);
}

void Source::report(const SensorClock::Result& time) {
  if (time.sensor_reset) {
    fault(Fault::kTimeJump, "the sensor's clock restarted: the sensor was reset");
  } else if (time.clock_jumped) {
    fault(Fault::kTimeJump, "the sensor's clock, or that of its frames, jumped");
  }
  if (time.sync_lost) fault(Fault::kTimeJump, "the sensor's stamps are not, or no longer, synchronised");
}

void Source::discard_scan() {
  scan_ = nullptr;
  sink_.discard_scan();
}

void Source::report_conditions(std::uint32_t conditions) {
  if (id_ != 0) sink_.statistics(id_).conditions = conditions | source_condition::kReported;
}

void Source::count_e2e(const E2eCounts& counts) {
  if (id_ == 0) return;
  SourceStatistics& statistics = sink_.statistics(id_);
  statistics.e2e_lost += counts.lost;
  statistics.e2e_repeated += counts.repeated;
  statistics.e2e_wrong += counts.wrong;
}

void Source::take_ego(const EgoReading& reading, const FrameStamp& reception) {
  ego_.take_ego(id_, reading, reception);
}

void Source::fault(Fault fault, std::string_view what) {
  sink_.fault(fault, what, id_);
}

}  // namespace boresight::ingest
