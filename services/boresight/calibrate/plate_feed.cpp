#include "services/boresight/calibrate/plate_feed.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "services/boresight/input/play.hpp"

namespace boresight::calibrate {

namespace plate = alignment::plate;

std::vector<TiltInterval> read_tilts(recording::ByteSource& source, input::Problems& problems) {
  constexpr double kRadians = M_PI / 180.0, kLatest_s = 1e11;
  constexpr std::array<input::Column, 3> kColumns{
      {{"tilt_deg", -20.0, 20.0, "deg"}, {"begin_s", 0.0, kLatest_s, "s"}, {"end_s", 0.0, kLatest_s, "s"}}};
  input::CsvTable table(source, kColumns, problems);
  std::vector<TiltInterval> intervals;
  std::array<double, kColumns.size()> row{};
  while (table.next(row)) {
    if (intervals.size() == plate::kMaxTilts) {
      table.reject(0, fmt::format("a run has at most {} tilts", plate::kMaxTilts));
    } else if (!(row[2] > row[1])) {
      table.reject(2, fmt::format("the end, {:.3f} s, is not after the begin, {:.3f} s", row[2], row[1]));
    } else if (!intervals.empty() && row[1] < intervals.back().end_s) {
      table.reject(1, fmt::format("begins at {:.3f} s, before the tilt above it ends", row[1]));
    } else {
      intervals.push_back({row[0] * kRadians, row[1], row[2]});
      table.accept();
    }
  }
  return intervals;
}

PlateFeed::PlateFeed(std::uint32_t radar, std::vector<TiltInterval> intervals, const plate::PlateWindow& window)
    : radar_(radar), intervals_(std::move(intervals)), window_(window), scan_(std::make_unique<RadarScan>()) {
  intervals_.resize(std::min(intervals_.size(), plate::kMaxTilts));
  measurements_.number_of_tilts = intervals_.size();
  for (std::size_t i = 0; i < intervals_.size(); ++i) measurements_.tilts[i].tilt_rad = intervals_[i].tilt_rad;
}

void PlateFeed::publish_scan(std::uint32_t radar_id, const ingest::MeasurementTime& time) {
  ++statistics(radar_id).messages;
  if (radar_id != radar_) return;
  const double time_s = 1e-9 * static_cast<double>(time.time_ns);
  if (scans_++ == 0) first_s_ = time_s;
  last_s_ = time_s;
  const auto interval = std::find_if(intervals_.begin(), intervals_.end(), [time_s](const TiltInterval& i) {
    return i.begin_s <= time_s && time_s < i.end_s;
  });
  if (interval == intervals_.end()) return;
  ++within_;
  if ((scan_->integrity & input::kDoubtful) != 0) {
    ++doubtful_;
    return;
  }
  const plate::PlateEcho echo = plate::find_plate(*scan_, window_);
  if (!echo.seen) {
    ++without_plate_;
    return;
  }
  plate::TiltMeasurement& tilt = measurements_.tilts[static_cast<std::size_t>(interval - intervals_.begin())];
  static_cast<void>(tilt.add(echo.amplitude_db, echo.azimuth_rad));
}

void PlateFeed::fault(Fault, std::string_view, std::uint32_t radar_id) {
  ++statistics(radar_id).rejected;
  if (radar_id == radar_ || radar_id == 0) ++rejected_;
}

SourceStatistics& PlateFeed::statistics(std::uint32_t radar_id) {
  SourceStatistics& source = statistics_[std::min<std::size_t>(radar_id, kMaxRadars)];
  source.source_id = radar_id;
  return source;
}

}  // namespace boresight::calibrate
