// boresight-ghost_filter: corrected scans and the previous step's tracks in, classified scans out.
#include "services/common/runtime/service_main.hpp"
#include "services/ghost_filter/config.hpp"
#include "services/ghost_filter/core/method.hpp"

using namespace boresight;

namespace {

int run(runtime::Node& node, const ghosts::Config& config) {
  const std::unique_ptr<ghosts::Method> method = ghosts::make_method(config);
  runtime::Publisher<ClassifiedScan> classified(node);
  node.on<TrackList>([&](const TrackList& tracks) { method->add_tracks(tracks); });
  node.on_newest<CorrectedScan>([&](const CorrectedScan& scan, std::uint64_t dropped) {
    classified.publish_from(scan.header, Stage::kGhostFilter, [&](ClassifiedScan& out) {
      method->classify(scan, out);
      if (dropped > 0) out.flags |= pipeline_flag::kScansDropped;
      if ((out.flags & (pipeline_flag::kNoTracks | pipeline_flag::kTracksStale)) != 0) {
        node.fault(Fault::kSideInputMissing, "scan without tracks of the previous step: evidence of the scans alone");
      }
    });
  });
  return node.spin();
}

}  // namespace

int main(int argc, char** argv) {
  return runtime::service_main(catalogue::Service::kGhostFilter, argc, argv,
                               [](const runtime::Configuration& files) -> runtime::Run {
                                 const ghosts::Config config = ghosts::read_config(files, files.vehicle());
                                 return [config](runtime::Node& node) { return run(node, config); };
                               });
}
