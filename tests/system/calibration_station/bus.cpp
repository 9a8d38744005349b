#include "tests/system/calibration_station/bus.hpp"

#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "interfaces/messages/ego_motion.hpp"
#include "interfaces/messages/radar_scan.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/node.hpp"
#include "services/simulator/alignment/plate.hpp"

namespace boresight::calibration_station {

namespace {

constexpr std::int64_t kPeriod_ns = 10'000'000;

double amplitude_db(const Scene& scene) {
  simulator::PlateSpec spec;
  spec.pitch_rad = scene.pitch_rad;
  if (scene.has_maximum) return simulator::plate_amplitude_db(spec, scene.tilt_rad);
  const double degrees = (scene.tilt_rad + scene.pitch_rad) * 180.0 / std::numbers::pi;
  return 10.0 + 0.2 * degrees * degrees;
}

}  // namespace

PlateRadars::PlateRadars() : process_(std::make_unique<harness::Child>([this] { return run(); })) {}

int PlateRadars::run() {
  runtime::Node node(catalogue::Service::kIngestGateway);
  runtime::Publisher<RadarScan> scans(node);
  runtime::Publisher<EgoMotion> motions(node);
  std::mt19937_64 random(7);
  std::normal_distribution<double> noise;
  const auto publish = [&](std::uint32_t radar, double amplitude, double azimuth_rad) {
    const std::int64_t now_ns = runtime::monotonic_now_ns();
    auto loan = scans.loan();
    if (!loan) return;
    simulator::fill_plate_scan(amplitude + 0.1 * noise(random), azimuth_rad + 0.001 * noise(random), now_ns, *loan);
    if (radar == kRadarAtPlate && !scene_->is_plate_there) loan->number_of_valid_detections = 1;
    scans.publish(std::move(loan), {.source_id = radar,
                                    .measurement_time_ns = now_ns,
                                    .time_source = TimeSource::kUserArrival,
                                    .stage = std::nullopt,
                                    .begin_ns = 0});
  };
  node.every(kPeriod_ns, [&] {
    const runtime::Origin origin{.source_id = 0,
                                 .measurement_time_ns = runtime::monotonic_now_ns(),
                                 .time_source = TimeSource::kUserArrival,
                                 .stage = std::nullopt,
                                 .begin_ns = 0};
    motions.publish(origin, [&](EgoMotion& out) {
      const MessageHeader header = out.header;
      out = {};
      out.header = header;
      out.fields = ego_field::kSpeed | ego_field::kYawRate;
      out.speed_mps = static_cast<float>(scene_->speed_mps);
      out.speed_std_mps = 0.02F;
      out.yaw_rate_std_radps = 0.001F;
    });
    publish(1, 50.0, 0.05);
    publish(kRadarAtPlate, amplitude_db(*scene_) + scene_->disturbance_db, -scene_->yaw_rad);
  });
  return node.spin();
}

Reader::Reader() : process_(std::make_unique<harness::Child>([this] { return run(); })) {
  if (!harness::eventually(10.0, [this] { return log_->attached; })) throw std::runtime_error("no reader on the bus");
}

int Reader::run() {
  runtime::Node node(catalogue::Service::kMonitor, "-calibration");
  node.on<ServiceStatus>([&](const ServiceStatus& status) {
    if (status.header.source_id != static_cast<std::uint32_t>(catalogue::Service::kAlignmentEstimator)) return;
    const std::size_t next = log_->number_of_statuses + 1;
    log_->statuses[next % 2] = status;
    log_->number_of_statuses = next;
  });
  node.on<AlignmentEstimate>([&](const AlignmentEstimate& estimate) {
    const std::uint32_t radar = estimate.header.source_id;
    if (radar >= log_->estimates.size()) return;
    const std::size_t next = log_->number_of_estimates[radar] + 1;
    log_->estimates[radar][next % 2] = estimate;
    log_->number_of_estimates[radar] = next;
  });
  log_->attached = true;
  return node.spin();
}

}  // namespace boresight::calibration_station
