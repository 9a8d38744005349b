// The parts of the page, each HTML, and what they share.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "services/boresight/report/html_report.hpp"
#include "services/boresight/report/summary.hpp"
#include "services/boresight/svg/chart.hpp"
#include "services/common/geometry/angles.hpp"

namespace boresight::report {

using monitor::RadarSnapshot;
using monitor::Snapshot;
using svg::Chart;
using svg::escape;
using svg::Point;

/// Seconds since the first scan, as far as it is known: of the record of scans, else of the first snapshot with one.
class TimeBase {
 public:
  TimeBase(const std::vector<Snapshot>& snapshots, const GhostFindings& ghosts) {
    for (const Snapshot& snapshot : snapshots) {
      if (begin_ns_ == 0) begin_ns_ = snapshot.time_ns;
      const bool any = std::any_of(snapshot.radars.begin(), snapshot.radars.end(), [](auto& r) { return r.scans > 0; });
      if (!any) continue;
      begin_ns_ = snapshot.time_ns;
      break;
    }
    if (ghosts.scans > 0) begin_ns_ = ghosts.first_scan_ns;
    if (!snapshots.empty()) end_s_ = std::max(1.0, seconds(snapshots.back()));
  }
  [[nodiscard]] double seconds(std::int64_t time_ns) const { return static_cast<double>(time_ns - begin_ns_) * 1e-9; }
  [[nodiscard]] double seconds(const Snapshot& s) const { return seconds(s.time_ns); }
  [[nodiscard]] double end_s() const { return end_s_; }

 private:
  std::int64_t begin_ns_ = 0;
  double end_s_ = 1.0;
};

/// Null if the snapshot has no such radar.
[[nodiscard]] inline const RadarSnapshot* find_radar(const Snapshot& snapshot, std::uint32_t id) {
  for (const RadarSnapshot& radar : snapshot.radars) {
    if (radar.id == id) return &radar;
  }
  return nullptr;
}

[[nodiscard]] std::string render_verdict(const ReportInput& input, const Summary& summary);
/// Terms of the page, explained.
[[nodiscard]] std::string render_terms();
[[nodiscard]] std::string render_table(const Summary& summary);
/// About the vehicle's axes, with the key figures.
[[nodiscard]] std::string render_details(const Summary& summary);
/// Nothing where no truth is known.
[[nodiscard]] std::string render_truth(const ReportInput& input, const TimeBase& time, const Summary& summary);
[[nodiscard]] std::string render_alignment(const ReportInput& input, const TimeBase& time, const Summary& summary);
[[nodiscard]] std::string render_health(const ReportInput& input, const TimeBase& time, const Summary& summary);
/// How the ghost filter classified detections, in total and over time.
[[nodiscard]] std::string render_labels(const ReportInput& input, const TimeBase& time, const Summary& summary);
/// Labels beside the truth, and tracks that followed ghosts; a hint where the record or the truth is missing.
[[nodiscard]] std::string render_confusion(const ReportInput& input, const TimeBase& time);
/// Scans seen from above.
[[nodiscard]] std::string render_plan_views(const ReportInput& input, const TimeBase& time);
[[nodiscard]] std::string render_tracks(const ReportInput& input);
[[nodiscard]] std::string render_latencies(const Summary& summary);

}  // namespace boresight::report
