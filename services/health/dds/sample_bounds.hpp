// Whether the lengths of sequences in a serialised sample are possible, checked before memory is taken for them. Pure.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "generated/diagnostic_array.h"
#include "generated/service_status.h"
#include "generated/track_list.h"

namespace boresight::dds {

/// Most types have no sequences of structures; memory for text is taken as it is received.
template <typename Sample>
[[nodiscard]] bool sequences_fit(std::span<const std::uint8_t>) {
  return true;
}

/// The generated code takes some 130 bytes for each announced status, even if one byte follows. Here each announced
/// element must have its smallest size on the wire, and the texts their announced length.
template <>
[[nodiscard]] bool sequences_fit<diagnostic_msgs::msg::dds_::DiagnosticArray_>(std::span<const std::uint8_t> payload);

/// At most as many tracks, faults and sources as the IDL allows, each of which must have been received.
template <>
[[nodiscard]] bool sequences_fit<perception::TrackList>(std::span<const std::uint8_t> payload);
template <>
[[nodiscard]] bool sequences_fit<diagnostics::ServiceStatus>(std::span<const std::uint8_t> payload);

}  // namespace boresight::dds
