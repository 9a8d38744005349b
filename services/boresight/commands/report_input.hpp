// A run folder as the input of a report.
#pragma once

#include <filesystem>

#include "services/boresight/report/html_report.hpp"

namespace boresight {

/// Reads the snapshots, or makes them from the tables of an offline run, reads the tables of scans, and adds the checks
/// on them. `truth_file` is truth.csv of a simulated drive, or empty. A signal ends the reading with Interrupted.
void read_run_folder(const std::filesystem::path& folder, const std::filesystem::path& truth_file,
                     report::ReportInput& input);

}  // namespace boresight
