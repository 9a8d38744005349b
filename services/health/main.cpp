// boresight-health: heartbeats of services and data of radars in; verdicts out, on a topic and by DDS.
#include <filesystem>
#include <memory>
#include <string>

#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/service_main.hpp"
#include "services/common/runtime/version.hpp"
#include "services/health/config.hpp"
#include "services/health/core/supervision.hpp"
#include "services/health/dds/security.hpp"
#include "services/health/fault_store.hpp"
#include "services/health/level_store.hpp"
#include "services/health/outlet.hpp"

using namespace boresight;

namespace {

constexpr std::int64_t kJudgePeriod_ns = 20'000'000;

int run(runtime::Node& node, const VehicleConfig& vehicle, const health::FileConfig& config,
        std::uint64_t configuration, const dds::CommandKey& key) {
  health::Supervision supervision(vehicle, config.supervision, runtime::monotonic_now_ns());
  supervision.set_origin(configuration, runtime::software_version());
  health::FaultStore store(node, supervision.faults(), config.fault_store);
  health::LevelStore levels(node, supervision, vehicle, config);
  supervision.restored();
  health::Outlet outlet(node, vehicle, config.dds, supervision.faults(), key);
  runtime::Publisher<HealthReport> reports(node);
  node.publishes_periodically(catalogue::TopicId::kHealthReport);
  node.on<ServiceStatus>([&](const ServiceStatus& m) {
    const std::int64_t now_ns = runtime::monotonic_now_ns();
    supervision.observe(m, now_ns);
    outlet.pass_on(m, now_ns);
  });
  node.on<EgoMotion>([&](const EgoMotion& m) { supervision.observe(m); });
  node.on<AlignmentEstimate>([&](const AlignmentEstimate& m) {
    supervision.observe(m);
    outlet.pass_on(m, runtime::monotonic_now_ns());
  });
  // Before the scans: after a pause of this service, scans without their track lists would look like a silent pipeline.
  node.on<TrackList>([&](const TrackList& m) {
    const std::int64_t now_ns = runtime::monotonic_now_ns();
    supervision.observe(m, now_ns);
    outlet.pass_on(m, now_ns);
  });
  node.on<RadarScan>([&](const RadarScan& m) { supervision.observe(m, runtime::monotonic_now_ns()); });

  const auto sent = std::make_unique<HealthReport>();
  const auto current = std::make_unique<HealthReport>();
  const std::int64_t period_ns = catalogue::topic(catalogue::TopicId::kHealthReport).period_ns;
  std::int64_t next_ns = 0;
  // A changed verdict is sent at once: otherwise a silent radar would be reported up to a period after its deadline.
  node.every(kJudgePeriod_ns, [&] {
    const std::int64_t now_ns = runtime::monotonic_now_ns();
    supervision.judge(*current, now_ns, runtime::realtime_now_ns());
    store.keep(now_ns);
    levels.keep(now_ns);
    outlet.serve(now_ns);
    const bool changed = health::verdicts_differ(*current, *sent);
    if (!changed && now_ns < next_ns) return;
    next_ns = now_ns + period_ns - kJudgePeriod_ns / 2;
    *sent = *current;
    const runtime::Origin origin{.source_id = static_cast<std::uint32_t>(node.self()),
                                 .measurement_time_ns = now_ns,
                                 .time_source = TimeSource::kUserArrival,
                                 .stage = std::nullopt,
                                 .begin_ns = 0};
    reports.publish(origin, [&](HealthReport& out) { out = *sent; });
    outlet.write(*sent, changed, now_ns);
  });
  const int exit_code = node.spin();
  levels.finish();
  outlet.end();
  store.finish();
  return exit_code;
}

/// The service runs without DDS if the files of security cannot be used; an installer shall know before.
void inspect_security(const runtime::Configuration& files) {
  const std::filesystem::path file = files.service_file("health");
  const dds::Config config = health::read_config(config::Reader::open(file)).dds;
  const std::string problem =
      dds::check_security(config.security, config.domain, runtime::realtime_now_ns() / 1'000'000'000).problem;
  if (config.enabled && !problem.empty()) throw config::Error(file.string() + ": " + problem);
}

}  // namespace

int main(int argc, char** argv) {
  return runtime::service_main(
      catalogue::Service::kHealth, argc, argv,
      [](const runtime::Configuration& files) -> runtime::Run {
        const VehicleConfig vehicle = files.vehicle();
        const health::FileConfig config = health::read_config(config::Reader::open(files.service_file("health")));
        const std::uint64_t configuration = health::configuration_fingerprint(files);
        const dds::CommandKey key = health::command_key_of(config.dds);
        return [vehicle, config, configuration, key](runtime::Node& node) {
          return run(node, vehicle, config, configuration, key);
        };
      },
      inspect_security);
}
