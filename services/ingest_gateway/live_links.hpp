// Opens the vehicle's links and keeps them open: one per CAN interface and UDP address, which several sources may
// share, and those of service discovery.
#pragma once

#include <memory>
#include <vector>

#include "services/common/runtime/node.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/ingest_gateway/links/can_link.hpp"
#include "services/ingest_gateway/links/udp_link.hpp"

namespace boresight::ingest {

/// Owns the links and registers their current descriptors in the node.
class Links {
 public:
  Links(runtime::Node& node, LinkEvents events) : node_(node), events_(std::move(events)) {}

  [[nodiscard]] const LinkEvents& events() const { return events_; }
  void add(std::unique_ptr<Link> link);
  /// All links of the vehicle file.
  void add_live(const VehicleConfig& vehicle);
  /// Call each second: opens closed links again. Also called internally when the network has changed.
  void keep_open();

  /// Sends to the CAN interface or from the local UDP endpoint of the frame; UDP without a source uses a separate
  /// socket. A frame without an open link is dropped; the link has reported its fault.
  void send(const recording::Frame& frame);
  /// A group that a peer announced. Joins are counted: each join needs one leave.
  void join(const recording::Endpoint& group, std::string_view interface);
  void leave(const recording::Endpoint& group, std::string_view interface);

 private:
  struct Entry {
    std::unique_ptr<Link> link;
    int watched = -1;
  };
  struct Udp {
    recording::Endpoint local;
    std::string interface;
    UdpLink* link;
    unsigned users;
  };
  struct Interface {
    std::string name;
    bool running;
  };
  void add_udp(const recording::Endpoint& local, const std::string& interface, Sharing sharing);
  void watch(Entry& entry);
  [[nodiscard]] bool look_at_interfaces();
  runtime::Node& node_;
  LinkEvents events_;
  std::vector<std::unique_ptr<Entry>> entries_;
  std::vector<CanLink*> can_;
  std::vector<Udp> udp_;
  std::vector<Interface> interfaces_;            // of udp_
  std::vector<std::unique_ptr<Entry>> retired_;  // closed; one of them may be in use by the caller
  Socket sender_v4_;
  Socket sender_v6_;
  bool sending_fails_ = false;
};

}  // namespace boresight::ingest
