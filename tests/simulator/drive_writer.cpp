#include "tests/simulator/drive_writer.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <stdexcept>
#include <string>

#include <arpa/inet.h>

#include "tests/simulator/drive.hpp"
#include "tests/simulator/text_file.hpp"
#include "tests/simulator/wire/ars548_encoder.hpp"
#include "tests/simulator/wire/pcap_writer.hpp"
#include "tests/simulator/wire/toyota_encoder.hpp"

namespace boresight::simulator {

namespace {

constexpr std::int64_t kRadarLatency_ns = 20'000'000;  // from measurement to the last fragment on the wire

const char* name_of(Provenance provenance) {
  switch (provenance) {
    case Provenance::kMoving:
      return "moving";
    case Provenance::kStationary:
      return "stationary";
    case Provenance::kGhostType1:
      return "ghost_type_1";
    case Provenance::kGhostType2:
      return "ghost_type_2";
    case Provenance::kClutter:
      return "clutter";
    case Provenance::kUnknown:
      return "unknown";
  }
  return "unknown";
}

const char* name_of(BodyKind kind) {
  switch (kind) {
    case BodyKind::kCar:
      return "car";
    case BodyKind::kVan:
      return "van";
    case BodyKind::kTruck:
      return "truck";
    case BodyKind::kPedestrian:
      return "pedestrian";
    case BodyKind::kCyclist:
      return "cyclist";
  }
  return "unknown";
}

wire::Endpoint endpoint(const std::string& address, std::uint16_t port) {
  in_addr ip{};
  if (inet_pton(AF_INET, address.c_str(), &ip) != 1) {
    throw std::invalid_argument("the simulator needs a sender address for each radar");
  }
  return {ntohl(ip.s_addr), port};
}

using ScanCounts = std::array<std::size_t, kMaxRadars + 1>;  // by radar id

void write_truth(const std::filesystem::path& file, const Scenario& scenario, const VehicleConfig& vehicle,
                 const ScanCounts& scans) {
  constexpr double kDegrees = 180.0 / M_PI;
  const TextFile out(file);
  std::fprintf(out.get(), "quantity,radar,value,unit\nspeed_scale,,%.6f,1\n", scenario.effects.speed_scale);
  for (const RadarConfig& radar : vehicle.radars) {
    const Misalignment& m = scenario.effects.misalignment[radar.id];
    std::fprintf(out.get(), "alignment_yaw,%u,%.6f,deg\nalignment_pitch,%u,%.6f,deg\nalignment_roll,%u,%.6f,deg\n",
                 radar.id, m.yaw_rad * kDegrees, radar.id, m.pitch_rad * kDegrees, radar.id, m.roll_rad * kDegrees);
    std::fprintf(out.get(), "scans,%u,%zu,1\n", radar.id, scans[radar.id]);
  }
  out.finish();
}

void write_objects(std::FILE* out, const Drive& drive, double t_s) {
  const EgoState ego = drive.ego(t_s);
  const double c = std::cos(ego.heading_rad), s = std::sin(ego.heading_rad);
  Eigen::Matrix2d to_vehicle;
  to_vehicle << c, s, -s, c;
  for (std::size_t i = 0; i < drive.world().number_of_bodies(); ++i) {
    const Body b = drive.world().body(i, t_s);
    const Eigen::Vector2d position = to_vehicle * (b.position_m - ego.position_m);
    if (position.norm() > 150.0) continue;
    const Eigen::Vector2d velocity = to_vehicle * b.velocity_mps;
    std::fprintf(out, "%.4f,%u,%.3f,%.3f,%.5f,%.3f,%.3f,%.2f,%.2f,%.2f,%s,%d\n", t_s, b.id, position.x(), position.y(),
                 std::remainder(b.heading_rad - ego.heading_rad, 2.0 * M_PI), velocity.x(), velocity.y(), b.length_m,
                 b.width_m, b.height_m, name_of(b.kind), b.parked ? 1 : 0);
  }
}

}  // namespace

DriveFiles write_drive(const Scenario& scenario, const VehicleConfig& vehicle, std::uint64_t seed, double duration_s,
                       const std::filesystem::path& folder, const std::function<void(double)>& progress) {
  for (const RadarConfig& radar : vehicle.radars) {
    if (radar.profile != RadarProfile::kArs548) {
      throw std::invalid_argument("the simulator speaks the ARS548 profile only; radar " + radar.name + " has another");
    }
  }
  std::filesystem::create_directories(folder);
  DriveFiles files{folder / "radars.pcap",
                   folder / "ego.candump.log",
                   folder / "truth.csv",
                   folder / "truth_detections.csv",
                   folder / "truth_objects.csv",
                   0,
                   0};
  wire::PcapWriter pcap(files.radars);
  const TextFile ego_log(files.ego), detections(files.detections), objects(files.objects);
  std::fputs("t_s,radar,scan,index,provenance,object\n", detections.get());
  std::fputs(
      "t_s,object,x_vehicle_m,y_vehicle_m,heading_rad,vx_over_ground_mps,vy_over_ground_mps,length_m,width_m,"
      "height_m,kind,parked\n",
      objects.get());
  Drive drive(scenario, vehicle, seed, duration_s);
  const auto list = std::make_unique<wire::Ars548List>();
  double next_objects_s = 0.0;
  ScanCounts scans{};
  while (const Event* event = drive.next()) {
    if (event->scan == nullptr) {
      if (event->t_s >= next_objects_s) {
        write_objects(objects.get(), drive, event->t_s);
        next_objects_s += 0.1;
        progress(event->t_s / duration_s);
      }
      for (const wire::CanFrame& frame : wire::encode_ego(event->ego)) {
        std::fprintf(ego_log.get(), "(%lld.%06lld) %s %03X#", static_cast<long long>(event->time_ns / 1'000'000'000),
                     static_cast<long long>(event->time_ns % 1'000'000'000 / 1000),
                     vehicle.ego.source.interface.c_str(), frame.id);
        for (const std::uint8_t byte : frame.bytes) std::fprintf(ego_log.get(), "%02X", byte);
        std::fputc('\n', ego_log.get());
      }
      continue;
    }
    const RadarConfig& radar = *vehicle.radar(event->scan->header.source_id);
    wire::encode_ars548(*event->scan, event->time_ns, *list);
    pcap.write(event->time_ns + kRadarLatency_ns, endpoint(radar.source.sender, radar.source.port),
               endpoint(radar.source.address, radar.source.port), *list);
    for (std::size_t i = 0; i < event->truth->size(); ++i) {
      const DetectionTruth& truth = (*event->truth)[i];
      std::fprintf(detections.get(), "%.6f,%u,%llu,%zu,%s,%u\n", event->t_s, radar.id,
                   static_cast<unsigned long long>(event->scan->header.source_sequence), i, name_of(truth.provenance),
                   truth.object_id);
    }
    ++files.scans;
    ++scans[radar.id];
    files.number_of_detections += event->truth->size();
  }
  for (const TextFile* file : {&ego_log, &detections, &objects}) file->finish();
  write_truth(files.truth, scenario, vehicle, scans);
  progress(1.0);
  return files;
}

}  // namespace boresight::simulator
