// deployed_impostor [small]: a compromised service. It names itself the gateway and puts messages on the bus:
// heartbeats in the gateway's name, and vehicle motions (`small`) or radar scans as well. It runs for three seconds.
#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

#include <unistd.h>

#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/node.hpp"

namespace boresight {
namespace {

constexpr std::int64_t kPeriod_ns = 50'000'000;
constexpr std::int64_t kDuration_ns = 3'000'000'000;

int run(bool only_small) {
  // With the gateway's own name, RouDi would take the gateway for dead and delete its ports.
  // A name for each user: iceoryx keeps a lock file of each name in /tmp.
  runtime::Node node(catalogue::Service::kIngestGateway, "-impostor" + std::to_string(getuid()));
  runtime::Publisher<RadarScan> scans(node);
  runtime::Publisher<EgoMotion> motions(node);
  unsigned published = 0;
  node.every(kPeriod_ns, [&] {
    const runtime::Origin origin{.source_id = 1,
                                 .measurement_time_ns = runtime::monotonic_now_ns(),
                                 .time_source = TimeSource::kLinkArrival,
                                 .stage = std::nullopt,
                                 .begin_ns = 0};
    if (only_small) {
      published += motions.publish(origin, [](EgoMotion&) {}) ? 1 : 0;
    } else {
      published += scans.publish(origin, [](RadarScan& scan) { scan.number_of_valid_detections = 0; }) ? 1 : 0;
    }
  });
  node.every(kDuration_ns, [&] { node.stop(); });
  const int code = node.spin();
  std::printf("published %u\n", published);
  return code;
}

}  // namespace
}  // namespace boresight

int main(int argc, char** argv) {
  return boresight::run(argc > 1 && std::string_view(argv[1]) == "small");
}
