// How often the bytes of a detection are written between the received datagram and the scan.
#pragma once

#include <cstddef>

namespace boresight::bench {

struct Copies {
  std::size_t intermediate = 0;        ///< copies of the datagrams' bytes
  std::size_t decoded = 0;             ///< places where the detections stand as numbers: the scan, and nothing else
  bool into_the_sinks_memory = false;  ///< those are in the memory that Sink::begin_scan() gave
};

/// Lists of 800 detections of an ARS548, a datagram each.
[[nodiscard]] Copies count_ars548_copies();
/// Lists of 1024 detections of the Boresight service, in segments and protected.
[[nodiscard]] Copies count_someip_copies();

}  // namespace boresight::bench
