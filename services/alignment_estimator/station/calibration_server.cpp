#include "services/alignment_estimator/station/calibration_server.hpp"

#include <numbers>
#include <stdexcept>
#include <utility>

#include <net/if.h>

#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/log.hpp"

namespace boresight::alignment::station {

namespace service = wire::calibration_service;

namespace {

/// The node polls its inputs with the same period.
constexpr std::int64_t kServePeriod_ns = 10'000'000;
constexpr std::int64_t kNetworkPeriod_ns = 1'000'000'000;
/// Limited, so that a flood of requests cannot delay scans by more than a hundred microseconds.
constexpr int kDatagramsPerTurn = 16;

double degrees(double angle_rad) {
  return angle_rad * 180.0 / std::numbers::pi;
}

someip::SdServerConfig offer_of(const Settings& settings) {
  someip::SdServerConfig config;
  config.service = {service::kServiceId, service::kMajorVersion, service::kMinorVersion, {service::kEventgroupState}};
  config.instances = {{settings.instance, {settings.address, settings.port}}};
  return config;
}

}  // namespace

CalibrationServer::CalibrationServer(runtime::Node& node, const VehicleConfig& vehicle, const Settings& settings,
                                     TakeOver take_over)
    : node_(node),
      vehicle_(vehicle),
      settings_(settings),
      take_over_(std::move(take_over)),
      service_(vehicle, settings.plate, settings.max_speed_mps) {
  if (!settings_.enabled) return;
  buffer_.resize(65536);
  check_network();
  node.every(kServePeriod_ns, [this] { serve(); });
  node.every(kNetworkPeriod_ns, [this] { check_network(); });
}

CalibrationServer::~CalibrationServer() {
  close_network();
}

void CalibrationServer::add_scan(const RadarScan& scan) {
  if (settings_.enabled) service_.add_scan(scan, runtime::monotonic_now_ns());
}

void CalibrationServer::add_ego_motion(const EgoMotion& motion) {
  if (settings_.enabled) service_.add_ego_motion(motion, runtime::monotonic_now_ns());
}

void CalibrationServer::serve() {
  const std::int64_t now_ns = runtime::monotonic_now_ns();
  if (network_) {
    network_->discovery.tick(now_ns);
    network_->discovery.receive();
    receive(now_ns);
  }
  service_.tick(now_ns);
  const std::span<const std::uint8_t> event = service_.event_if_changed(now_ns);
  if (event.empty() || !network_) return;
  for (const recording::Endpoint& subscriber :
       network_->discovery.destinations(settings_.instance, service::kEventgroupState, now_ns)) {
    send(subscriber, event);
  }
}

void CalibrationServer::receive(std::int64_t now_ns) {
  for (int i = 0; i < kDatagramsPerTurn; ++i) {
    const auto datagram = network_->socket.receive(buffer_, asker_);
    if (!datagram) return;
    service_.receive(*datagram, asker_, now_ns, *this);
  }
}

void CalibrationServer::answer(std::span<const std::uint8_t> message) {
  send(asker_, message);
}

void CalibrationServer::send(const recording::Endpoint& to, std::span<const std::uint8_t> message) {
  if (!network_->socket.send(to, message)) node_.fault(Fault::kLink, "calibration service: an answer was not sent");
}

void CalibrationServer::fault(Fault kind, std::string_view what) {
  node_.fault(kind, what);
}

bool CalibrationServer::take_over(std::uint32_t radar_id, const plate::PlateResult& result) {
  const RadarConfig* const radar = vehicle_.radar(radar_id);
  if (radar == nullptr) return false;
  RotationSeed seed;
  const bool taken_over = seed_from_plate(*radar, result.yaw_rad, result.yaw_std_rad, result.pitch_rad,
                                          result.pitch_std_rad, settings_.seed, seed) &&
                          take_over_(seed);
  runtime::log::info("radar {} calibrated with the plate: yaw {:+.3f}, pitch {:+.3f} deg, confidence {:.2f}; {}",
                     radar->name, degrees(result.yaw_rad), degrees(result.pitch_rad), result.self_consistency,
                     taken_over ? "the estimator starts from it" : "the estimator's method cannot start from it");
  return taken_over;
}

void CalibrationServer::check_network() {
  const unsigned index = if_nametoindex(settings_.interface.c_str());
  if (network_ && network_->interface_index == index) return;
  close_network();
  try {
    runtime::DiscoveryEvents events;
    events.on_problem = [this](const recording::IpAddress&, std::string_view what) {
      node_.fault(Fault::kWireValue, what);
    };
    events.on_new_subscriber = [this](const someip::SdServer::NewSubscriber& subscriber) {
      send(subscriber.endpoint, service_.event(runtime::monotonic_now_ns()));
    };
    network_ = std::unique_ptr<Network>(
        new Network{index,
                    runtime::UdpSocket::bound_to({settings_.address, settings_.port}, settings_.interface,
                                                 settings_.multicast_hops),
                    runtime::DiscoveryServer(
                        {settings_.interface, settings_.address, settings_.discovery_group, settings_.multicast_hops},
                        offer_of(settings_), std::move(events))});
    runtime::log::info("calibration service: offered at {} port {}", recording::to_text(settings_.address),
                       settings_.port);
    network_fault_reported_ = false;
  } catch (const std::runtime_error& problem) {
    if (!network_fault_reported_) node_.fault(Fault::kLink, problem.what());
    network_fault_reported_ = true;
  }
}

void CalibrationServer::close_network() {
  if (network_) network_->discovery.stop();
  network_.reset();
}

}  // namespace boresight::alignment::station
