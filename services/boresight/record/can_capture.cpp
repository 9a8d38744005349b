#include "services/boresight/record/can_capture.hpp"

#include <cerrno>

#include "services/boresight/record/capture_error.hpp"
#include "services/common/runtime/can_socket.hpp"

namespace boresight::record {

namespace {

constexpr int kReceiveBuffer = 8 * 1024 * 1024;
constexpr int kFramesPerTurn = 1000;

ingest::Socket open_can(const std::string& interface) {
  std::string problem;
  ingest::Socket made(runtime::open_can_socket(interface, true, problem));
  if (!made.is_open()) throw CaptureError("can " + interface + ": " + problem);
  ingest::request_stamps_and_drops(made.get());
  static_cast<void>(ingest::request_receive_buffer(made.get(), kReceiveBuffer));
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
    // It is tried again; the loss of the interface was already reported.
  }
}

void CanCapture::read(recording::CandumpWriter& writer, std::string& problem) {
  problem.clear();
  for (int i = 0; i < kFramesPerTurn; ++i) {
    canfd_frame raw{};
    ingest::Reception reception{.sender = {}, .stamp = {}, .drops = kernel_drops_};
    const ssize_t length = ingest::receive(socket_, {reinterpret_cast<std::uint8_t*>(&raw), sizeof(raw)}, reception);
    if (length < 0) {
      if (errno == EAGAIN || errno == EINTR) return;
      problem = "can " + interface_ + ": " + ingest::last_error();
      // ENETDOWN comes once when the interface goes down; frames come again when it is up. After other errors it is
      // gone.
      if (errno != ENETDOWN) socket_.reset();
      return;
    }
    if (reception.drops != kernel_drops_) {
      writer.write_drops(interface_, reception.drops - kernel_drops_, reception.drops);
      dropped_ += reception.drops - kernel_drops_;
      kernel_drops_ = reception.drops;
    }
    recording::Frame frame;
    const runtime::CanFrameKind kind = runtime::from_kernel(raw, length, frame);
    if (kind == runtime::CanFrameKind::kWrongLength) {
      problem = "can " + interface_ + ": a frame with a wrong length was skipped";
      return;
    }
    frame.stamp_ns = reception.stamp.received_ns + reception.stamp.epoch_offset_ns;
    frame.set_interface(interface_);
    writer.write(frame, kind == runtime::CanFrameKind::kError);
    ++frames_;
  }
}

}  // namespace boresight::record
