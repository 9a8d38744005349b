#include "services/common/runtime/can_socket.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <sys/socket.h>
#include <unistd.h>

namespace boresight::runtime {

namespace {

int fail(int descriptor, std::string& problem, const std::string& what) {
  problem = what;
  if (descriptor >= 0) ::close(descriptor);
  return -1;
}

}  // namespace

int open_can_socket(const std::string& interface, bool with_error_frames, std::string& problem) {
  const auto cause = [] { return std::string(std::strerror(errno)); };
  const int made = socket(PF_CAN, SOCK_RAW | SOCK_CLOEXEC, CAN_RAW);
  if (made < 0) {
    const bool no_can = errno == EAFNOSUPPORT;
    return fail(made, problem, no_can ? "this kernel has no CAN (module can-raw)" : "cannot make a socket: " + cause());
  }
  const int on = 1;
  if (setsockopt(made, SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof(on)) != 0) {
    return fail(made, problem, "no CAN FD: " + cause());
  }
  const can_err_mask_t errors = with_error_frames ? CAN_ERR_MASK : 0;
  if (setsockopt(made, SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &errors, sizeof(errors)) != 0) {
    return fail(made, problem, "no filter of error frames: " + cause());
  }
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
  if (address.can_ifindex == 0) return fail(made, problem, "no such interface");
  if (bind(made, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    return fail(made, problem, "cannot bind: " + cause());
  }
  return made;
}

CanFrameKind from_kernel(const canfd_frame& raw, ssize_t length, recording::Frame& frame) {
  const bool is_fd = length == static_cast<ssize_t>(CANFD_MTU);
  if ((!is_fd && length != static_cast<ssize_t>(CAN_MTU)) || raw.len > (is_fd ? 64 : 8)) {
    return CanFrameKind::kWrongLength;
  }
  constexpr std::uint8_t kFlags = CANFD_BRS | CANFD_ESI;
  const bool is_error = (raw.can_id & CAN_ERR_FLAG) != 0;
  frame = recording::Frame{};
  frame.kind = is_fd ? recording::FrameKind::kCanFd : recording::FrameKind::kCan;
  frame.can_extended = (raw.can_id & CAN_EFF_FLAG) != 0;
  frame.can_remote = (raw.can_id & CAN_RTR_FLAG) != 0;
  frame.can_fd_flags = static_cast<std::uint8_t>(raw.flags & kFlags);
  frame.can_id = raw.can_id & (frame.can_extended || is_error ? CAN_EFF_MASK : CAN_SFF_MASK);
  frame.payload = {raw.data, raw.len};
  return is_error ? CanFrameKind::kError : CanFrameKind::kData;
}

std::size_t to_kernel(const recording::Frame& frame, canfd_frame& raw) {
  raw = {};
  raw.can_id = frame.can_id | (frame.can_extended ? CAN_EFF_FLAG : 0u) | (frame.can_remote ? CAN_RTR_FLAG : 0u);
  raw.flags = frame.can_fd_flags;
  const bool is_fd = frame.kind == recording::FrameKind::kCanFd;
  raw.len = static_cast<std::uint8_t>(std::min<std::size_t>(frame.payload.size(), is_fd ? 64 : 8));
  std::copy_n(frame.payload.data(), raw.len, raw.data);
  return is_fd ? CANFD_MTU : CAN_MTU;
}

}  // namespace boresight::runtime
