// What a simulated drive says about itself: the truth.toml beside its recordings.
#pragma once

#include <filesystem>

#include "services/boresight/report/summary.hpp"

namespace boresight {

/// Keys: `speed_scale`, and `[[radar]]` tables with `id` and `yaw_deg` (actual − nominal mounting); others are for
/// other readers. Throws std::runtime_error if the file cannot be read or has no radar.
[[nodiscard]] report::Truth read_truth(const std::filesystem::path& file);

}  // namespace boresight
