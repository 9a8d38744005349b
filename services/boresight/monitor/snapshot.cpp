#include "services/boresight/monitor/snapshot.hpp"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <istream>
#include <limits>
#include <ostream>
#include <sstream>

#include <fmt/format.h>

namespace boresight::monitor {

namespace {

/// The words of one line; one that is missing or not what was asked for reads as 0, and the first such is told.
class Words {
 public:
  explicit Words(const std::string& line) : input_(line) {}
  std::string text() {
    std::string word;
    input_ >> word;
    ++index_;
    if (word.empty()) refuse(word, {});
    return word;
  }
  double number() {  // also "nan"
    const std::string word = text();
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (end == word.c_str() + word.size()) return value;
    refuse(word, "a number");
    return 0.0;
  }
  std::uint64_t count(std::uint64_t most = std::numeric_limits<std::uint64_t>::max()) {
    const std::string word = text();
    std::uint64_t value = 0;
    const auto result = std::from_chars(word.data(), word.data() + word.size(), value);
    if (result.ec == std::errc() && result.ptr == word.data() + word.size() && value <= most) return value;
    refuse(word, fmt::format("a whole number from 0 to {}", most));
    return 0;
  }
  std::uint32_t number32() { return static_cast<std::uint32_t>(count(std::numeric_limits<std::uint32_t>::max())); }
  void refuse(const std::string& word, std::string_view allowed) {
    if (!ok()) return;
    error_ = word.empty() ? fmt::format("ends before word {}", index_)
                          : fmt::format("word {} is {}, allowed: {}", index_, quoted(word), allowed);
  }
  [[nodiscard]] bool ok() const { return error_.empty(); }
  [[nodiscard]] const std::string& error() const { return error_; }
  /// One of an enumeration's values, which count from 0 to `last`.
  template <typename Enum>
  Enum value(Enum last) {
    return static_cast<Enum>(count(static_cast<std::uint64_t>(last)));
  }
  AngleEstimate angle() {
    AngleEstimate result;
    result.value_rad = number();
    result.std_rad = number();
    result.observable = count() != 0;
    return result;
  }
  [[nodiscard]] bool more() { return static_cast<bool>(input_ >> std::ws) && input_.peek() != EOF; }

