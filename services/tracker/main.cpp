// boresight-tracker: classified scans in, a track list for each out.
#include "services/common/runtime/service_main.hpp"
#include "services/tracker/config.hpp"
#include "services/tracker/core/tracker.hpp"

using namespace boresight;

namespace {

int run(runtime::Node& node, const VehicleConfig& vehicle, const tracking::Config& config) {
  tracking::Tracker tracker(vehicle, config);
  runtime::Publisher<TrackList> tracks(node);
  node.on<ClassifiedScan>([&](const ClassifiedScan& scan) {
    const tracking::StepResult result = tracker.step(scan);
    if (result.out_of_order) node.fault(Fault::kTimeJump, "scan older than the tracks");
    if (result.restarted) node.fault(Fault::kTimeJump, "measurement time jumped: tracks dropped");
    if (result.dropped_clusters > 0) {
      node.fault(Fault::kCapacity, "more than 128 clusters in a scan", result.dropped_clusters);
    }
    if (result.dropped_tracks > 0) {
      node.fault(Fault::kCapacity, "more objects than tracks have room", result.dropped_tracks);
    }
    tracks.publish_from(scan.header, Stage::kTracker, [&](TrackList& out) { tracker.write(out); });
  });
  return node.spin();
}

}  // namespace

int main(int argc, char** argv) {
  return runtime::service_main(
      catalogue::Service::kTracker, argc, argv, [](const runtime::Configuration& files) -> runtime::Run {
        const VehicleConfig vehicle = files.vehicle();
        const tracking::Config config = tracking::read_config(config::Reader::open(files.service_file("tracker")));
        return [vehicle, config](runtime::Node& node) { return run(node, vehicle, config); };
      });
}
