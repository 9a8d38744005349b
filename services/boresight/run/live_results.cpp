#include "services/boresight/run/live_results.hpp"

#include <algorithm>

#include "services/common/geometry/so3.hpp"

namespace boresight::run {

namespace {

/// A measurement that is older by more belongs to another clock: the recording or the gateway began again.
constexpr std::int64_t kClockJump_ns = 2'000'000'000;
constexpr std::int64_t kHealthPeriod_ns = 1'000'000'000;

bool is_radar(std::uint32_t id) {
  return id >= 1 && id <= kMaxRadars;
}

bool have_same_verdicts(const HealthResult& a, const HealthResult& b) {
  if (a.load_change.time_ns != b.load_change.time_ns || a.speed_change.time_ns != b.speed_change.time_ns) return false;
  if (a.overall != b.overall || a.number_of_sensors != b.number_of_sensors) return false;
  return std::equal(a.sensors.begin(), a.sensors.begin() + static_cast<std::ptrdiff_t>(a.number_of_sensors),
                    b.sensors.begin(), [](const SensorHealth& x, const SensorHealth& y) {
                      return x.radar_id == y.radar_id && x.data_qualifier == y.data_qualifier &&
                             x.extended_qualifier == y.extended_qualifier && x.finding == y.finding &&
                             (x.drift.since_ns != 0) == (y.drift.since_ns != 0);
                    });
}

/// Covariance over (speed scale, rotation about the vehicle's x, y, z) from the one over (speed scale, yaw, pitch,
/// roll) of the message, which the estimator computed by the same gradient.
Eigen::Matrix4d covariance_of(const AlignmentEstimate& message) {
  const Eigen::Matrix4d angles =
      Eigen::Map<const Eigen::Matrix<float, 4, 4, Eigen::RowMajor>>(message.vehicle_covariance.data()).cast<double>();
  Eigen::Matrix4d to_rotation = Eigen::Matrix4d::Identity();
  to_rotation.bottomRightCorner<3, 3>() =
      geometry::fixed_axes_gradient(message.vehicle_pitch_rad, message.vehicle_roll_rad).inverse();
  return to_rotation * angles * to_rotation.transpose();
}

}  // namespace

void LiveResults::note_measurement(std::int64_t time_ns) {
  if (!start_ns_) start_ns_ = time_ns;
  latest_ns_ = std::max(latest_ns_, time_ns);
}

LiveResults::Pending* LiveResults::place_of(const MessageHeader& header) {
  const std::uint32_t radar = header.source_id;
  if (!is_radar(radar)) return nullptr;
  const std::int64_t time_ns = header.measurement_time_ns;
  std::array<Pending, kPending>& places = pending_[radar];
  const auto same = std::find_if(places.begin(), places.end(),
                                 [time_ns](const Pending& p) { return p.time_ns == time_ns && p.is_partial(); });
  if (same != places.end()) return &*same;
  Pending& oldest = *std::min_element(places.begin(), places.end(),
                                      [](const Pending& a, const Pending& b) { return a.time_ns < b.time_ns; });
  if (time_ns < oldest.time_ns) {
    if (oldest.time_ns - time_ns < kClockJump_ns) return nullptr;
    for (Pending& each : places) each.time_ns = 0;
  }
  if (oldest.is_partial()) ++incomplete_[radar];
  oldest.time_ns = time_ns;
  oldest.has_scan = oldest.has_classified = oldest.has_tracks = false;
  return &oldest;
}

template <typename Message>
void LiveResults::add(const Message& message, std::unique_ptr<Message> Pending::*part, bool Pending::*has_part) {
  Pending* const place = place_of(message.header);
  if (place == nullptr) return;
  if (!(place->*part)) place->*part = std::make_unique<Message>();
  *(place->*part) = message;
  place->*has_part = true;
  if (!place->is_complete()) return;
  const std::uint32_t radar = message.header.source_id;
  ++counts_.radars[radar].scans;
  const ScanResult result{{place->time_ns, *start_ns_},
                          place->scan->header.source_sequence,
                          *place->scan,
                          *place->classified,
                          *place->tracks};
  run::add(result, counts_);
  if (listeners_.scan) listeners_.scan(result);
}

void LiveResults::observe(const EgoMotion& ego) {
  note_measurement(ego.header.measurement_time_ns);
  ++counts_.ego_motions;
}

void LiveResults::observe(const RadarScan& scan) {
  note_measurement(scan.header.measurement_time_ns);
  add(scan, &Pending::scan, &Pending::has_scan);
}

void LiveResults::observe(const ClassifiedScan& scan) {
  note_measurement(scan.header.measurement_time_ns);
  add(scan, &Pending::classified, &Pending::has_classified);
}

void LiveResults::observe(const TrackList& tracks) {
  note_measurement(tracks.header.measurement_time_ns);
  add(tracks, &Pending::tracks, &Pending::has_tracks);
}

void LiveResults::observe(const AlignmentEstimate& estimate) {
  const std::int64_t time_ns = estimate.header.measurement_time_ns;
  if (!start_ns_ || time_ns < *start_ns_ || !is_radar(estimate.header.source_id)) return;
  ++counts_.radars[estimate.header.source_id].estimates;
  if (!listeners_.estimate) return;
  const Eigen::Matrix3d turned =
      geometry::fixed_axes_rotation(estimate.vehicle_yaw_rad, estimate.vehicle_pitch_rad, estimate.vehicle_roll_rad);
  listeners_.estimate({{time_ns, *start_ns_}, estimate, geometry::so3_log(turned), covariance_of(estimate)});
}

void LiveResults::observe(const HealthReport& report) {
  if (!start_ns_) return;
  HealthResult verdicts;
  verdicts.at = {report.header.measurement_time_ns, *start_ns_};
  verdicts.overall = report.overall;
  verdicts.load_change = report.load_change;
  verdicts.speed_change = report.speed_change;
  for (std::size_t i = 0; i < std::min<std::size_t>(report.number_of_sensors, kMaxRadars); ++i) {
    if (is_radar(report.sensors[i].radar_id)) verdicts.sensors[verdicts.number_of_sensors++] = report.sensors[i];
  }
  const bool is_due = !has_verdicts_ || verdicts.at.time_ns - reported_ns_ >= kHealthPeriod_ns ||
                      !have_same_verdicts(verdicts, verdicts_);
  verdicts_ = verdicts;
  has_verdicts_ = true;
  is_reported_ = is_due;
  if (!is_due) return;
  reported_ns_ = verdicts.at.time_ns;
  if (listeners_.health) listeners_.health(verdicts);
}

void LiveResults::finish() {
  for (auto& [radar, places] : pending_) {
    for (Pending& place : places) {
      if (place.is_partial()) ++incomplete_[radar];
      place = {};
    }
  }
  if (has_verdicts_ && !is_reported_ && listeners_.health) listeners_.health(verdicts_);
  is_reported_ = true;
}

const SensorHealth* LiveResults::health_of(std::uint32_t radar) const {
  const auto end = verdicts_.sensors.begin() + static_cast<std::ptrdiff_t>(verdicts_.number_of_sensors);
  const auto found =
      std::find_if(verdicts_.sensors.begin(), end, [radar](const SensorHealth& s) { return s.radar_id == radar; });
  return found == end ? nullptr : &*found;
}

}  // namespace boresight::run
