// Recordings through the gateway's core, frame by frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

#include "interfaces/messages/radar_scan.hpp"
#include "services/boresight/align/problems.hpp"
#include "services/common/recording/reader.hpp"
#include "services/ingest_gateway/core/gateway.hpp"

namespace boresight::align {

/// Scans that the gateway marks so are not believed, as the service does not.
inline constexpr std::uint16_t kDoubtful =
    scan_integrity::kRepeated | scan_integrity::kFrozen | scan_integrity::kStale | scan_integrity::kImpossibleCopies;

/// Plays recordings of one clock to their end. Frames count as lines, what cannot be read as bad ones. `look` is called
/// every few hundred frames. Throws recording::OpenError.
void play(const std::vector<std::filesystem::path>& recordings, ingest::Gateway& gateway, Problems& problems,
          const std::function<void(const recording::Progress&)>& look);

}  // namespace boresight::align
