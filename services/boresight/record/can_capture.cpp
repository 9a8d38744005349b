#include "services/boresight/record/can_capture.hpp"

#include <array>
#include <cerrno>

#include <linux/can.h>
#include <linux/can/error.h>
#include <linux/can/raw.h>
#include <net/if.h>

#include "services/boresight/record/capture_error.hpp"

namespace boresight::record {

namespace {

constexpr int kReceiveBuffer = 8 * 1024 * 1024;
constexpr int kFramesPerTurn = 1000;

ingest::Socket open_can(const std::string& interface) {
  ingest::Socket made(socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (!made.is_open()) {
    throw CaptureError("can " + interface + ": " +
                       (errno == EAFNOSUPPORT ? "this kernel has no CAN (module can-raw)" : ingest::last_error()));
  }
  const int on = 1;
  const can_err_mask_t all_errors = CAN_ERR_MASK;
  if (setsockopt(made.get(), SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof(on)) != 0 ||
      setsockopt(made.get(), SOL_CAN_RAW, CAN_RAW_ERR_FILTER, &all_errors, sizeof(all_errors)) != 0) {
    throw CaptureError("can " + interface + ": no CAN FD or error frames: " + ingest::last_error());
  }
  ingest::request_stamps_and_drops(made.get());
  static_cast<void>(ingest::request_receive_buffer(made.get(), kReceiveBuffer));
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(interface.c_str()));
  if (address.can_ifindex == 0) throw CaptureError("can " + interface + ": no such interface");
  if (bind(made.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    throw CaptureError("can " + interface + ": cannot bind: " + ingest::last_error());
  }
  return made;
}

}  // namespace

CanCapture::CanCapture(std::string interface) : CanCapture(interface, open_can(interface)) {}

CanCapture::CanCapture(std::string interface, ingest::Socket socket)
    : interface_(std::move(interface)), socket_(std::move(socket)) {}

void CanCapture::reopen() {
  try {
    socket_ = open_can(interface_);
    kernel_drops_ = 0;
  } catch (const CaptureError&) {
    // It is tried again; that it failed was told when it was lost.
  }
}

void CanCapture::read(recording::CandumpWriter& writer, std::string& problem) {
  problem.clear();
  for (int i = 0; i < kFramesPerTurn; ++i) {
    canfd_frame raw{};
    iovec data{&raw, sizeof(raw)};
    alignas(cmsghdr) std::array<char, 256> control{};
    msghdr message{};
    message.msg_iov = &data;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t length = recvmsg(socket_.get(), &message, MSG_DONTWAIT);
    if (length < 0) {
      if (errno == EAGAIN || errno == EINTR) return;
      problem = "can " + interface_ + ": " + ingest::last_error();
      // ENETDOWN comes once when the interface goes down, and frames again when it is back up; else it is gone.
      if (errno != ENETDOWN) socket_.reset();
      return;
    }
    std::uint32_t drops = kernel_drops_;
    const ingest::FrameStamp stamp = ingest::read_control(message, drops);
    if (drops != kernel_drops_) {
      writer.write_drops(interface_, drops - kernel_drops_, drops);
      dropped_ += drops - kernel_drops_;
      kernel_drops_ = drops;
    }
    const bool is_fd = length == static_cast<ssize_t>(CANFD_MTU);
    if ((!is_fd && length != static_cast<ssize_t>(CAN_MTU)) || raw.len > (is_fd ? 64 : 8)) {
      problem = "can " + interface_ + ": a frame of a wrong length was left out";
      return;
    }
    constexpr std::uint8_t kFlags = CANFD_BRS | CANFD_ESI;
    const bool is_error = (raw.can_id & CAN_ERR_FLAG) != 0;
    recording::Frame frame;
    frame.kind = is_fd ? recording::FrameKind::kCanFd : recording::FrameKind::kCan;
    frame.stamp_ns = stamp.received_ns + stamp.epoch_offset_ns;
    frame.set_interface(interface_);
    frame.can_extended = (raw.can_id & CAN_EFF_FLAG) != 0;
    frame.can_remote = (raw.can_id & CAN_RTR_FLAG) != 0;
    frame.can_fd_flags = static_cast<std::uint8_t>(raw.flags & kFlags);
    frame.can_id = raw.can_id & (frame.can_extended || is_error ? CAN_EFF_MASK : CAN_SFF_MASK);
    frame.payload = {raw.data, raw.len};
    writer.write(frame, is_error);
    ++frames_;
  }
}

}  // namespace boresight::record
