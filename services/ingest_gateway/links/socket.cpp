#include "services/ingest_gateway/links/socket.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>

#include <linux/net_tstamp.h>
#include <unistd.h>

#include "services/common/runtime/clock.hpp"

namespace boresight::ingest {

void Socket::reset() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = -1;
}

void request_stamps_and_drops(int descriptor) {
  const int flags = SOF_TIMESTAMPING_RX_SOFTWARE | SOF_TIMESTAMPING_SOFTWARE;
  setsockopt(descriptor, SOL_SOCKET, SO_TIMESTAMPING, &flags, sizeof(flags));
  const int on = 1;
  setsockopt(descriptor, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof(on));
}

int request_receive_buffer(int descriptor, int bytes) {
  if (setsockopt(descriptor, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof(bytes)) != 0) {
    setsockopt(descriptor, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof(bytes));
  }
  int given = 0;
  socklen_t length = sizeof(given);
  getsockopt(descriptor, SOL_SOCKET, SO_RCVBUF, &given, &length);
  return given / 2;  // the kernel reports twice what it was asked for, for its own book-keeping
}

FrameStamp read_control(const msghdr& message, std::uint32_t& drops) {
  const std::int64_t now_ns = runtime::monotonic_now_ns();
  const std::int64_t offset_ns = runtime::realtime_now_ns() - now_ns;
  FrameStamp stamp{now_ns, offset_ns, TimeSource::kUserArrival};
  for (const cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr;
       c = CMSG_NXTHDR(const_cast<msghdr*>(&message), const_cast<cmsghdr*>(c))) {
    if (c->cmsg_level != SOL_SOCKET) continue;
    if (c->cmsg_type == SO_RXQ_OVFL) {
      std::memcpy(&drops, CMSG_DATA(c), sizeof(drops));
    } else if (c->cmsg_type == SO_TIMESTAMPING) {
      timespec software{};
      std::memcpy(&software, CMSG_DATA(c), sizeof(software));
      const std::int64_t kernel_ns = static_cast<std::int64_t>(software.tv_sec) * 1'000'000'000 + software.tv_nsec;
      if (kernel_ns == 0) continue;
      stamp.received_ns = kernel_ns - offset_ns;
      stamp.source = TimeSource::kLinkArrival;
    }
  }
  return stamp;
}

FrameStamp stamp_and_drops(const msghdr& message, std::uint32_t& drops, std::string_view of_what,
                           const LinkEvents& events) {
  const std::uint32_t drops_before = drops;
  const FrameStamp stamp = read_control(message, drops);
  if (drops != drops_before) {
    std::array<char, 128> text{};
    std::snprintf(text.data(), text.size(), "the kernel dropped %u %.*s: its receive buffer was full",
                  drops - drops_before, static_cast<int>(of_what.size()), of_what.data());
    events.on_fault(Fault::kLink, text.data());
  }
  return stamp;
}

std::string last_error() {
  return std::strerror(errno);
}

}  // namespace boresight::ingest
