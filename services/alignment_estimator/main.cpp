// boresight-alignment_estimator: ego motion and scans in, one estimate a radar and period out.
#include "services/alignment_estimator/config.hpp"
#include "services/alignment_estimator/core/estimator.hpp"
#include "services/common/runtime/service_main.hpp"

using namespace boresight;

namespace {

int run(runtime::Node& node, const VehicleConfig& vehicle, const alignment::Config& config) {
  alignment::Estimator estimator(vehicle, config);
  runtime::Publisher<AlignmentEstimate> estimates(node);
  node.on<EgoMotion>([&](const EgoMotion& motion) { estimator.add_ego_motion(motion); });
  node.on<RadarScan>([&](const RadarScan& scan) {
    switch (estimator.add_scan(scan)) {
      case alignment::ScanResult::kUsed:
        break;
      case alignment::ScanResult::kUnknownRadar:
        node.fault(Fault::kWireUnknown, "scan of a radar that the vehicle file does not know");
        break;
      case alignment::ScanResult::kNoEgoMotion:
        node.fault(Fault::kSideInputMissing, "scan without ego motion of its time");
        break;
      case alignment::ScanResult::kPublish: {
        const runtime::Origin origin{.source_id = scan.header.source_id,
                                     .measurement_time_ns = scan.header.measurement_time_ns,
                                     .time_source = scan.header.time_source,
                                     .stage = std::nullopt,
                                     .begin_ns = 0};
        estimates.publish(
            origin, [&](AlignmentEstimate& out) { static_cast<void>(estimator.write(scan.header.source_id, out)); });
        break;
      }
    }
  });
  return node.spin();
}

}  // namespace

int main(int argc, char** argv) {
  return runtime::service_main(
      catalogue::Service::kAlignmentEstimator, argc, argv, [](const runtime::Configuration& files) -> runtime::Run {
        const VehicleConfig vehicle = files.vehicle();
        const alignment::Config config =
            alignment::read_config(config::Reader::open(files.service_file("alignment_estimator")));
        return [vehicle, config](runtime::Node& node) { return run(node, vehicle, config); };
      });
}
