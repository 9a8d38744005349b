// Frames of one cycle of one or more sources, and the bytes that they refer to.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "services/common/recording/frame.hpp"

namespace boresight::bench {

using Bytes = std::vector<std::uint8_t>;

class Traffic {
 public:
  Traffic() = default;
  Traffic(const Traffic&) = delete;  // frames refer to the bytes of their own traffic
  Traffic& operator=(const Traffic&) = delete;
  Traffic(Traffic&&) = default;
  Traffic& operator=(Traffic&&) = default;

  void add_can(std::string_view interface, std::uint32_t id, Bytes payload) {
    recording::Frame frame;
    frame.kind = payload.size() > 8 ? recording::FrameKind::kCanFd : recording::FrameKind::kCan;
    frame.set_interface(interface);
    frame.can_id = id;
    frame.can_extended = id > 0x7FF;
    add(frame, std::move(payload));
  }
  void add_udp(const recording::Endpoint& source, const recording::Endpoint& destination, Bytes payload) {
    recording::Frame frame;
    frame.kind = recording::FrameKind::kUdp;
    frame.source = source;
    frame.destination = destination;
    add(frame, std::move(payload));
  }
  void clear() {
    frames_.clear();
    bytes_.clear();
  }
  [[nodiscard]] std::span<const recording::Frame> frames() const { return frames_; }
  /// For time stamps and counters that change from cycle to cycle.
  [[nodiscard]] std::span<std::uint8_t> bytes(std::size_t frame) { return bytes_[frame]; }

 private:
  void add(recording::Frame& frame, Bytes payload) {
    bytes_.push_back(std::move(payload));
    frame.payload = bytes_.back();
    frames_.push_back(frame);
  }
  std::vector<Bytes> bytes_;
  std::vector<recording::Frame> frames_;
};

}  // namespace boresight::bench
