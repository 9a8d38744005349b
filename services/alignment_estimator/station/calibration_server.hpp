// Serves the calibration service (interfaces/wire/calibration_service.md) from the node's event loop. Its sockets are
// polled between scans, without waiting.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "services/alignment_estimator/core/plate/seed.hpp"
#include "services/alignment_estimator/station/core/calibration_service.hpp"
#include "services/alignment_estimator/station/settings.hpp"
#include "services/common/runtime/discovery_server.hpp"
#include "services/common/runtime/node.hpp"
#include "services/common/runtime/udp_socket.hpp"

namespace boresight::alignment::station {

class CalibrationServer : private Surroundings {
 public:
  /// Passes a valid result to the dynamic estimator; true if the estimator starts from it.
  using TakeOver = std::function<bool(const RotationSeed&)>;

  /// Does nothing unless the settings enable it. A missing network is a fault of the node (kLink) and retried every
  /// second.
  CalibrationServer(runtime::Node& node, const VehicleConfig& vehicle, const Settings& settings, TakeOver take_over);
  /// Withdraws the offer from service discovery.
  ~CalibrationServer() override;
  CalibrationServer(const CalibrationServer&) = delete;
  CalibrationServer& operator=(const CalibrationServer&) = delete;

  void add_scan(const RadarScan& scan);
  void add_ego_motion(const EgoMotion& motion);

 private:
  struct Network {
    unsigned interface_index;
    runtime::UdpSocket socket;
    runtime::DiscoveryServer discovery;
  };
  void answer(std::span<const std::uint8_t> message) override;
  void fault(Fault kind, std::string_view what) override;
  bool take_over(std::uint32_t radar_id, const plate::PlateResult& result) override;

  void serve();
  void receive(std::int64_t now_ns);
  void send(const recording::Endpoint& to, std::span<const std::uint8_t> message);
  /// Opens the sockets; reopens them if the interface was replaced.
  void check_network();
  void close_network();

  runtime::Node& node_;
  VehicleConfig vehicle_;
  Settings settings_;
  TakeOver take_over_;
  CalibrationService service_;
  std::unique_ptr<Network> network_;
  recording::Endpoint asker_;  ///< receiver of answers
  bool network_fault_reported_ = false;
  std::vector<std::uint8_t> buffer_;
};

}  // namespace boresight::alignment::station
