// boresight-alignment_estimator: ego motion and scans in, one estimate per radar and period out.
#include <cstdlib>

#include "services/alignment_estimator/config.hpp"
#include "services/alignment_estimator/core/estimator.hpp"
#include "services/alignment_estimator/station/calibration_server.hpp"
#include "services/alignment_estimator/store/keeper.hpp"
#include "services/common/runtime/log.hpp"
#include "services/common/runtime/service_main.hpp"

using namespace boresight;

namespace {

std::optional<std::filesystem::path> memory_file(const alignment::MemorySettings& settings) {
  if (!settings.enabled) return std::nullopt;
  if (!settings.path.empty()) return settings.path;
  const char* const folder = std::getenv("STATE_DIRECTORY");
  if (folder == nullptr || *folder == '\0') return std::nullopt;
  return std::filesystem::path(folder) / "alignment";
}

/// Logs new step changes; the published estimates contain them as well.
void report_step_changes(const VehicleConfig& vehicle, const alignment::Estimator& estimator,
                         std::array<std::uint32_t, kMaxRadars>& reported) {
  for (std::size_t i = 0; i < vehicle.radars.size(); ++i) {
    const AlignmentStepChange step_change = estimator.estimate(i).step_change;
    if (step_change.count == reported[i]) continue;
    reported[i] = step_change.count;
    const auto degrees = [&step_change](std::size_t axis) {
      return step_change.rotation_vehicle_rad[axis] * 180.0 / M_PI;
    };
    runtime::log::warning(
        "radar {}: sudden misalignment of {:+.2f}, {:+.2f}, {:+.2f} deg about the vehicle's x, y, z axes",
        vehicle.radars[i].name, degrees(0), degrees(1), degrees(2));
  }
}

int run(runtime::Node& node, const VehicleConfig& vehicle, const alignment::Settings& settings) {
  alignment::Estimator estimator(vehicle, settings.estimator);
  alignment::Keeper keeper(node, estimator, vehicle, memory_file(settings.memory), settings.memory.period_s);
  runtime::Publisher<AlignmentEstimate> estimates(node);
  alignment::station::CalibrationServer calibration(node, vehicle, settings.station, [&](const auto& seed) {
    const bool taken_over = estimator.seed(seed);
    if (taken_over) keeper.remember();
    return taken_over;
  });
  std::array<std::uint32_t, kMaxRadars> reported_step_changes{};
  node.every(1'000'000'000, [&] { report_step_changes(vehicle, estimator, reported_step_changes); });
  node.on<EgoMotion>([&](const EgoMotion& motion) {
    estimator.add_ego_motion(motion);
    calibration.add_ego_motion(motion);
  });
  node.on<RadarScan>([&](const RadarScan& scan) {
    const std::uint32_t id = scan.header.source_id;
    calibration.add_scan(scan);
    switch (estimator.add_scan(scan)) {
      case alignment::ScanResult::kUsed:
        break;
      case alignment::ScanResult::kUnknownRadar:
        node.fault(Fault::kWireUnknown, "scan of a radar that is not in the vehicle file");
        break;
      case alignment::ScanResult::kNoEgoMotion:
        node.fault(Fault::kSideInputMissing, "scan without ego motion for its measurement time");
        break;
      case alignment::ScanResult::kPublish: {
        const runtime::Origin origin{.source_id = id,
                                     .measurement_time_ns = scan.header.measurement_time_ns,
                                     .time_source = scan.header.time_source,
                                     .stage = std::nullopt,
                                     .begin_ns = 0};
        estimates.publish(origin, [&](AlignmentEstimate& out) { static_cast<void>(estimator.write(id, out)); });
        break;
      }
    }
  });
  const int exit_code = node.spin();
  keeper.finish();
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  return runtime::service_main(
      catalogue::Service::kAlignmentEstimator, argc, argv, [](const runtime::Configuration& files) -> runtime::Run {
        const VehicleConfig vehicle = files.vehicle();
        const alignment::Settings settings =
            alignment::read_settings(config::Reader::open(files.service_file("alignment_estimator")));
        return [vehicle, settings](runtime::Node& node) { return run(node, vehicle, settings); };
      });
}
