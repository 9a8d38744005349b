// SocketCAN: opens an interface; converts frames to and from the kernel's form.
#pragma once

#include <cstddef>
#include <string>

#include <linux/can.h>
#include <sys/types.h>

#include "services/common/recording/frame.hpp"

namespace boresight::runtime {

/// A raw, blocking socket for the classic and FD frames of an interface, and for error frames if requested; −1 with the
/// `problem` if it cannot be opened.
[[nodiscard]] int open_can_socket(const std::string& interface, bool with_error_frames, std::string& problem);

enum class CanFrameKind : std::uint8_t { kData, kError, kWrongLength };

/// Decodes `length` received bytes; writes all of `frame` except stamp and interface. Its payload views `raw`. The id
/// of an error frame holds the classes of error.
[[nodiscard]] CanFrameKind from_kernel(const canfd_frame& raw, ssize_t length, recording::Frame& frame);

/// Fills `raw` and returns its number of bytes to send.
[[nodiscard]] std::size_t to_kernel(const recording::Frame& frame, canfd_frame& raw);

}  // namespace boresight::runtime
