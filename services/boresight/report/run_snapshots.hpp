// Snapshots of an offline run, from the tables of its run folder: what a monitor would have recorded, but for services,
// latencies and key figures of the estimator.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "services/boresight/monitor/snapshot.hpp"
#include "services/boresight/report/summary.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::report {

struct RunSnapshots {
  std::vector<monitor::Snapshot> snapshots;  ///< in the order of time, without services and latencies
  std::string problem;                       ///< why a table could not be read to its end; "" if all were
};

/// Two snapshots a second of measurement time, as of the monitor. alignment.csv and health.jsonl may be absent; a table
/// is read up to the first row that cannot be read. `look` is called now and then, and may end the reading by an
/// exception.
[[nodiscard]] RunSnapshots snapshots_of_run(const std::filesystem::path& folder, const VehicleConfig& vehicle,
                                            const std::function<void()>& look = {});

/// That the tables could be read.
[[nodiscard]] Check run_check(const RunSnapshots& run);

}  // namespace boresight::report
