#include "services/ingest_gateway/links/can_link.hpp"

#include <algorithm>
#include <array>
#include <cerrno>

#include <linux/can.h>
#include <linux/can/raw.h>
#include <net/if.h>
#include <unistd.h>

namespace boresight::ingest {

namespace {

constexpr int kReceiveBuffer = 1024 * 1024;
constexpr int kFramesPerTurn = 64;

}  // namespace

CanLink::CanLink(std::string interface, LinkEvents events)
    : interface_(std::move(interface)), name_("can " + interface_), events_(std::move(events)) {}

bool CanLink::fail(const std::string& what) {
  events_.on_fault(Fault::kLink, name_ + ": " + what);
  socket_.reset();
  return false;
}

bool CanLink::open() {
  socket_ = Socket(socket(PF_CAN, SOCK_RAW | SOCK_NONBLOCK | SOCK_CLOEXEC, CAN_RAW));
  if (!socket_.is_open()) {
    return fail(errno == EAFNOSUPPORT ? "this kernel has no CAN (module can-raw)"
                                      : "cannot make a socket: " + last_error());
  }
  const int on = 1;
  if (setsockopt(socket_.get(), SOL_CAN_RAW, CAN_RAW_FD_FRAMES, &on, sizeof(on)) != 0) {
    return fail("no CAN FD: " + last_error());
  }
  request_stamps_and_drops(socket_.get());
  static_cast<void>(request_receive_buffer(socket_.get(), kReceiveBuffer));
  sockaddr_can address{};
  address.can_family = AF_CAN;
  address.can_ifindex = static_cast<int>(if_nametoindex(interface_.c_str()));
  if (address.can_ifindex == 0) return fail("no such interface");
  if (bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    return fail("cannot bind: " + last_error());
  }
  kernel_drops_ = 0;
  return true;
}

void CanLink::read() {
  for (int i = 0; i < kFramesPerTurn; ++i) {
    canfd_frame raw{};
    iovec data{&raw, sizeof(raw)};
    alignas(cmsghdr) std::array<char, 256> control{};
    msghdr message{};
    message.msg_iov = &data;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    const ssize_t length = recvmsg(socket_.get(), &message, 0);
    if (length < 0) {
      // ENETDOWN comes once when the interface goes down; it is opened anew until it is back.
      if (errno != EAGAIN && errno != EINTR) fail("receiving failed: " + last_error());
      return;
    }
    const FrameStamp stamp = stamp_and_drops(message, kernel_drops_, "CAN frames", events_);
    const bool is_fd = length == static_cast<ssize_t>(CANFD_MTU);
    if ((!is_fd && length != static_cast<ssize_t>(CAN_MTU)) || raw.len > (is_fd ? 64 : 8)) {
      events_.on_fault(Fault::kWireLength, "CAN frame of a wrong length");
      continue;
    }
    if ((raw.can_id & CAN_ERR_FLAG) != 0) continue;
    recording::Frame frame;
    frame.kind = is_fd ? recording::FrameKind::kCanFd : recording::FrameKind::kCan;
    frame.stamp_ns = stamp.received_ns;
    frame.set_interface(interface_);
    frame.can_extended = (raw.can_id & CAN_EFF_FLAG) != 0;
    frame.can_remote = (raw.can_id & CAN_RTR_FLAG) != 0;
    frame.can_id = raw.can_id & (frame.can_extended ? CAN_EFF_MASK : CAN_SFF_MASK);
    frame.payload = {raw.data, raw.len};
    events_.on_frame(frame, stamp);
  }
}

void CanLink::send(const recording::Frame& frame) {
  canfd_frame raw{};
  raw.can_id = frame.can_id | (frame.can_extended ? CAN_EFF_FLAG : 0u);
  raw.len = static_cast<std::uint8_t>(std::min<std::size_t>(frame.payload.size(), sizeof(raw.data)));
  std::copy_n(frame.payload.data(), raw.len, raw.data);
  const std::size_t size = frame.kind == recording::FrameKind::kCanFd ? CANFD_MTU : CAN_MTU;
  const bool sent = socket_.is_open() && ::write(socket_.get(), &raw, size) == static_cast<ssize_t>(size);
  if (!sent && !sending_fails_) events_.on_fault(Fault::kLink, name_ + ": cannot send: " + last_error());
  sending_fails_ = !sent;
}

}  // namespace boresight::ingest
