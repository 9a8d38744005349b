#include "tests/system/network/witness.hpp"

#include <algorithm>
#include <stdexcept>

#include "interfaces/messages/radar_scan.hpp"
#include "services/common/runtime/clock.hpp"
#include "services/common/runtime/node.hpp"
#include "services/replay/core/synthetic.hpp"

namespace boresight::network {

namespace {

template <typename T>
bool same(const DetectionColumn<T>& a, const DetectionColumn<T>& b, std::size_t n) {
  return std::equal(a.data(), a.data() + n, b.data());
}

bool same_detections(const RadarScan& a, const RadarScan& b) {
  const std::size_t n = a.number_of_valid_detections;
  return n == b.number_of_valid_detections && a.fields == b.fields && a.range_rate_min_mps == b.range_rate_min_mps &&
         a.range_rate_max_mps == b.range_rate_max_mps && same(a.range_m, b.range_m, n) &&
         same(a.azimuth_rad, b.azimuth_rad, n) && same(a.elevation_rad, b.elevation_rad, n) &&
         same(a.range_rate_mps, b.range_rate_mps, n) && same(a.rcs_dbsm, b.rcs_dbsm, n) &&
         same(a.snr_db, b.snr_db, n) && same(a.range_std_m, b.range_std_m, n) &&
         same(a.existence_probability, b.existence_probability, n) && same(a.detection_flags, b.detection_flags, n);
}

}  // namespace

Witness::Witness() : process_(std::make_unique<harness::Child>([this] { return watch(); })) {
  if (!harness::eventually(10.0, [this] { return log_->attached; })) throw std::runtime_error("no witness on the bus");
}

const SeenScan* Witness::first_since(std::int64_t time_ns, std::uint32_t radar) const {
  const SeenScan* const begin = log_->scans.data();
  const SeenScan* const end = begin + size();
  const SeenScan* const found = std::find_if(
      std::lower_bound(begin, end, time_ns, [](const SeenScan& s, std::int64_t t) { return s.received_ns < t; }), end,
      [radar](const SeenScan& s) { return s.radar == radar; });
  return found == end ? nullptr : found;
}

int Witness::watch() {
  runtime::Node node(catalogue::Service::kMonitor, "-network");
  const auto expected = std::make_unique<RadarScan>();
  node.on<RadarScan>([&](const RadarScan& scan) {
    const std::size_t index = log_->size;
    if (index >= kMaxScans) return;
    const std::int64_t now_ns = runtime::monotonic_now_ns();
    replay::write_synthetic_scan(scan.header.source_id, {}, scan.cycle_counter, scan.number_of_valid_detections,
                                 *expected);
    log_->scans[index] = {.received_ns = now_ns,
                          .age_ns = now_ns - scan.header.measurement_time_ns,
                          .radar = scan.header.source_id,
                          .cycle = scan.cycle_counter,
                          .detections = scan.number_of_valid_detections,
                          .integrity = scan.integrity,
                          .is_as_sent = same_detections(scan, *expected)};
    log_->size = index + 1;
  });
  node.on<ServiceStatus>([&](const ServiceStatus& status) {
    if (status.header.source_id != static_cast<std::uint32_t>(catalogue::Service::kIngestGateway)) return;
    const std::size_t next = log_->number_of_statuses + 1;
    log_->statuses[next % 2] = status;
    log_->number_of_statuses = next;
  });
  log_->attached = true;
  return node.spin();
}

}  // namespace boresight::network
