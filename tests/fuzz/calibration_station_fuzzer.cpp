// A station sends any bytes to the calibration service. Answers must be valid and no larger than a result. Only
// requests are answered. A run without further requests must end by a timeout.
#include <algorithm>
#include <memory>
#include <vector>

#include "services/alignment_estimator/station/core/calibration_service.hpp"
#include "services/common/someip/big_endian.hpp"
#include "tests/fuzz/support.hpp"

namespace {

using namespace boresight;
using namespace boresight::alignment;
using fuzz::require;
namespace service = wire::calibration_service;

constexpr std::int64_t kMs = 1'000'000;

/// Parses each answer.
class Judge : public station::Surroundings {
 public:
  void answer(std::span<const std::uint8_t> message) override {
    ++answers;
    require(message.size() >= 16 && message.size() <= 16 + station::kMaxAnswerPayloadBytes);
    require(read_u32(message.data() + 4) == message.size() - 8 && message[12] == 1 && message[13] == 1);
    require(message[14] == 0x80 ? message[15] == 0 : message[14] == 0x81 && message[15] != 0 && message.size() == 16);
    require(message[14] == 0x80 || message[15] <= 0x0A);
  }
  void fault(Fault, std::string_view what) override { require(!what.empty()); }
  bool take_over(std::uint32_t radar_id, const plate::PlateResult& result) override {
    require(radar_id == 1 && result.ok());
    return true;
  }
  std::size_t answers = 0;
};

VehicleConfig vehicle() {
  VehicleConfig config;
  config.radars.emplace_back();
  config.radars.back().id = 1;
  return config;
}

void fill(fuzz::Input& input, RadarScan& scan, std::int64_t now_ns) {
  scan.header.source_id = 1;
  scan.header.measurement_time_ns = now_ns;
  scan.integrity = 0;
  scan.fields = scan_field::kRcs;
  scan.number_of_valid_detections = 1;
  scan.range_m[0] = 3.0F;
  scan.range_rate_mps[0] = 0.0F;
  scan.detection_flags[0] = 0;
  scan.azimuth_rad[0] = static_cast<float>(input.u8()) * 0.001F;
  scan.rcs_dbsm[0] = static_cast<float>(input.u8()) - 100.0F;
}

}  // namespace

/// The input is a series of datagrams. Each has a kind (bits 0…3 method, bit 4 datagram unchanged, bit 5 sixty scans
/// before it, bit 6 another station, bit 7 thirty seconds pass), a length, and its bytes.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const VehicleConfig kVehicle = vehicle();
  static const auto scan = std::make_unique<RadarScan>();
  fuzz::Input input(data, size);
  const auto calibration = std::make_unique<station::CalibrationService>(kVehicle, plate::StationConfig{}, 0.1);
  Judge judge;
  std::vector<std::uint8_t> datagram;
  std::int64_t now_ns = 1000 * kMs;
  std::uint16_t session = 0;
  while (!input.empty()) {
    const std::uint8_t how = input.u8();
    const auto bytes = input.bytes(input.u8());
    datagram.assign(bytes.begin(), bytes.end());
    if ((how & 0x10) == 0) {
      someip::Message header;
      header.service = service::kServiceId;
      header.method = how & 0x0Fu;
      header.client = (how & 0x40) != 0 ? 2 : 1;
      header.session = ++session;
      header.protocol_version = header.interface_version = 1;
      header.type = someip::MessageType::kRequest;
      datagram.insert(datagram.begin(), someip::kHeaderBytes, 0);
      someip::write_header(header, bytes.size(), std::span<std::uint8_t>(datagram).first<someip::kHeaderBytes>());
    }
    const fuzz::NoAllocation none;
    if ((how & 0x80) != 0) now_ns += 30'000 * kMs;
    if ((how & 0x20) != 0) fill(input, *scan, now_ns);
    for (int i = 0; (how & 0x20) != 0 && i < 60; ++i) {
      now_ns += 50 * kMs;
      scan->header.measurement_time_ns = now_ns;
      calibration->add_scan(*scan, now_ns);
    }
    const std::size_t before = judge.answers;
    calibration->receive(datagram, {recording::IpAddress::v4(0x0A000002), 41000}, now_ns, judge);
    require(judge.answers - before <= datagram.size() / someip::kHeaderBytes);
    calibration->tick(now_ns);
    const auto event = calibration->event_if_changed(now_ns);
    require(event.empty() || event.size() == someip::kHeaderBytes + service::state::kBytes);
    require(calibration->event_if_changed(now_ns).empty());
  }
  now_ns += 3'600'000 * kMs;
  calibration->tick(now_ns);
  const plate::State state = calibration->state(now_ns).progress.state;
  require(state == plate::State::kIdle || state == plate::State::kFinished || state == plate::State::kFailed);
  return 0;
}
