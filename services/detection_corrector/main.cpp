// boresight-detection_corrector: alignment estimates, ego motion and scans in, corrected scans out.
#include "services/common/runtime/service_main.hpp"
#include "services/detection_corrector/config.hpp"
#include "services/detection_corrector/core/corrector.hpp"

using namespace boresight;

namespace {

int run(runtime::Node& node, const VehicleConfig& vehicle, const corrector::Config& config) {
  corrector::Corrector corrector(vehicle, config);
  runtime::Publisher<CorrectedScan> corrected(node);
  node.on<AlignmentEstimate>([&](const AlignmentEstimate& estimate) {
    if (!corrector.add_alignment(estimate))
      node.fault(Fault::kWireUnknown, "alignment estimate of a radar that is not in the vehicle file");
  });
  node.on<EgoMotion>([&](const EgoMotion& motion) { corrector.add_ego_motion(motion); });
  node.on_newest<RadarScan>([&](const RadarScan& scan, std::uint64_t dropped) {
    if (!corrector.knows(scan.header.source_id)) {
      node.fault(Fault::kWireUnknown, "scan of a radar that is not in the vehicle file");
      node.nothing_to_publish();
      return;
    }
    corrected.publish_from(scan.header, Stage::kCorrector, [&](CorrectedScan& out) {
      corrector.correct(scan, out);
      if (dropped > 0) out.flags |= pipeline_flag::kScansDropped;
      constexpr std::uint32_t kMissing = pipeline_flag::kNoEgoMotion | pipeline_flag::kEgoMotionStale;
      if ((out.flags & kMissing) != 0)
        node.fault(Fault::kSideInputMissing, "scan without ego motion for its measurement time");
    });
  });
  return node.spin();
}

}  // namespace

int main(int argc, char** argv) {
  return runtime::service_main(
      catalogue::Service::kDetectionCorrector, argc, argv, [](const runtime::Configuration& files) -> runtime::Run {
        const VehicleConfig vehicle = files.vehicle();
        const corrector::Config config =
            corrector::read_config(config::Reader::open(files.service_file("detection_corrector")));
        return [vehicle, config](runtime::Node& node) { return run(node, vehicle, config); };
      });
}
