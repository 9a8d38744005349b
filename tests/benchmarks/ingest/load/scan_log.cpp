#include "tests/benchmarks/ingest/load/scan_log.hpp"

#include "services/common/runtime/node.hpp"

namespace boresight::bench {

ScanLog::ScanLog() : process_(std::make_unique<harness::Child>([this] { return observe(); })) {}

int ScanLog::observe() {
  runtime::Node node(catalogue::Service::kMonitor, "-ingest-load");
  node.on<RadarScan>([this](const RadarScan& scan) {
    const std::size_t index = log_->size;
    if (index >= kMaxScans) return;
    const StageStamp& stage = scan.header.stages[static_cast<std::size_t>(Stage::kIngest)];
    log_->scans[index] = {scan.header.source_id,           scan.integrity, scan.header.time_source,
                          scan.header.measurement_time_ns, stage.begin_ns, stage.end_ns};
    log_->size = index + 1;
  });
  node.on<ServiceStatus>([this](const ServiceStatus& status) {
    if (status.header.source_id == static_cast<std::uint32_t>(catalogue::Service::kIngestGateway)) {
      log_->gateway = status;
    }
  });
  log_->attached = true;
  return node.spin();
}

}  // namespace boresight::bench
