// Records the frames of one CAN interface into a candump log.
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
  /// Reads from a socket that behaves like a raw CAN socket.
  CanCapture(std::string interface, ingest::Socket socket);

  /// Writes the frames that have arrived. Throws recording::WriteError. Sets `problem` to the problem of the interface,
  /// or to ""; closes the socket if it cannot be used any more.
  void read(recording::CandumpWriter& writer, std::string& problem);
  /// Tries to open a closed interface again.
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
