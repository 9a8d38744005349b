// Tables of simulated calibrations in a folder of their own.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>

#include <arpa/inet.h>
#include <fmt/format.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/simulator/alignment/plate.hpp"
#include "services/simulator/wire/ars548_encoder.hpp"
#include "services/simulator/wire/pcap_writer.hpp"

namespace boresight::calibrate::testing {

/// A folder that lives as long as this does.
class Folder {
 public:
  Folder() {
    std::string name = (std::filesystem::temp_directory_path() / "boresight_calibrate_XXXXXX").string();
    if (mkdtemp(name.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = name;
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  [[nodiscard]] std::string path(const std::string& name) const { return (path_ / name).string(); }
  [[nodiscard]] std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name)) << text;
    return path(name);
  }
  [[nodiscard]] std::string read(const std::string& name) const {
    std::ifstream file(path(name));
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  std::filesystem::path path_;
};

inline std::string plate_table(const simulator::PlateSpec& spec, std::uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  const alignment::plate::Measurements run = simulator::simulate_plate(spec, random);
  std::string text = "# simulated\ntilt_deg,scan,amplitude_db,azimuth_deg\n";
  for (std::size_t i = 0; i < run.number_of_tilts; ++i) {
    const alignment::plate::TiltMeasurement& tilt = run.tilts[i];
    for (std::size_t k = 0; k < tilt.scans; ++k) {
      text += fmt::format("{},{},{},{}\n", tilt.tilt_rad * kDegreesPerRadian, k, tilt.amplitude_db[k],
                          tilt.azimuth_rad[k] * kDegreesPerRadian);
    }
  }
  return text;
}

/// The same run as the radar sends it, beside a radar that sees the plate elsewhere, into `pcap`; returns the table of
/// its tilts. Between them the plate moves and answers louder than it ever does at rest.
inline std::string record_plate(const simulator::PlateSpec& spec, const VehicleConfig& vehicle, std::uint32_t radar,
                                const std::string& pcap, std::uint64_t seed = 1) {
  using simulator::wire::Endpoint;
  constexpr std::int64_t kCycle_ns = 50'000'000;
  constexpr std::size_t kScansOfMove = 10;
  std::mt19937_64 random(seed);
  const alignment::plate::Measurements run = simulator::simulate_plate(spec, random);
  simulator::wire::PcapWriter writer(pcap);
  const auto scan = std::make_unique<RadarScan>();
  const auto list = std::make_unique<simulator::wire::Ars548List>();
  std::int64_t time_ns = 1'700'000'000'000'000'000;
  std::uint32_t cycle = 0;
  const auto endpoint = [](const std::string& address, std::uint16_t port) {
    return Endpoint{ntohl(inet_addr(address.c_str())), port};
  };
  const auto send = [&](const RadarConfig& sender, double amplitude_db, double azimuth_rad) {
    simulator::fill_plate_scan(amplitude_db, azimuth_rad, time_ns, *scan);
    scan->cycle_counter = cycle;
    simulator::wire::encode_ars548(*scan, time_ns, *list);
    writer.write(time_ns + 20'000'000, endpoint(sender.source.sender, sender.source.port),
                 endpoint(sender.source.address, sender.source.port), *list);
  };
  const auto step = [&](double amplitude_db, double azimuth_rad) {
    ++cycle;
    for (const RadarConfig& each : vehicle.radars) {
      if (each.id == radar) send(each, amplitude_db, azimuth_rad);
      if (each.id == radar + 1) send(each, 10.0, -0.05 + 0.0001 * (cycle % 7));
    }
    time_ns += kCycle_ns;
  };
  std::string tilts = "tilt_deg,begin_s,end_s\n";
  for (std::size_t i = 0; i < run.number_of_tilts; ++i) {
    const alignment::plate::TiltMeasurement& tilt = run.tilts[i];
    for (std::size_t k = 0; k < kScansOfMove; ++k) step(35.0, 0.1 + 0.001 * static_cast<double>(k));
    const std::int64_t begin_ns = time_ns - kCycle_ns / 2;
    for (std::size_t k = 0; k < tilt.scans; ++k) step(tilt.amplitude_db[k], tilt.azimuth_rad[k]);
    const auto seconds = [](std::int64_t ns) {
      return fmt::format("{}.{:03}", ns / 1'000'000'000, ns / 1'000'000 % 1000);
    };
    tilts += fmt::format("{},{},{}\n", tilt.tilt_rad * kDegreesPerRadian, seconds(begin_ns),
                         seconds(time_ns - kCycle_ns / 2));
  }
  return tilts;
}

/// Twelve reflectors along the driving direction, `beside_m` to the left, as seen without noise by a radar.
inline std::string reflector_table(const MountingPose& pose, double yaw_deg, double pitch_deg, double beside_m,
                                   bool with_elevation = true) {
  std::string text =
      with_elevation ? "x_m,y_m,z_m,range_m,azimuth_deg,elevation_deg\n" : "x_m,y_m,z_m,range_m,azimuth_deg\n";
  const Eigen::Matrix3d actual =
      geometry::sensor_to_vehicle(pose, yaw_deg / kDegreesPerRadian, pitch_deg / kDegreesPerRadian, 0.0);
  for (int i = 0; i < 12; ++i) {
    const Eigen::Vector3d place(10.0 + 3.0 * i, beside_m, pose.position_m[2]);
    const Eigen::Vector3d way = actual.transpose() * (place - Eigen::Vector3d(pose.position_m.data()));
    text += fmt::format("{},{},{},{},{}", place.x(), place.y(), place.z(), way.norm(),
                        std::atan2(way.y(), way.x()) * kDegreesPerRadian);
    text += with_elevation ? fmt::format(",{}\n", std::asin(way.z() / way.norm()) * kDegreesPerRadian) : "\n";
  }
  return text;
}

}  // namespace boresight::calibrate::testing
