// Reports changes of this host's interfaces and addresses at once.
#pragma once

#include <functional>
#include <string>

#include "services/ingest_gateway/links/link.hpp"
#include "services/ingest_gateway/links/socket.hpp"

namespace boresight::ingest {

/// True if the interface exists, is up and has a carrier.
[[nodiscard]] bool is_running(const std::string& interface);

/// The kernel's messages about its network interfaces (rtnetlink). Their content is not used: the callback reads the
/// state itself.
class NetworkWatch : public Link {
 public:
  NetworkWatch(std::function<void()> on_change, LinkEvents events)
      : on_change_(std::move(on_change)), events_(std::move(events)) {}

  bool open() override;
  [[nodiscard]] int descriptor() const override { return socket_.get(); }
  void read() override;
  [[nodiscard]] const std::string& name() const override { return name_; }

 private:
  std::string name_ = "network watch";
  std::function<void()> on_change_;
  LinkEvents events_;
  Socket socket_;
  bool failure_reported_ = false;
};

}  // namespace boresight::ingest
