// boresight-ingest_gateway: decodes frames from CAN, UDP or a replay to scans and ego motions.
#include <memory>
#include <string>
#include <vector>

#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/log.hpp"
#include "services/common/runtime/service_main.hpp"
#include "services/ingest_gateway/bus_sink.hpp"
#include "services/ingest_gateway/config.hpp"
#include "services/ingest_gateway/core/backlog.hpp"
#include "services/ingest_gateway/core/gateway.hpp"
#include "services/ingest_gateway/links/tunnel_link.hpp"
#include "services/ingest_gateway/live_links.hpp"
#include "services/ingest_gateway/mapping/vehicle_mappings.hpp"

using namespace boresight;

namespace {

void log_warnings(const ingest::Mappings& mappings) {
  const auto log = [](const std::vector<std::string>& warnings) {
    for (const std::string& warning : warnings) runtime::log::warning("{}", warning);
  };
  if (mappings.ego) log(mappings.ego->warnings);
  for (const auto& [radar_id, mapping] : mappings.radars) log(mapping.warnings);
}

int run(runtime::Node& node, const VehicleConfig& vehicle, const ingest::Mappings& mappings,
        const ingest::Config& config) {
  log_warnings(mappings);
  ingest::BusSink sink(node);
  ingest::Gateway gateway(vehicle, sink, mappings, config.contradiction);
  ingest::Backlog backlog;
  const bool is_live = config.input != ingest::Input::kReplay;
  ingest::Links links(node, {.on_frame =
                                 [&](const recording::Frame& frame, const ingest::FrameStamp& stamp) {
                                   const std::int64_t now_ns = runtime::monotonic_now_ns();
                                   backlog.frame_taken(now_ns - stamp.received_ns);
                                   // The stamps of a replay are those of the recording.
                                   if (is_live) node.count_queueing(now_ns - stamp.received_ns);
                                   sink.frame_begins(now_ns);
                                   gateway.take(frame, stamp);
                                 },
                             .on_fault = [&](Fault fault, std::string_view what) { node.fault(fault, what); },
                             .on_end = [&] { gateway.finish(); },
                             .on_network_up = [&] { gateway.network_is_up(runtime::monotonic_now_ns()); }});
  if (!is_live) {
    links.add(std::make_unique<ingest::TunnelLink>(config.tunnel_path, links.events()));
  } else {
    links.add_live(vehicle);
    sink.use(links);
    gateway.start(runtime::monotonic_now_ns());
    node.every(5'000'000, [&] {
      const std::int64_t now_ns = runtime::monotonic_now_ns();
      if (backlog.is_read(now_ns)) gateway.tick(now_ns);
    });
  }
  node.every(1'000'000'000, [&] { links.keep_open(); });
  const int exit_code = node.spin();
  gateway.stop();
  return exit_code;
}

}  // namespace

int main(int argc, char** argv) {
  return runtime::service_main(
      catalogue::Service::kIngestGateway, argc, argv, [](const runtime::Configuration& files) -> runtime::Run {
        const VehicleConfig vehicle = files.vehicle();
        const ingest::Config config = ingest::read_config(config::Reader::open(files.service_file("ingest_gateway")));
        const ingest::Mappings mappings = ingest::read_mappings(vehicle);
        return [=](runtime::Node& node) { return run(node, vehicle, mappings, config); };
      });
}
