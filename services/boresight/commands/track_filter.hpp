// Options and run of `boresight track` with a filter of one object's motion.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "services/boresight/track/filter_run.hpp"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace boresight {

struct TrackFilterOptions {
  track::FilterSetup setup;  ///< but the values below
  double azimuth_std_deg = 1.0;
  std::vector<double> sigma_points = {1.0, 2.0, 0.0};  ///< α, β, κ
  std::size_t skipped_steps = 20;                      ///< published test (Liang and Guo 2016)
  std::string figure;                                  ///< file; empty: none
  std::vector<CLI::Option*> all;

  /// Throws UsageError if one of these options is given, which `tracker` does not have.
  void refuse_for(const std::string& tracker) const;
};

void add_track_filter_options(CLI::App& command, TrackFilterOptions& options);

/// The filters' names: "kalman", "ekf", …
[[nodiscard]] std::vector<std::string> track_filter_names();

/// Runs the filter over a table of measurements, and writes the estimates, the errors and the figure. Returns the exit
/// code.
[[nodiscard]] int run_track_filter(const std::string& filter, const std::string& measurements, const std::string& out,
                                   std::size_t passes, const TrackFilterOptions& options);

}  // namespace boresight
