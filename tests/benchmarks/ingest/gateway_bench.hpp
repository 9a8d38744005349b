// The gateway in memory, supplied with traffic cycle by cycle.
#pragma once

#include <cstdint>

#include "services/ingest_gateway/core/gateway.hpp"
#include "tests/benchmarks/ingest/traffic.hpp"
#include "tests/unit/ingest_gateway/memory_sink.hpp"

namespace boresight::bench {

/// Sources and destinations of the traffic.
inline const recording::Endpoint kArs548Sensor{recording::IpAddress::v4(0x0A0D0171), 42102};
inline const recording::Endpoint kArs548Group{recording::IpAddress::v4(0xE0000202), 42102};
inline const recording::Endpoint kServer{recording::IpAddress::v4(0x0A0D0201), 30601};
inline const recording::Endpoint kEcu{recording::IpAddress::v4(0x0A0D0002), 30600};

/// A vehicle with Toyota's ego signals on can0 and the given radar.
[[nodiscard]] inline VehicleConfig vehicle_with(const RadarConfig& radar) {
  VehicleConfig vehicle;
  vehicle.ego.source.interface = "can0";
  vehicle.radars.push_back(radar);
  vehicle.radars.back().id = 1;
  return vehicle;
}
[[nodiscard]] inline VehicleConfig ars548_vehicle() {
  RadarConfig radar;
  radar.profile = RadarProfile::kArs548;
  radar.source = {LinkKind::kUdp, "", "224.0.2.2", kArs548Group.port, "10.13.1.113"};
  return vehicle_with(radar);
}
[[nodiscard]] inline VehicleConfig can_vehicle(RadarProfile profile) {
  RadarConfig radar;
  radar.profile = profile;
  radar.source.interface = "can1";
  return vehicle_with(radar);
}
/// An instance of the Boresight service at a known endpoint, protected by profile 7 if asked for.
[[nodiscard]] inline VehicleConfig someip_vehicle(bool protection) {
  RadarConfig radar;
  radar.profile = RadarProfile::kBoresight;
  radar.source = {LinkKind::kSomeIp, "", "10.13.0.2", kEcu.port, "10.13.2.1", kServer.port, 1};
  radar.e2e.required = protection;
  radar.e2e.protection = {
      .profile = e2e::Profile::kP07, .data_id = 0x42530101, .offset_bytes = 8, .max_delta_counter = 50};
  return vehicle_with(radar);
}

struct GatewayBench {
  explicit GatewayBench(const VehicleConfig& vehicle, const ingest::Mappings& mappings = {})
      : gateway(vehicle, sink, mappings) {}

  /// Passes in one cycle that ends now; the sensors' clock is kEpochOffset_ns ahead.
  void take(const Traffic& traffic) {
    for (const recording::Frame& frame : traffic.frames()) {
      gateway.take(frame, {now_ns, kEpochOffset_ns, TimeSource::kLinkArrival});
    }
  }
  void next_cycle() { now_ns += kCycle_ns; }
  [[nodiscard]] std::int64_t epoch_ns() const { return now_ns + kEpochOffset_ns - kLatency_ns; }

  static constexpr std::int64_t kCycle_ns = 50'000'000, kLatency_ns = 10'000'000;
  static constexpr std::int64_t kEpochOffset_ns = 1'700'000'000'000'000'000;
  std::int64_t now_ns = 1'000'000'000;
  ingest::MemorySink sink;
  ingest::Gateway gateway;
};

}  // namespace boresight::bench
