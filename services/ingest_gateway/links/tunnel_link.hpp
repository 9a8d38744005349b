// Receiving end of the replay tunnel: frames of a recording instead of those of the network.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "services/ingest_gateway/links/link.hpp"
#include "services/ingest_gateway/links/socket.hpp"

namespace boresight::ingest {

/// Listens on a Unix socket; serves one replay at a time, the next one waits until the first has ended.
class TunnelLink : public Link {
 public:
  TunnelLink(std::string path, LinkEvents events);
  ~TunnelLink() override;

  bool open() override;
  /// The connection to a replay if there is one, else the listening socket.
  [[nodiscard]] int descriptor() const override;
  void read() override;
  [[nodiscard]] const std::string& name() const override { return name_; }

 private:
  bool fail(const std::string& what);
  void accept_replay();
  void read_records();
  std::string path_;
  std::string name_;
  LinkEvents events_;
  Socket listener_;
  Socket replay_;
  RecordingClock clock_;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace boresight::ingest
