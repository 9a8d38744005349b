#include "services/ingest_gateway/links/tunnel_link.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>

#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include "interfaces/wire/replay_tunnel.hpp"
#include "services/common/runtime/clock.hpp"

namespace boresight::ingest {

namespace protocol = wire::replay_tunnel;

namespace {

constexpr int kTunnelFramesPerTurn = 64;

/// Fills `frame` from a received record; false if the record is contradictory.
bool parse_record(std::span<const std::uint8_t> record, recording::Frame& frame) {
  protocol::RecordHeader header;
  if (record.size() < sizeof(header)) return false;
  std::memcpy(&header, record.data(), sizeof(header));
  const std::span<const std::uint8_t> payload = record.subspan(sizeof(header));
  if (header.magic != protocol::kMagic || header.payload_bytes != payload.size()) return false;
  if (header.kind < 1 || header.kind > 3) return false;
  frame = recording::Frame{};
  frame.kind = static_cast<recording::FrameKind>(header.kind);
  if (frame.kind != recording::FrameKind::kUdp && payload.size() > 64) return false;
  frame.stamp_ns = header.stamp_ns;
  frame.set_interface({header.interface, strnlen(header.interface, sizeof(header.interface))});
  frame.can_id = header.can_id;
  frame.can_extended = header.extended != 0;
  frame.can_remote = header.remote != 0;
  frame.source = {recording::IpAddress::v6(header.source), header.source_port};
  frame.destination = {recording::IpAddress::v6(header.destination), header.destination_port};
  frame.payload = payload;
  return true;
}

}  // namespace

TunnelLink::TunnelLink(std::string path, LinkEvents events)
    : path_(std::move(path)),
      name_("replay tunnel " + path_),
      events_(std::move(events)),
      buffer_(protocol::kMaxPayload + sizeof(protocol::RecordHeader)) {}

TunnelLink::~TunnelLink() {
  if (listener_.is_open()) ::unlink(path_.c_str());
}

bool TunnelLink::fail(const std::string& what) {
  events_.on_fault(Fault::kLink, name_ + ": " + what);
  listener_.reset();
  return false;
}

bool TunnelLink::open() {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (path_.size() >= sizeof(address.sun_path)) return fail("path is longer than 107 characters");
  std::strncpy(address.sun_path, path_.c_str(), sizeof(address.sun_path) - 1);
  std::error_code error;
  std::filesystem::create_directories(std::filesystem::path(path_).parent_path(), error);
  listener_ = Socket(socket(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!listener_.is_open()) return fail("cannot make a socket: " + last_error());
  ::unlink(path_.c_str());  // left by a killed gateway
  if (bind(listener_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 ||
      listen(listener_.get(), 1) != 0) {
    return fail("cannot listen: " + last_error());
  }
  // The replay may run as another user of the same group.
  ::chmod(path_.c_str(), 0660);
  return true;
}

int TunnelLink::descriptor() const {
  return replay_.is_open() ? replay_.get() : listener_.get();
}

void TunnelLink::read() {
  if (!replay_.is_open()) accept_replay();
  if (replay_.is_open()) read_records();
}

void TunnelLink::accept_replay() {
  replay_ = Socket(accept4(listener_.get(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
  clock_.reset();
}

void TunnelLink::read_records() {
  for (int i = 0; i < kTunnelFramesPerTurn; ++i) {
    const ssize_t length = recv(replay_.get(), buffer_.data(), buffer_.size(), 0);
    if (length < 0 && (errno == EAGAIN || errno == EINTR)) return;
    if (length <= 0) {
      replay_.reset();
      events_.on_end();
      return;
    }
    recording::Frame frame;
    if (!parse_record({buffer_.data(), static_cast<std::size_t>(length)}, frame)) {
      events_.on_fault(Fault::kWireValue, "record of the replay tunnel is contradictory");
      continue;
    }
    bool jumped = false;
    const FrameStamp stamp = clock_.map(frame.stamp_ns, runtime::monotonic_now_ns(), jumped);
    if (jumped) events_.on_fault(Fault::kTimeJump, "the recording's time jumped; its clock was set again");
    events_.on_frame(frame, stamp);
  }
}

}  // namespace boresight::ingest
