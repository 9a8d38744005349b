// A run as one self-contained HTML page: verdict, estimates against truth, health over time, tracks, latencies.
#pragma once

#include <string>
#include <vector>

#include "services/boresight/monitor/snapshot.hpp"
#include "services/boresight/report/ghost_findings.hpp"
#include "services/boresight/report/summary.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::report {

struct ReportInput {
  std::string title;                         ///< of the drive
  std::vector<monitor::Snapshot> snapshots;  ///< in the order of time
  Truth truth;
  VehicleConfig vehicle;            ///< for mounting positions and fields of view in the top view
  std::vector<Check> more_checks;   ///< besides those of summarise()
  GhostFindings ghosts;             ///< of the record of scans, where there is one
  std::vector<std::string> events;  ///< of the supervisor
  std::string pace{};               ///< as in Summary
};

/// The page is complete in itself: it loads no script, font or picture.
[[nodiscard]] std::string render_html(const ReportInput& input);

}  // namespace boresight::report
