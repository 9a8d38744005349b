// One SocketCAN interface, classic and FD.
#pragma once

#include <string>

#include "services/ingest_gateway/links/link.hpp"
#include "services/ingest_gateway/links/socket.hpp"

namespace boresight::ingest {

class CanLink : public Link {
 public:
  CanLink(std::string interface, LinkEvents events);

  bool open() override;
  [[nodiscard]] int descriptor() const override { return socket_.get(); }
  void read() override;
  [[nodiscard]] const std::string& interface() const { return interface_; }
  /// A failed send is a fault, reported once until a send succeeds.
  void send(const recording::Frame& frame);
  [[nodiscard]] const std::string& name() const override { return name_; }

 private:
  bool fail(const std::string& what);
  std::string interface_;
  std::string name_;
  LinkEvents events_;
  Socket socket_;
  std::uint32_t kernel_drops_ = 0;
  bool sending_fails_ = false;
};

}  // namespace boresight::ingest
