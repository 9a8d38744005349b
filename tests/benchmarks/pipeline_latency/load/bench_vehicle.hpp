// The demo vehicle with up to eight radars.
#pragma once

#include <filesystem>

namespace boresight::bench {

inline constexpr unsigned kMostRadars = 8;

/// Writes a folder of configuration with the vehicle `bench`: the demo vehicle with `radars` radars, 1…kMostRadars.
/// Those beyond its four look ahead and back. Returns the folder `to`.
std::filesystem::path write_bench_vehicle(const std::filesystem::path& shipped, const std::filesystem::path& to,
                                          unsigned radars);

}  // namespace boresight::bench
