// The recorded scenarios and the reference figures of the shared data, which may be absent.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/benchmarks/tracking/scenarios/common/scenario.hpp"

namespace boresight::bench::scenarios {

/// Mean GOSPA a scan.
struct MeanGospa {
  double squared = 0.0;  ///< with the squared base distance
  double root = 0.0;     ///< with the true base distance
};
[[nodiscard]] MeanGospa mean_gospa(const track::ObjectsByStep& truth, const track::ObjectsByStep& estimates);

struct RecordedScenario {
  Scenario scenario;
  Measurements recorded;
  MeanGospa reference_pmbm, reference_phd;  ///< of the reference code's estimates
};

/// xia_c30_s2, xia_c60_s1 or hwy_c15_s11.
[[nodiscard]] RecordedScenario read_recorded_scenario(const std::filesystem::path& data_folder,
                                                      const std::string& name);

/// The published scenario of targets that merge and split, with runs of recorded measurements (Xia et al. 2019).
struct SplitMerge {
  Scenario scenario;
  std::vector<Measurements> runs;  ///< without origins
};
[[nodiscard]] SplitMerge read_split_merge(const std::filesystem::path& data_folder);

/// Whether the folder has both; prints "GROUP: skipped: no shared data" if not.
[[nodiscard]] bool has_shared_data(const std::filesystem::path& data_folder, const char* group);

}  // namespace boresight::bench::scenarios
