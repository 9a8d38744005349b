// The UDP sockets of a SOME/IP server.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "services/common/recording/ip_address.hpp"

namespace boresight::runtime {

/// Owns a non-blocking UDP socket. All functions that open one throw std::runtime_error with the cause.
class UdpSocket {
 public:
  /// Bound to a local address; sends multicast on `interface` with that time to live.
  [[nodiscard]] static UdpSocket bound_to(const recording::Endpoint& local, const std::string& interface, int hops);
  /// Receives only datagrams to a multicast group on `interface`.
  [[nodiscard]] static UdpSocket member_of(const recording::Endpoint& group, const std::string& interface);

  UdpSocket(UdpSocket&& other) noexcept;
  UdpSocket& operator=(UdpSocket&&) = delete;
  ~UdpSocket();

  [[nodiscard]] int descriptor() const { return descriptor_; }
  /// False if the kernel did not accept it: the link is down, or its queue is full.
  [[nodiscard]] bool send(const recording::Endpoint& to, std::span<const std::uint8_t> datagram) const;
  /// The next datagram, written into `buffer`; nothing if there is none.
  [[nodiscard]] std::optional<std::span<const std::uint8_t>> receive(std::span<std::uint8_t> buffer,
                                                                     recording::Endpoint& from) const;

 private:
  UdpSocket(const recording::Endpoint& local, const std::string& interface);
  void set(int level, int option, const void* value, std::size_t bytes, const char* what) const;
  void bind_to(const recording::Endpoint& local) const;
  [[nodiscard]] std::string name() const;

  recording::Endpoint local_;
  bool v4_;
  unsigned interface_index_;
  int descriptor_;
};

}  // namespace boresight::runtime
