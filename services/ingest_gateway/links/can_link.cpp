#include "services/ingest_gateway/links/can_link.hpp"

#include <cerrno>

#include <sys/socket.h>

#include "services/common/runtime/can_socket.hpp"

namespace boresight::ingest {

namespace {

constexpr int kCanReceiveBuffer_bytes = 1024 * 1024;
constexpr int kCanFramesPerTurn = 64;

}  // namespace

CanLink::CanLink(std::string interface, LinkEvents events)
    : interface_(std::move(interface)), name_("can " + interface_), events_(std::move(events)) {}

bool CanLink::fail(const std::string& what) {
  events_.on_fault(Fault::kLink, name_ + ": " + what);
  socket_.reset();
  return false;
}

bool CanLink::open() {
  std::string problem;
  socket_ = Socket(runtime::open_can_socket(interface_, false, problem));
  if (!socket_.is_open()) return fail(problem);
  request_stamps_and_drops(socket_.get());
  static_cast<void>(request_receive_buffer(socket_.get(), kCanReceiveBuffer_bytes));
  kernel_drops_ = 0;
  return true;
}

void CanLink::read() {
  for (int i = 0; i < kCanFramesPerTurn; ++i) {
    canfd_frame raw{};
    Reception reception{.sender = {}, .stamp = {}, .drops = kernel_drops_};
    const ssize_t length = receive(socket_, {reinterpret_cast<std::uint8_t*>(&raw), sizeof(raw)}, reception);
    if (length < 0) {
      // ENETDOWN comes once when the interface goes down; the link is opened again until the interface is back.
      if (errno != EAGAIN && errno != EINTR) fail("receiving failed: " + last_error());
      return;
    }
    report_drops(reception, kernel_drops_, "CAN frames", events_);
    recording::Frame frame;
    if (runtime::from_kernel(raw, length, frame) != runtime::CanFrameKind::kData) {
      events_.on_fault(Fault::kWireLength, "CAN frame with a wrong length");
      continue;
    }
    frame.stamp_ns = reception.stamp.received_ns;
    frame.set_interface(interface_);
    events_.on_frame(frame, reception.stamp);
  }
}

void CanLink::send(const recording::Frame& frame) {
  canfd_frame raw{};
  const std::size_t size = runtime::to_kernel(frame, raw);
  const bool sent = socket_.is_open() && ::send(socket_.get(), &raw, size, MSG_DONTWAIT) == static_cast<ssize_t>(size);
  if (!sent && !sending_fails_) events_.on_fault(Fault::kLink, name_ + ": cannot send: " + last_error());
  sending_fails_ = !sent;
}

}  // namespace boresight::ingest
