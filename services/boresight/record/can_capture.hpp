// Frames of one CAN interface into a candump log.
#pragma once

#include <cstdint>
#include <string>

#include "services/common/recording/writer.hpp"
#include "services/ingest_gateway/links/socket.hpp"

namespace boresight::record {

class CanCapture {
 public:
  /// Opens the interface for classic, FD and error frames, with kernel stamps and a large receive buffer. Throws
  /// CaptureError.
  explicit CanCapture(std::string interface);
  /// Reads from a socket that delivers as a raw CAN socket does.
  CanCapture(std::string interface, ingest::Socket socket);

  /// Takes what has come. Throws recording::WriteError. `problem` says what went wrong with the interface, or is
  /// empty; the socket is closed if it is of no more use.
  void read(recording::CandumpWriter& writer, std::string& problem);
  /// Tries to open an interface again that was closed.
  void reopen();

  [[nodiscard]] int descriptor() const { return socket_.get(); }
  [[nodiscard]] const std::string& interface() const { return interface_; }
  [[nodiscard]] std::uint64_t frames() const { return frames_; }
  [[nodiscard]] std::uint64_t dropped() const { return dropped_; }

 private:
  std::string interface_;
  ingest::Socket socket_;
  std::uint64_t frames_ = 0;
  std::uint64_t dropped_ = 0;
  std::uint32_t kernel_drops_ = 0;
};

}  // namespace boresight::record
