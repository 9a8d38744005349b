// Plays recordings through the core of the ingest gateway, frame by frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "interfaces/messages/radar_scan.hpp"
#include "services/boresight/input/problems.hpp"
#include "services/common/recording/reader.hpp"
#include "services/ingest_gateway/core/gateway.hpp"

namespace boresight::input {

/// Scans with one of these integrity flags are rejected, as in the service.
inline constexpr std::uint16_t kDoubtful =
    scan_integrity::kRepeated | scan_integrity::kFrozen | scan_integrity::kStale | scan_integrity::kImpossibleCopies;

/// Plays recordings of one clock completely. Frames count as lines, unreadable ones as bad lines. `look` is called
/// every few hundred frames. Throws recording::OpenError.
void play(const std::vector<std::filesystem::path>& recordings, ingest::Gateway& gateway, Problems& problems,
          const std::function<void(const recording::Progress&)>& look);

}  // namespace boresight::input
