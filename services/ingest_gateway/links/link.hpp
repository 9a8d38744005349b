// Sources of frames: one interface for CAN buses, UDP sockets and the replay tunnel.
#pragma once

#include <functional>
#include <string>

#include "interfaces/messages/service_status.hpp"
#include "services/common/recording/frame.hpp"
#include "services/ingest_gateway/codecs/frame_stamp.hpp"

namespace boresight::ingest {

/// Callbacks of a link.
struct LinkEvents {
  std::function<void(const recording::Frame&, const FrameStamp&)> on_frame;
  std::function<void(Fault, std::string_view)> on_fault;
  std::function<void()> on_end;         ///< a recording is complete, or its replay has died
  std::function<void()> on_network_up;  ///< an interface or address is back; may be empty
};

/// A source of frames with a file descriptor to wait for.
class Link {
 public:
  virtual ~Link() = default;
  Link() = default;
  Link(const Link&) = delete;
  Link& operator=(const Link&) = delete;

  /// Opens or re-opens; false, with a fault, on failure. Called again each second until it succeeds.
  virtual bool open() = 0;
  /// Descriptor to wait for, −1 while closed.
  [[nodiscard]] virtual int descriptor() const = 0;
  /// Reads waiting frames, some dozens at most, so that the other links get their turn.
  virtual void read() = 0;
  /// Called each second and when the network has changed: closes the link if its interface was replaced.
  virtual void check() {}
  [[nodiscard]] virtual const std::string& name() const = 0;
};

}  // namespace boresight::ingest
