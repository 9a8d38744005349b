// The truth of every detection of a simulated drive, from its folder.
#pragma once

#include <filesystem>
#include <optional>

#include "services/boresight/report/ghost_findings.hpp"

namespace boresight {

/// Reads the tables beside a truth.csv; nothing if one of them does not exist. Throws std::runtime_error if one cannot
/// be read.
[[nodiscard]] std::optional<report::DetectionTruths> detection_truths_beside(const std::filesystem::path& truth_file);

}  // namespace boresight
