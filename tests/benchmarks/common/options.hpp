// Extent of a benchmark run.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>

namespace boresight::bench {

/// The radar profile on which the bars are judged.
inline constexpr const char* kJudgedProfile = "ideal";

struct Options {
  bool quick = false;            ///< two seeds and short drives: a check that it runs, not a measurement
  std::string only;              ///< group of bars; empty: all groups
  std::size_t jobs = 2;          ///< threads
  std::size_t most_seeds = 0;    ///< 0: as many as a bar requires
  std::uint64_t first_seed = 1;  ///< benchmarks with fixed seeds for their bars: other seeds are for tuning
  std::uint64_t fresh_seed = 1;  ///< first seed of groups with fresh seeds; bars_main() draws it for each run
  std::string method;            ///< judged as the product's own; empty: the product's default
  std::string data_folder;       ///< folder of recordings; empty: groups of bars that need recordings are skipped
  std::string profile = kJudgedProfile;  ///< of all simulated radars: a shipped radar profile or its file
  bool real_car = false;                 ///< the vehicle has the effects of a real car, all of the preset

  [[nodiscard]] std::size_t seeds(std::size_t wanted) const {
    const std::size_t most = quick ? 2 : most_seeds != 0 ? most_seeds : wanted;
    return std::min(wanted, most);
  }
  [[nodiscard]] double seconds(double wanted) const { return quick ? std::min(wanted, 12.0) : wanted; }
  /// Radar profile and car of the simulated drives, as reports name them.
  [[nodiscard]] std::string drives() const { return real_car ? profile + " + real car" : profile; }
  [[nodiscard]] bool judges() const { return profile == kJudgedProfile && !real_car; }
  [[nodiscard]] bool wants(const std::string& group) const { return only.empty() || only == group; }
};

}  // namespace boresight::bench
