// Simulates a drive and runs the chain and the baselines over it, each into a folder of its own.
//
//     PLACE/PROFILE/SCENARIO_SEED/drive        recordings and truth
//                                /run_TRACKER  of `boresight run`, or with true origins
//                                /baseline_N   of the baseline with N detections a cluster at least
//
// Folders that are there are used again.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "services/common/vehicle/vehicle.hpp"

namespace boresight::bench::tracking {

/// Name of the tracker that `boresight run` takes without the option --tracker.
inline constexpr const char* kDefaultTracker = "default";
/// The default tracker with the true origin of each detection.
inline constexpr const char* kPerfectTracker = "perfect";
/// The default tracker without what the ghost filter says.
inline constexpr const char* kUnfilteredTracker = "unfiltered";

struct DriveSetup {
  std::filesystem::path programs;      ///< folder of the program boresight
  std::filesystem::path config;        ///< folder with vehicle/ and services/
  std::filesystem::path place;         ///< of the folders of drives
  std::filesystem::path unfiltered;    ///< the same as `config`, for kUnfilteredTracker
  std::string vehicle = "demo";        ///< as the option --vehicle
  VehicleConfig baseline_vehicle;      ///< the same
  std::vector<std::string> trackers;   ///< names of --tracker, or one of those above
  std::vector<std::size_t> baselines;  ///< fewest detections of a cluster
  bool keeps_all = false;              ///< also recordings and detections, a quarter of a gigabyte a drive
  bool runs_again = false;             ///< runs of the chain that are there are replaced
};

struct DriveSpec {
  std::string profile, scenario;  ///< names or files
  std::uint64_t seed = 1;
  double longest_s = 0.0;  ///< 0: as long as the scenario
};

/// A run to be judged.
struct NamedRun {
  std::string name;
  std::filesystem::path folder;
  std::string score_column;
};

/// Copies the folder `config` to `copy`, with a tracker that does not use the ghost filter's ratio. Throws
/// std::runtime_error.
void write_unfiltered_config(const std::filesystem::path& config, const std::filesystem::path& copy);

[[nodiscard]] std::string name_of(const std::string& name_or_file);
[[nodiscard]] std::filesystem::path folder_of(const DriveSetup& setup, const DriveSpec& drive);
/// Seeds of the drives of this profile, scenario and length that are there, in rising order.
[[nodiscard]] std::vector<std::uint64_t> seeds_there(const DriveSetup& setup, const DriveSpec& drive);

/// Makes what is missing. The runs in the order of trackers, then baselines. Throws std::runtime_error.
[[nodiscard]] std::vector<NamedRun> make_runs(const DriveSetup& setup, const DriveSpec& drive);
/// Deletes what the judgement does not read, unless all is kept.
void trim(const DriveSetup& setup, const DriveSpec& drive);

}  // namespace boresight::bench::tracking
