// boresight-ingest_gateway: frames from CAN, UDP or a replay in, scans and ego motions out.
#include <memory>
#include <vector>

#include "services/common/runtime/allocation_counter.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/service_main.hpp"
#include "services/ingest_gateway/bus_sink.hpp"
#include "services/ingest_gateway/config.hpp"
#include "services/ingest_gateway/core/gateway.hpp"
#include "services/ingest_gateway/links/tunnel_link.hpp"
#include "services/ingest_gateway/live_links.hpp"

using namespace boresight;

namespace {

/// Keeps the node waiting for the descriptors that the links have at the moment.
class LinkKeeper {
 public:
  LinkKeeper(runtime::Node& node, std::vector<std::unique_ptr<ingest::Link>> links) : node_(node) {
    for (auto& link : links) entries_.push_back({std::move(link), -1});
    open_closed();
  }

  /// To be called each second: links that are down are tried again.
  void open_closed() {
    for (Entry& entry : entries_) {
      if (entry.link->descriptor() < 0) static_cast<void>(entry.link->open());
      watch(entry);
    }
  }

 private:
  struct Entry {
    std::unique_ptr<ingest::Link> link;
    int watched;
  };
  void watch(Entry& entry) {
    const int descriptor = entry.link->descriptor();
    if (descriptor == entry.watched) return;
    const runtime::AllowAllocations not_the_data_path;
    if (entry.watched >= 0) node_.remove_descriptor(entry.watched);
    entry.watched = descriptor;
    if (descriptor < 0) return;
    node_.on_readable(descriptor, [this, &entry] {
      entry.link->read();
      watch(entry);
    });
  }
  runtime::Node& node_;
  std::vector<Entry> entries_;
};

int run(runtime::Node& node, const VehicleConfig& vehicle, const ingest::Config& config) {
  ingest::BusSink sink(node);
  ingest::Gateway gateway(vehicle, sink);
  const ingest::LinkEvents events{.on_frame =
                                      [&](const recording::Frame& frame, const ingest::FrameStamp& stamp) {
                                        sink.frame_begins(runtime::monotonic_now_ns());
                                        gateway.take(frame, stamp);
                                      },
                                  .on_fault = [&](Fault fault, std::string_view what) { node.fault(fault, what); },
                                  .on_end = [&] { gateway.finish(); }};
  std::vector<std::unique_ptr<ingest::Link>> links;
  if (config.input == ingest::Input::kReplay) {
    links.push_back(std::make_unique<ingest::TunnelLink>(config.tunnel_path, events));
  } else {
    links = ingest::make_live_links(vehicle, events);
  }
  LinkKeeper keeper(node, std::move(links));
  node.every(1'000'000'000, [&] { keeper.open_closed(); });
  if (config.input == ingest::Input::kLive) {
    node.every(5'000'000, [&] { gateway.tick(runtime::monotonic_now_ns()); });
  }
  return node.spin();
}

}  // namespace

int main(int argc, char** argv) {
  return runtime::service_main(
      catalogue::Service::kIngestGateway, argc, argv, [](const runtime::Configuration& files) -> runtime::Run {
        const VehicleConfig vehicle = files.vehicle();
        const ingest::Config config = ingest::read_config(config::Reader::open(files.service_file("ingest_gateway")));
        return [vehicle, config](runtime::Node& node) { return run(node, vehicle, config); };
      });
}
