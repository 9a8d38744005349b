// One UDP port, unicast or multicast, for the radars that send to it.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "services/ingest_gateway/links/link.hpp"
#include "services/ingest_gateway/links/socket.hpp"

namespace boresight::ingest {

class UdpLink : public Link {
 public:
  /// `address`: local address to bind, or multicast group to join (on the interface of that name, or the kernel's
  /// choice if empty).
  UdpLink(std::string address, std::uint16_t port, std::string interface, LinkEvents events);

  bool open() override;
  [[nodiscard]] int descriptor() const override { return socket_.get(); }
  void read() override;
  [[nodiscard]] const std::string& name() const override { return name_; }

 private:
  bool fail(const std::string& what);
  std::string address_;
  std::uint16_t port_;
  std::string interface_;
  std::string name_;
  LinkEvents events_;
  Socket socket_;
  std::uint32_t address_host_ = 0;
  std::uint32_t kernel_drops_ = 0;
  bool buffer_reported_ = false;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace boresight::ingest
