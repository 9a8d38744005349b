// boresight-tracker: classified scans in, a track list for each out.
#include "services/common/runtime/service_main.hpp"
#include "services/tracker/config.hpp"
#include "services/tracker/core/make_tracker.hpp"

using namespace boresight;

namespace {

int run(runtime::Node& node, const VehicleConfig& vehicle, const tracking::Config& config) {
  const auto tracker = tracking::make_tracker(config.tracker, vehicle, config);
  runtime::Publisher<TrackList> tracks(node);
  node.on_newest<ClassifiedScan>([&](const ClassifiedScan& scan, std::uint64_t dropped) {
    const tracking::StepResult result = tracker->step(scan);
    if (result.out_of_order) node.fault(Fault::kTimeJump, "scan older than the tracks");
    if (result.restarted) node.fault(Fault::kTimeJump, "measurement time jumped: tracks dropped");
    if (result.budget_reached) node.fault(Fault::kWorkBudget, "search for associations ended at its work budget");
    if (result.dropped_detections > 0) {
      node.fault(Fault::kCapacity, "more detections in a scan than the tracker has room for",
                 result.dropped_detections);
    }
    if (result.dropped_objects > 0) {
      node.fault(Fault::kCapacity, "more objects than the tracker has room for", result.dropped_objects);
    }
    if (result.cut_gates > 0) {
      node.fault(Fault::kCapacity, "more objects near each other than the tracker associates jointly",
                 result.cut_gates);
    }
    std::uint32_t dropped_tracks = 0;
    tracks.publish_from(scan.header, Stage::kTracker, [&](TrackList& out) {
      tracker->write(out);
      if (dropped > 0) out.flags |= pipeline_flag::kScansDropped;
      dropped_tracks = out.dropped_tracks;
    });
    if (dropped_tracks > 0) node.fault(Fault::kCapacity, "more tracks than a list has room for", dropped_tracks);
  });
  return node.spin();
}

}  // namespace

int main(int argc, char** argv) {
  return runtime::service_main(catalogue::Service::kTracker, argc, argv,
                               [](const runtime::Configuration& files) -> runtime::Run {
                                 const VehicleConfig vehicle = files.vehicle();
                                 const tracking::Config config = tracking::read_config(files);
                                 return [vehicle, config](runtime::Node& node) { return run(node, vehicle, config); };
                               });
}
