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
  return given / 2;  // the kernel reports twice the requested size, for its own book-keeping
}

namespace {

void read_control(msghdr& message, Reception& reception) {
  const std::int64_t now_ns = runtime::monotonic_now_ns();
  const std::int64_t offset_ns = runtime::realtime_now_ns() - now_ns;
  reception.stamp = {now_ns, offset_ns, TimeSource::kUserArrival};
  for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
    if (c->cmsg_level != SOL_SOCKET) continue;
    if (c->cmsg_type == SO_RXQ_OVFL) {
      std::memcpy(&reception.drops, CMSG_DATA(c), sizeof(reception.drops));
    } else if (c->cmsg_type == SO_TIMESTAMPING) {
      timespec software{};
      std::memcpy(&software, CMSG_DATA(c), sizeof(software));
      const std::int64_t kernel_ns = static_cast<std::int64_t>(software.tv_sec) * 1'000'000'000 + software.tv_nsec;
      if (kernel_ns == 0) continue;
      reception.stamp.received_ns = kernel_ns - offset_ns;
      reception.stamp.source = TimeSource::kLinkArrival;
    }
  }
}

}  // namespace

ssize_t receive(const Socket& socket, std::span<std::uint8_t> buffer, Reception& reception) {
  iovec data{buffer.data(), buffer.size()};
  alignas(cmsghdr) std::array<char, 256> control{};
  msghdr message{};
  message.msg_name = &reception.sender;
  message.msg_namelen = sizeof(reception.sender);
  message.msg_iov = &data;
  message.msg_iovlen = 1;
  message.msg_control = control.data();
  message.msg_controllen = control.size();
  const ssize_t length = recvmsg(socket.get(), &message, MSG_DONTWAIT);
  if (length >= 0) read_control(message, reception);
  return length;
}

void report_drops(const Reception& reception, std::uint32_t& drops, std::string_view of_what,
                  const LinkEvents& events) {
  if (reception.drops == drops) return;
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(), "the kernel dropped %u %.*s: its receive buffer was full",
                reception.drops - drops, static_cast<int>(of_what.size()), of_what.data());
  drops = reception.drops;
  events.on_fault(Fault::kLink, text.data());
}

std::string last_error() {
  return std::strerror(errno);
}

}  // namespace boresight::ingest
