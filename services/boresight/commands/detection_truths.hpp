// The truth of every detection of a simulated drive, from its folder.
#pragma once

#include <filesystem>
#include <optional>

#include "services/boresight/report/ghost_findings.hpp"

namespace boresight {

/// The tables beside a truth.csv; nothing where there are none. Throws std::runtime_error where one cannot be
/// understood.
[[nodiscard]] std::optional<report::DetectionTruths> detection_truths_beside(const std::filesystem::path& truth_file);

}  // namespace boresight
