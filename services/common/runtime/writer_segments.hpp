// Whose memory a message lies in. In the deployed system each service writes to a segment of shared memory of its own,
// which the kernel protects from all others. iceoryx's queues are not protected: any process may put a message on any
// topic. The address of a message cannot be forged.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "interfaces/catalogue/catalogue.hpp"
#include "interfaces/messages/header.hpp"

namespace boresight::runtime {

/// The segments that this process mapped, by writing service.
class WriterSegments {
 public:
  /// A domain with one segment for all services: every message is accepted.
  WriterSegments() = default;
  /// `maps` is the text of /proc/self/maps.
  explicit WriterSegments(std::string_view maps);

  /// True if the whole range lies in the segment of this service.
  [[nodiscard]] bool contains(catalogue::Service writer, const void* begin, std::size_t size_bytes) const;
  /// True if the message lies in the memory of the topic's writer. If several services write the topic, it is the one
  /// that the header names. Always true with one segment for all services. Does not read a message outside all segments
  /// of the topic's writers.
  [[nodiscard]] bool accept(const catalogue::Topic& topic, const MessageHeader& message) const;

 private:
  /// Addresses; empty for a service without a segment.
  struct Range {
    std::uintptr_t begin = 0;
    std::uintptr_t end = 0;
  };
  std::array<Range, catalogue::kNumberOfServices> segments_{};
  bool is_split_ = false;  ///< the writers have segments of their own
};

}  // namespace boresight::runtime
