#include "services/boresight/align/recording_feed.hpp"

#include <algorithm>
#include <limits>

#include "services/boresight/input/play.hpp"

namespace boresight::align {

namespace {

constexpr double kLongestWait_s = 0.5;
constexpr std::size_t kMostWaiting = 256;

}  // namespace

RecordingFeed::RecordingFeed(Run& run)
    : run_(run),
      scan_(std::make_unique<RadarScan>()),
      newest_s_(-std::numeric_limits<double>::infinity()),
      newest_ego_s_(newest_s_) {}

RadarScan* RecordingFeed::begin_scan() {
  return scan_.get();
}

void RecordingFeed::publish_scan(std::uint32_t radar_id, const ingest::MeasurementTime& time) {
  ++statistics(radar_id).messages;
  scan_->header.source_id = radar_id;
  const double time_s = 1e-9 * static_cast<double>(time.time_ns);
  if ((scan_->integrity & input::kDoubtful) != 0) {
    ++doubtful_;
    if ((scan_->integrity & scan_integrity::kImpossibleCopies) != 0) run_.add_rejected_scan(*scan_, time_s);
    return;
  }
  newest_s_ = std::max(newest_s_, time_s);
  waiting_.push_back({time_s, std::move(scan_)});
  if (spare_.empty()) {
    scan_ = std::make_unique<RadarScan>();
  } else {
    scan_ = std::move(spare_.back());
    spare_.pop_back();
  }
  release(false);
}

void RecordingFeed::publish_ego(const ingest::MeasurementTime& time) {
  const double time_s = 1e-9 * static_cast<double>(time.time_ns);
  newest_s_ = std::max(newest_s_, time_s);
  newest_ego_s_ = time_s;
  run_.add_ego(ego_, time_s);
  release(false);
}

void RecordingFeed::release(bool all) {
  while (!waiting_.empty()) {
    Waiting& first = waiting_.front();
    const bool is_ready = newest_ego_s_ >= first.time_s || newest_s_ - first.time_s > kLongestWait_s;
    if (!is_ready && !all && waiting_.size() <= kMostWaiting) return;
    run_.add_scan(*first.scan, first.time_s);
    spare_.push_back(std::move(first.scan));
    waiting_.pop_front();
  }
}

void RecordingFeed::finish() {
  release(true);
}

void RecordingFeed::fault(Fault, std::string_view, std::uint32_t radar_id) {
  ++statistics(radar_id).rejected;
  ++rejected_;
}

SourceStatistics& RecordingFeed::statistics(std::uint32_t radar_id) {
  SourceStatistics& source = statistics_[std::min<std::size_t>(radar_id, kMaxRadars)];
  source.source_id = radar_id;
  return source;
}

}  // namespace boresight::align
