// Counts how often the bytes of a detection are written between the received datagram and the scan.
#pragma once

#include <cstddef>

namespace boresight::bench {

struct Copies {
  std::ptrdiff_t intermediate = 0;     ///< copies of the datagrams' bytes
  std::ptrdiff_t decoded = 0;          ///< places with the detections as float values: the scan only
  bool into_the_sinks_memory = false;  ///< those are in the memory from Sink::begin_scan()
};

/// A list of 800 detections of an ARS548 in one datagram.
[[nodiscard]] Copies count_ars548_copies();
/// A list of 1024 detections of the Boresight service, in segments and with E2E protection.
[[nodiscard]] Copies count_someip_copies();

}  // namespace boresight::bench
