// Recordings of the shared data through the whole chain, offline.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tests/benchmarks/tracking/effects/judge/observed_list.hpp"

namespace boresight::bench::tracking {

struct EffectSetup {
  std::filesystem::path programs;  ///< folder of the program boresight
  std::filesystem::path services;  ///< folder with the settings of the services
  std::filesystem::path data;      ///< real_effects/ of the shared data
  std::filesystem::path place;     ///< of the runs
  std::string tracker;             ///< name of --tracker; empty: that of the settings
};

struct EffectRecording {
  const char* name;
  const char* ending;  ///< ".pcap" or ".log"
  const char* vehicle;
};

/// Unpacks the recording, runs the chain over it and reads the track lists. Throws std::runtime_error.
[[nodiscard]] std::vector<ObservedList> run_recording(const EffectSetup& setup, const EffectRecording& recording);

}  // namespace boresight::bench::tracking