 private:
  std::istringstream input_;
  std::size_t index_ = 0;  // of the last word, from 1
  std::string error_;
};

void write_angle(std::ostream& output, const AngleEstimate& angle) {
  output << ' ' << angle.value_rad << ' ' << angle.std_rad << ' ' << (angle.observable ? 1 : 0);
}

RadarSnapshot read_radar(Words& words) {
  RadarSnapshot r;
  r.id = words.number32();
  r.name = words.text();
  r.scans = words.count();
  r.lost = words.count();
  r.rate_hz = words.number();
  r.detections = words.number32();
  r.moving = words.number32();
  r.ghosts = words.number32();
  r.state = words.value(AlignmentState::kConverged);
  r.yaw = words.angle();
  r.pitch = words.angle();
  r.roll = words.angle();
  r.speed_scale = words.number();
  r.speed_scale_std = words.number();
  r.data_qualifier = words.value(DataQualifier::kNotAvailable);
  r.extended_qualifier = words.value(ExtendedQualifier::kInitialising);
  r.yaw_tolerance_rad = words.number();
  r.conditions = words.number32();
  r.missed = words.count();
  r.suspect = words.count();
  if (!words.more()) return r;  // a record of an earlier version
  AlignmentDetails& d = r.details;
  for (AngleEstimate* const angle : {&d.yaw, &d.pitch, &d.roll, &d.yaw_rate_bias, &d.slip}) *angle = words.angle();
  d.knocks = words.number32();
  d.yaw_seconds_to_95_percent = words.number();
  d.pitch_seconds_to_95_percent = words.number();
  d.yaw_drift_radpmin = words.number();
  d.residual_rmse_mps = words.number();
  d.nees = words.number();
  if (!words.more()) return r;  // the same
  for (std::uint64_t& told : r.labels.told) told = words.count();
  r.labels.left_out = words.count();
  r.labels.scans = words.count();
  r.labels.scans_without_tracks = words.count();
  return r;
}

TrackSnapshot read_track(Words& words) {
  TrackSnapshot t;
  t.id = words.number32();
  t.confirmed = words.count() != 0;
  t.movement = words.value(MovementState::kStopped);
  t.x_m = words.number();
  t.y_m = words.number();
  t.vx_mps = words.number();
  t.vy_mps = words.number();
  t.age_s = words.number();
  return t;
}

ServiceSnapshot read_service(Words& words) {
  ServiceSnapshot s;
  s.service = words.value(static_cast<catalogue::Service>(catalogue::kNumberOfServices - 1));
  s.condition = words.value(ServiceCondition::kRestarted);
  s.restarts = words.number32();
  s.inputs = words.count();
  s.outputs = words.count();
  s.heap_allocations = words.count();
  s.processing_max_us = words.number();
  for (std::uint64_t& fault : s.faults) fault = words.count();
  return s;
}

void read_latency(Words& words, Snapshot& snapshot) {
  const std::uint64_t index = words.count(kNumberOfLatencies - 1);
  LatencyHistogram& histogram = snapshot.latencies[index];
  histogram.restore_max(words.number());
  while (words.more()) {
    const std::uint64_t bucket = words.count(LatencyHistogram::kBuckets - 1);
    // A count of which any sum still is a number.
    histogram.restore(bucket, words.count(std::numeric_limits<std::uint32_t>::max()));
  }
}

std::string json_number(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "null";
}

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

std::string axis_json(const char* name, const AngleEstimate& angle, double unit) {
  return fmt::format(R"("{}":{{"value":{},"std":{},"observable":{}}},)", name, json_number(angle.value_rad * unit),
                     json_number(angle.std_rad * unit), angle.observable);
}

std::string details_json(const AlignmentDetails& d) {
  return axis_json("vehicle_yaw_deg", d.yaw, kDegrees) + axis_json("vehicle_pitch_deg", d.pitch, kDegrees) +
         axis_json("vehicle_roll_deg", d.roll, kDegrees) + axis_json("yaw_rate_bias_degps", d.yaw_rate_bias, kDegrees) +
         axis_json("slip_coefficient_radps2pm", d.slip, 1.0) +
         fmt::format(R"("knocks":{},"yaw_seconds_to_95_percent":{},"pitch_seconds_to_95_percent":{},)"
                     R"("yaw_drift_degpmin":{},"residual_rmse_mps":{},"nees":{})",
                     d.knocks, json_number(d.yaw_seconds_to_95_percent), json_number(d.pitch_seconds_to_95_percent),
                     json_number(d.yaw_drift_radpmin * kDegrees), json_number(d.residual_rmse_mps),
                     json_number(d.nees));
}

/// Sums since the monitor began.
std::string labels_json(const LabelCounts& labels) {
  const auto& told = labels.told;
  return fmt::format(R"("told":{{"unknown":{},"moving":{},"stationary":{},"ghost_type_1":{},"ghost_type_2":{},)"
                     R"("clutter":{},"left_out":{}}},"classified_scans":{},"classified_without_tracks":{})",
                     told[0], told[1], told[2], told[3], told[4], told[5], labels.left_out, labels.scans,
                     labels.scans_without_tracks);
}

}  // namespace

void write_record(std::ostream& output, const Snapshot& snapshot) {
  output.precision(9);
  output << "snapshot " << snapshot.time_ns << ' ' << snapshot.ego_speed_mps << ' ' << snapshot.ego_yaw_rate_radps
         << ' ' << snapshot.track_lists << '\n';
  for (const RadarSnapshot& r : snapshot.radars) {
    output << "radar " << r.id << ' ' << r.name << ' ' << r.scans << ' ' << r.lost << ' ' << r.rate_hz << ' '
           << r.detections << ' ' << r.moving << ' ' << r.ghosts << ' ' << static_cast<int>(r.state);
    for (const AngleEstimate& angle : {r.yaw, r.pitch, r.roll}) write_angle(output, angle);
    output << ' ' << r.speed_scale << ' ' << r.speed_scale_std << ' ' << static_cast<int>(r.data_qualifier) << ' '
           << static_cast<int>(r.extended_qualifier) << ' ' << r.yaw_tolerance_rad << ' ' << r.conditions << ' '
           << r.missed << ' ' << r.suspect;
    const AlignmentDetails& d = r.details;
    for (const AngleEstimate& angle : {d.yaw, d.pitch, d.roll, d.yaw_rate_bias, d.slip}) write_angle(output, angle);
    output << ' ' << d.knocks << ' ' << d.yaw_seconds_to_95_percent << ' ' << d.pitch_seconds_to_95_percent << ' '
           << d.yaw_drift_radpmin << ' ' << d.residual_rmse_mps << ' ' << d.nees;
    for (const std::uint64_t told : r.labels.told) output << ' ' << told;
    output << ' ' << r.labels.left_out << ' ' << r.labels.scans << ' ' << r.labels.scans_without_tracks << '\n';
  }
  for (const TrackSnapshot& t : snapshot.tracks) {
    output << "track " << t.id << ' ' << (t.confirmed ? 1 : 0) << ' ' << static_cast<int>(t.movement) << ' ' << t.x_m
           << ' ' << t.y_m << ' ' << t.vx_mps << ' ' << t.vy_mps << ' ' << t.age_s << '\n';
  }
  for (const ServiceSnapshot& s : snapshot.services) {
    output << "service " << static_cast<int>(s.service) << ' ' << static_cast<int>(s.condition) << ' ' << s.restarts
           << ' ' << s.inputs << ' ' << s.outputs << ' ' << s.heap_allocations << ' ' << s.processing_max_us;
    for (const std::uint64_t fault : s.faults) output << ' ' << fault;
    output << '\n';
  }
  for (std::size_t i = 0; i < kNumberOfLatencies; ++i) {
    const LatencyHistogram& histogram = snapshot.latencies[i];
    output << "latency " << i << ' ' << histogram.max_us();
    for (std::size_t bucket = 0; bucket < LatencyHistogram::kBuckets; ++bucket) {
      if (histogram.counts()[bucket] != 0) output << ' ' << bucket << ' ' << histogram.counts()[bucket];
    }
    output << '\n';
  }
  output << "end\n";
}

std::vector<Snapshot> read_record(std::istream& input, const std::string& name, DamagedLines& damaged) {
  std::vector<Snapshot> snapshots;
  Snapshot current;
  bool open = false;    // a snapshot has begun, and all its lines so far were read
  bool spoilt = false;  // it had a line that could not be read, and is left out
  std::uint64_t number = 0;
  for (std::string line; std::getline(input, line);) {
    ++number;
    Words words(line);
    const std::string tag = words.text();
    if (tag == "snapshot") {
      if (open) damaged.add(name, number, "the snapshot before has no end");
      current = Snapshot();
      open = true;
      spoilt = false;
      current.time_ns = static_cast<std::int64_t>(words.count(std::numeric_limits<std::int64_t>::max()));
      current.ego_speed_mps = words.number();
      current.ego_yaw_rate_radps = words.number();
      current.track_lists = words.count();
    } else if (!open && !spoilt) {
      words.refuse(tag, "snapshot");
    } else if (tag == "radar") {
      current.radars.push_back(read_radar(words));
    } else if (tag == "track") {
      current.tracks.push_back(read_track(words));
    } else if (tag == "service") {
      current.services.push_back(read_service(words));
    } else if (tag == "latency") {
      read_latency(words, current);
    } else if (tag != "end") {
      words.refuse(tag, "snapshot, radar, track, service, latency or end");
    }
    if (!words.ok()) {
      damaged.add(name, number, words.error());
      open = false;
      spoilt = true;
    }
    if (tag == "end") {
      if (open) snapshots.push_back(current);
      open = spoilt = false;
    }
  }
  if (open) damaged.add(name, number, "the snapshot has no end");
  return snapshots;
}

std::string to_json(const Snapshot& snapshot) {
  std::string text = fmt::format(R"({{"time_ns":{},"ego_speed_mps":{},"track_lists":{},"radars":[)", snapshot.time_ns,
                                 json_number(snapshot.ego_speed_mps), snapshot.track_lists);
  const char* separator = "";
  for (const RadarSnapshot& r : snapshot.radars) {
    text += fmt::format(
        R"({}{{"id":{},"name":"{}","scans":{},"lost":{},"rate_hz":{},"detections":{},"moving":{},"ghosts":{},)"
        R"("state":"{}","yaw_deg":{},"yaw_std_deg":{},"pitch_deg":{},"pitch_std_deg":{},"speed_scale":{},)"
        R"("speed_scale_std":{},"data_qualifier":"{}","extended_qualifier":"{}","missed":{},"suspect":{},)"
        R"("conditions":"{}",)",
        separator, r.id, r.name, r.scans, r.lost, json_number(r.rate_hz), r.detections, r.moving, r.ghosts,
        name_of(r.state), json_number(r.yaw.value_rad * kDegrees), json_number(r.yaw.std_rad * kDegrees),
        json_number(r.pitch.value_rad * kDegrees), json_number(r.pitch.std_rad * kDegrees), json_number(r.speed_scale),
        json_number(r.speed_scale_std), name_of(r.data_qualifier), name_of(r.extended_qualifier), r.missed, r.suspect,
        words_of_conditions(r.conditions));
    text += details_json(r.details) + "," + labels_json(r.labels) + "}";
    separator = ",";
  }
  text += R"(],"tracks":[)";
  separator = "";
  for (const TrackSnapshot& t : snapshot.tracks) {
    text += fmt::format(R"({}{{"id":{},"confirmed":{},"movement":"{}","x_m":{},"y_m":{},"vx_mps":{},"vy_mps":{}}})",
                        separator, t.id, t.confirmed, name_of(t.movement), json_number(t.x_m), json_number(t.y_m),
                        json_number(t.vx_mps), json_number(t.vy_mps));
    separator = ",";
  }
  text += R"(],"services":[)";
  separator = "";
  for (const ServiceSnapshot& s : snapshot.services) {
    text += fmt::format(
        R"({}{{"name":"{}","condition":"{}","restarts":{},"inputs":{},"outputs":{},"heap_allocations":{},"faults":{{)",
        separator, catalogue::name_of(s.service), name_of(s.condition), s.restarts, s.inputs, s.outputs,
        s.heap_allocations);
    const char* comma = "";
    for (std::size_t i = 0; i < kNumberOfFaults; ++i) {
      if (s.faults[i] == 0) continue;
      text += fmt::format(R"({}"{}":{})", comma, name_of(static_cast<Fault>(i)), s.faults[i]);
      comma = ",";
    }
    text += "}}";
    separator = ",";
  }
  text += R"(],"latency_us":{)";
  separator = "";
  for (std::size_t i = 0; i < kNumberOfLatencies; ++i) {
    const LatencyHistogram& h = snapshot.latencies[i];
    text += fmt::format(R"({}"{}":{{"p50":{:.0f},"p99":{:.0f},"max":{:.0f}}})", separator, kLatencyNames[i],
                        h.percentile_us(0.5), h.percentile_us(0.99), h.max_us());
    separator = ",";
  }
  return text + "}}";
}

}  // namespace boresight::monitor
