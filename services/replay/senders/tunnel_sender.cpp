#include <cerrno>
#include <chrono>
#include <cstring>
#include <stdexcept>
#include <thread>

#include <linux/sockios.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/uio.h>
#include <sys/un.h>
#include <unistd.h>

#include "interfaces/wire/replay_tunnel.hpp"
#include "services/common/runtime/stop_signal.hpp"
#include "services/replay/senders/sender.hpp"

namespace boresight::replay {

namespace protocol = wire::replay_tunnel;

namespace {

class TunnelSender : public Sender {
 public:
  TunnelSender(std::string path, double wait_s) : path_(std::move(path)) {
    using Clock = std::chrono::steady_clock;
    const auto deadline = Clock::now() + std::chrono::duration<double>(wait_s);
    while (!connect_now()) {
      if (runtime::stop_signalled()) throw std::runtime_error("stopped while waiting for the gateway");
      if (Clock::now() >= deadline) throw std::runtime_error(path_ + ": no gateway listens: " + std::strerror(errno));
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }
  ~TunnelSender() override { disconnect(); }
  TunnelSender(const TunnelSender&) = delete;
  TunnelSender& operator=(const TunnelSender&) = delete;

  bool send(const recording::Frame& frame) override {
    if (descriptor_ < 0 && !connect_now()) return false;
    protocol::RecordHeader header{};
    header.magic = protocol::kMagic;
    header.kind = static_cast<std::uint8_t>(frame.kind);
    header.extended = frame.can_extended ? 1 : 0;
    header.remote = frame.can_remote ? 1 : 0;
    header.stamp_ns = frame.stamp_ns;
    std::memcpy(header.interface, frame.interface.data(), sizeof(header.interface));
    header.can_id = frame.can_id;
    std::memcpy(header.source, frame.source.address.bytes.data(), sizeof(header.source));
    std::memcpy(header.destination, frame.destination.address.bytes.data(), sizeof(header.destination));
    header.source_port = frame.source.port;
    header.destination_port = frame.destination.port;
    header.payload_bytes = static_cast<std::uint32_t>(frame.payload.size());
    iovec parts[2] = {{&header, sizeof(header)},
                      {const_cast<std::uint8_t*>(frame.payload.data()), frame.payload.size()}};
    msghdr message{};
    message.msg_iov = parts;
    message.msg_iovlen = 2;
    while (sendmsg(descriptor_, &message, MSG_NOSIGNAL) < 0) {
      if (errno == EINTR && !runtime::stop_signalled()) continue;
      disconnect();
      return false;
    }
    return true;
  }

  bool all_read() override {
    int unread_bytes = 0;
    return descriptor_ < 0 || ioctl(descriptor_, SIOCOUTQ, &unread_bytes) != 0 || unread_bytes == 0;
  }

 private:
  bool connect_now() {
    descriptor_ = socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0);
    if (descriptor_ < 0) throw std::runtime_error(std::string("cannot make a socket: ") + std::strerror(errno));
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, path_.c_str(), sizeof(address.sun_path) - 1);
    if (connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) == 0) return true;
    const int cause = errno;
    disconnect();
    errno = cause;
    return false;
  }
  void disconnect() {
    if (descriptor_ >= 0) ::close(descriptor_);
    descriptor_ = -1;
  }
  std::string path_;
  int descriptor_ = -1;
};

}  // namespace

std::unique_ptr<Sender> make_tunnel_sender(const std::string& path, double wait_s) {
  return std::make_unique<TunnelSender>(path, wait_s);
}

}  // namespace boresight::replay
