#include "services/simulator/drive_writer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <arpa/inet.h>

#include "services/simulator/drive.hpp"
#include "services/simulator/text_file.hpp"
#include "services/simulator/truth_tables.hpp"
#include "services/simulator/wire/ars548_encoder.hpp"
#include "services/simulator/wire/data_faults.hpp"
#include "services/simulator/wire/pcap_writer.hpp"
#include "services/simulator/wire/toyota_encoder.hpp"

namespace boresight::simulator {

namespace {

constexpr std::int64_t kStatusPeriod_ns = 1'000'000'000;
constexpr double kObjectsPeriod_s = 0.1;

wire::Endpoint endpoint(const std::string& address, std::uint16_t port) {
  in_addr ip{};
  if (inet_pton(AF_INET, address.c_str(), &ip) != 1) {
    throw std::invalid_argument("the simulator needs a sender and an address (IPv4) for each radar");
  }
  return {ntohl(ip.s_addr), port};
}

/// Refuses a radar id that the vehicle does not have: its disturbance would have no effect.
void expect_radar(const VehicleConfig& vehicle, const RadarEffects& effects, std::uint32_t id,
                  const std::string& what) {
  if (vehicle.radar(id) != nullptr) return;
  const auto named =
      std::find_if(effects.named.begin(), effects.named.end(), [id](const NamedRadar& n) { return n.id == id; });
  const std::string place = named == effects.named.end() ? "radars." + what + ".radar" : named->place;
  std::string known;
  for (const RadarConfig& radar : vehicle.radars) known += (known.empty() ? "" : ", ") + std::to_string(radar.id);
  throw std::invalid_argument(place + ": " + std::to_string(id) + " is no radar of the vehicle " + vehicle.name +
                              "; allowed: " + (known.empty() ? "none" : known));
}

void check(const Scenario& scenario, const VehicleConfig& vehicle) {
  if (vehicle.radars.empty()) throw std::invalid_argument("the vehicle " + vehicle.name + " has no radar");
  for (const RadarConfig& radar : vehicle.radars) {
    if (radar.profile != RadarProfile::kArs548) {
      throw std::invalid_argument("the simulator writes the ARS548 profile only; radar " + radar.name + " has another");
    }
    if (radar.e2e.required) {
      throw std::invalid_argument("the simulator writes no end-to-end protection, which radar " + radar.name +
                                  " requires");
    }
    static_cast<void>(endpoint(radar.source.sender, radar.source.port));
    static_cast<void>(endpoint(radar.source.address, radar.source.port));
  }
  if (vehicle.ego.profile != EgoProfile::kToyota) {
    throw std::invalid_argument("the simulator writes the Toyota profile of ego signals only; vehicle " + vehicle.name +
                                " has another");
  }
  const RadarEffects& e = scenario.effects;
  for (std::uint32_t id = 1; id < e.misalignment.size(); ++id) {
    const Misalignment& m = e.misalignment[id];
    if (m.yaw_rad != 0.0 || m.pitch_rad != 0.0 || m.roll_rad != 0.0) expect_radar(vehicle, e, id, "misalignment");
  }
  for (const RadarStepChange& step_change : e.step_changes) expect_radar(vehicle, e, step_change.radar, "step_change");
  for (const RadarBlockage& blockage : e.blockages) expect_radar(vehicle, e, blockage.radar, "blockage");
  for (const RadarInterference& i : e.interference) {
    if (i.radar != 0) expect_radar(vehicle, e, i.radar, "interference");
  }
  for (const RadarDataFault& f : e.data_faults) {
    if (f.radar != 0) expect_radar(vehicle, e, f.radar, "data_fault");
  }
  for (const ProfileOfRadar& other : e.profiles) expect_radar(vehicle, e, other.id, "profile_of");
}

void write_ego(const Event& event, const std::string& interface, std::FILE* log) {
  for (const wire::CanFrame& frame : wire::encode_ego(event.ego)) {
    std::fprintf(log, "(%lld.%06lld) %s %03X#", static_cast<long long>(event.time_ns / 1'000'000'000),
                 static_cast<long long>(event.time_ns % 1'000'000'000 / 1000), interface.c_str(), frame.id);
    for (const std::uint8_t byte : frame.bytes) std::fprintf(log, "%02X", byte);
    std::fputc('\n', log);
  }
}

/// Time from the measurement to the last fragment on the wire.
std::int64_t latency_ns(const radar::LatencySpec& latency, std::uint32_t detections) {
  return std::llround(1e9 * (latency.constant_s + latency.per_detection_s * detections));
}

/// The recording of the radars' network, in the order of transmission: a long list of one radar ends after a short one
/// of another radar that was measured later.
class RadarLog {
 public:
  explicit RadarLog(const std::filesystem::path& file) : pcap_(file) {}

  /// Adds the list that the radar sends for the event. A status message follows when the radar's condition has changed,
  /// and at least once a second. Events come in the order of measurement.
  void add(const Event& event, const RadarScan& list, const RadarConfig& radar, const radar::LatencySpec& latency) {
    write_until(event.time_ns);
    Pending& p = open_slot();
    p.from = endpoint(radar.source.sender, radar.source.port);
    p.to = endpoint(radar.source.address, radar.source.port);
    p.sent_ns = event.stamp_ns + latency_ns(latency, list.number_of_valid_detections);
    wire::encode_ars548(list, event.stamp_ns, *p.list);
    Status& last = last_status_.at(radar.id);
    p.condition = event.condition;
    p.with_status =
        last.sent_ns == 0 || last.condition != event.condition || p.sent_ns >= last.sent_ns + kStatusPeriod_ns;
    if (p.with_status) last = {p.sent_ns, event.condition};
  }
  /// Throws std::runtime_error if a write failed, as on a full disk.
  void finish() {
    write_until(std::numeric_limits<std::int64_t>::max());
    pcap_.finish();
  }

 private:
  struct Status {
    std::int64_t sent_ns = 0;
    std::uint32_t condition = 0;
  };
  /// A list that is still being transmitted.
  struct Pending {
    std::int64_t sent_ns = 0;
    wire::Endpoint from{}, to{};
    std::unique_ptr<wire::Ars548List> list = std::make_unique<wire::Ars548List>();
    std::uint32_t condition = 0;
    bool with_status = false;
  };

  /// Writes what was sent up to that time; of equal times, what was measured first.
  void write_until(std::int64_t time_ns) {
    std::stable_sort(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(used_),
                     [](const Pending& a, const Pending& b) { return a.sent_ns < b.sent_ns; });
    std::size_t written = 0;
    for (; written < used_ && pending_[written].sent_ns <= time_ns; ++written) {
      const Pending& p = pending_[written];
      pcap_.write(p.sent_ns, p.from, p.to, *p.list);
      if (p.with_status) pcap_.write(p.sent_ns, p.from, p.to, wire::encode_ars548_status(p.condition));
    }
    std::rotate(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(written),
                pending_.begin() + static_cast<std::ptrdiff_t>(used_));
    used_ -= written;
  }
  /// The buffers of lists are used again.
  Pending& open_slot() {
    if (used_ == pending_.size()) pending_.emplace_back();
    return pending_[used_++];
  }

  wire::PcapWriter pcap_;
  std::vector<Pending> pending_;
  std::size_t used_ = 0;                              // of pending_, in the order of measurement
  std::array<Status, kMaxRadars + 1> last_status_{};  // by radar id
};

}  // namespace

DriveFiles write_drive(const Scenario& scenario, const VehicleConfig& vehicle, std::uint64_t seed, double duration_s,
                       const std::filesystem::path& folder, const std::function<void(double)>& progress) {
  check(scenario, vehicle);
  Drive drive(scenario, vehicle, seed, duration_s);
  std::filesystem::create_directories(folder);
  DriveFiles files{folder / "radars.pcap",
                   folder / "ego.candump.log",
                   folder / "truth.csv",
                   folder / "truth_detections.csv",
                   folder / "truth_objects.csv",
                   folder / "truth_sensors.csv",
                   folder / "truth_visibility.csv",
                   0,
                   0};
  wire::DataFaults faults(scenario.effects.data_faults, seed);
  RadarLog radars(files.radars);
  const TextFile ego(files.ego);
  TruthTables truth(folder, scenario, vehicle, seed);
  double next_objects_s = 0.0;
  while (const Event* event = drive.next()) {
    if (event->scan == nullptr) {
      if (event->t_s >= next_objects_s) {
        truth.add_objects(drive, event->t_s);
        next_objects_s += kObjectsPeriod_s;
        progress(event->t_s / duration_s);
      }
      write_ego(*event, vehicle.ego.source.interface, ego.get());
      continue;
    }
    const RadarConfig& radar = *vehicle.radar(event->scan->header.source_id);
    const wire::SentList sent = faults.apply(*event->scan, radar, event->t_s);
    for (std::uint32_t i = 0; i < sent.times; ++i) {
      radars.add(*event, *sent.scan, radar, scenario.effects.profile_of(radar.id).latency);
    }
    truth.add_scan(drive, *event);
    ++files.scans;
    files.number_of_detections += event->truth->size();
  }
  radars.finish();
  ego.finish();
  truth.finish();
  progress(1.0);
  return files;
}

}  // namespace boresight::simulator
