// One UDP socket: receives datagrams to a local address or a multicast group, and sends from there.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "services/ingest_gateway/links/link.hpp"
#include "services/ingest_gateway/links/socket.hpp"

namespace boresight::ingest {

/// Sharing of a socket's address with sockets of other processes.
enum class Sharing : std::uint8_t {
  kOrdinary,
  /// The unicast port of service discovery. The kernel delivers unicast to one socket only. While another stack of this
  /// host uses the port, whichever started first, this link leaves the port to it and uses a separate one.
  kPolite,
};

class UdpLink : public Link {
 public:
  /// `local`: address to bind, or multicast group to join (on the interface of that name, or the kernel's choice if
  /// empty).
  UdpLink(const recording::Endpoint& local, std::string interface, LinkEvents events,
          Sharing sharing = Sharing::kOrdinary);

  bool open() override;
  [[nodiscard]] int descriptor() const override { return socket_.get(); }
  void read() override;
  void check() override;
  void close() { socket_.reset(); }
  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] const recording::Endpoint& local() const { return local_; }

  /// One more source uses this link; the receive buffer grows for its bursts.
  void add_user();

  /// Sends one datagram; multicast leaves by the link's interface. A failed send is a
  /// fault, reported once until a send succeeds.
  bool send(const recording::Endpoint& to, std::span<const std::uint8_t> payload);

 private:
  bool fail(const std::string& what);
  [[nodiscard]] bool is_v6() const { return !local_.address.is_v4() && !local_.address.is_unspecified(); }
  [[nodiscard]] bool bind_local();
  [[nodiscard]] bool join_group(unsigned interface_index);
  void choose_outgoing_interface(unsigned interface_index);
  void reserve_receive_buffer();
  [[nodiscard]] bool is_taken_by_another() const;
  [[nodiscard]] bool is_shared_with_another() const;
  recording::Endpoint local_;
  std::string interface_;
  Sharing sharing_;
  std::string name_;
  LinkEvents events_;
  Socket socket_;
  unsigned interface_index_ = 0;
  std::uint32_t kernel_drops_ = 0;
  unsigned users_ = 1;
  bool buffer_reported_ = false;
  bool has_own_port_ = false;  // because another stack uses the configured one
  bool sharing_reported_ = false;
  bool sending_fails_ = false;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace boresight::ingest
