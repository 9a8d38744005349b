// Reads monitor.jsonl: snapshots, a line each.
#include <istream>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "services/boresight/json/text.hpp"
#include "services/boresight/monitor/snapshot.hpp"
#include "services/boresight/run/words.hpp"
#include "services/common/estimation/unknown.hpp"
#include "services/common/geometry/angles.hpp"

namespace boresight::monitor {

namespace {

/// A field that is missing or not allowed.
class DamagedField : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The fields of an object, and the name of the object in errors.
class Fields {
 public:
  Fields(const json::Value& object, std::string name) : object_(object), name_(std::move(name)) {
    if (!object_.is_object()) throw DamagedField((name_.empty() ? "the line" : name_) + " is no object");
  }

  /// NaN for null.
  [[nodiscard]] double number(const std::string& key) const {
    const json::Value& value = at(key);
    if (value.is_null()) return kNaN;
    if (!value.is_number()) refuse(key, "a number");
    return value.get<double>();
  }
  template <typename Integer>
  void read(const std::string& key, Integer& out) const {
    const json::Value& value = at(key);
    if constexpr (std::is_signed_v<Integer>) {
      if (!value.is_number_integer()) refuse(key, "a whole number");
      out = value.get<Integer>();
    } else {
      constexpr std::uint64_t kMost = std::numeric_limits<Integer>::max();
      if (!value.is_number_unsigned() || value.get<std::uint64_t>() > kMost) {
        refuse(key, fmt::format("a whole number from 0 to {}", kMost));
      }
      out = value.get<Integer>();
    }
  }
  [[nodiscard]] bool flag(const std::string& key) const {
    const json::Value& value = at(key);
    if (!value.is_boolean()) refuse(key, "true or false");
    return value.get<bool>();
  }
  [[nodiscard]] std::string text(const std::string& key) const {
    const json::Value& value = at(key);
    if (!value.is_string()) refuse(key, "a text");
    return value.get<std::string>();
  }
  /// One of an enumeration's values, which count from 0 to `last`, by its name.
  template <typename Enum>
  [[nodiscard]] Enum value(const std::string& key, Enum last) const {
    const std::string word = text(key);
    std::string allowed;
    for (std::size_t i = 0; i <= static_cast<std::size_t>(last); ++i) {
      const std::string_view name = name_of(static_cast<Enum>(i));
      if (word == name) return static_cast<Enum>(i);
      allowed += fmt::format("{}{}", allowed.empty() ? "" : ", ", name);
    }
    refuse(key, allowed);
  }
  [[nodiscard]] Fields object(const std::string& key) const { return {at(key), path(key)}; }
  [[nodiscard]] const json::Value& array(const std::string& key) const {
    const json::Value& value = at(key);
    if (!value.is_array()) refuse(key, "an array");
    return value;
  }
  [[nodiscard]] const json::Value& object() const { return object_; }
  [[noreturn]] void refuse(const std::string& key, const std::string& allowed) const {
    std::string text = json::line(at(key));
    text.pop_back();  // the line feed
    throw DamagedField(fmt::format("{} is {}, allowed: {}", path(key), monitor::quoted(text), allowed));
  }

 private:
  [[nodiscard]] std::string path(const std::string& key) const { return name_.empty() ? key : name_ + "." + key; }
  [[nodiscard]] const json::Value& at(const std::string& key) const {
    const auto found = object_.find(key);
    if (found == object_.end()) throw DamagedField(path(key) + " is missing");
    return *found;
  }
  const json::Value& object_;
  std::string name_;
};

AngleEstimate sensor_angle(const Fields& fields, const std::string& name) {
  return {fields.number(name + "_deg") * kRadiansPerDegree, fields.number(name + "_std_deg") * kRadiansPerDegree,
          fields.flag(name + "_observable")};
}

AngleEstimate estimate_at(const Fields& fields, const std::string& key, double unit) {
  const Fields estimate = fields.object(key);
  return {estimate.number("value") * unit, estimate.number("std") * unit, estimate.flag("observable")};
}

AlignmentDetails details_at(const Fields& fields) {
  AlignmentDetails d;
  d.yaw = estimate_at(fields, "vehicle_yaw_deg", kRadiansPerDegree);
  d.pitch = estimate_at(fields, "vehicle_pitch_deg", kRadiansPerDegree);
  d.roll = estimate_at(fields, "vehicle_roll_deg", kRadiansPerDegree);
  d.yaw_rate_bias = estimate_at(fields, "yaw_rate_bias_degps", kRadiansPerDegree);
  d.slip = estimate_at(fields, "slip_coefficient_radps2pm", 1.0);
  fields.read("step_changes", d.step_changes);
  d.reason = fields.text("reason");
  d.finding = fields.text("finding");
  d.range_rate_scale = fields.number("range_rate_scale");
  d.range_rate_scale_std = fields.number("range_rate_scale_std");
  d.drift = fields.text("drift");
  d.yaw_seconds_to_95_percent = fields.number("yaw_seconds_to_95_percent");
  d.pitch_seconds_to_95_percent = fields.number("pitch_seconds_to_95_percent");
  d.yaw_drift_radpmin = fields.number("yaw_drift_degpmin") * kRadiansPerDegree;
  d.residual_rmse_mps = fields.number("residual_rmse_mps");
  d.nees = fields.number("nees");
  return d;
}

RadarSnapshot radar_at(const Fields& fields) {
  RadarSnapshot r;
  fields.read("id", r.id);
  r.name = fields.text("name");
  fields.read("scans", r.scans);
  fields.read("lost", r.lost);
  r.rate_hz = fields.number("rate_hz");
  fields.read("detections", r.detections);
  fields.read("moving", r.moving);
  fields.read("ghosts", r.ghosts);
  r.state = fields.value("state", AlignmentState::kConverged);
  r.yaw = sensor_angle(fields, "yaw");
  r.pitch = sensor_angle(fields, "pitch");
  r.roll = sensor_angle(fields, "roll");
  r.yaw_tolerance_rad = fields.number("yaw_tolerance_deg") * kRadiansPerDegree;
  r.speed_scale = fields.number("speed_scale");
  r.speed_scale_std = fields.number("speed_scale_std");
  r.data_qualifier = fields.value("data_qualifier", DataQualifier::kNotAvailable);
  r.extended_qualifier = fields.value("extended_qualifier", ExtendedQualifier::kWrongInput);
  r.explanation = fields.text("explanation");
  for (std::size_t i = 0; i < kBeyondKeys.size(); ++i) r.beyond_tolerance[i] = fields.flag(kBeyondKeys[i]);
  fields.read("missed", r.missed);
  fields.read("suspect", r.suspect);
  fields.read("condition_bits", r.conditions);
  r.details = details_at(fields);
  const Fields classified = fields.object("classified");
  for (std::size_t i = 0; i < run::kOriginWords.size(); ++i) {
    classified.read(std::string(run::kOriginWords[i]), r.labels.classified[i]);
  }
  classified.read("rejected", r.labels.rejected);
  fields.read("classified_scans", r.labels.scans);
  fields.read("classified_without_tracks", r.labels.scans_without_tracks);
  return r;
}

TrackSnapshot track_at(const Fields& fields) {
  TrackSnapshot t;
  fields.read("id", t.id);
  t.confirmed = fields.flag("confirmed");
  t.movement = fields.value("movement", MovementState::kStopped);
  t.object_class = fields.value("class", ObjectClass::kVan);
  t.existence = fields.number("existence");
  t.mirror_probability = fields.number("mirror_probability");
  t.x_m = fields.number("x_m");
  t.y_m = fields.number("y_m");
  t.vx_mps = fields.number("vx_mps");
  t.vy_mps = fields.number("vy_mps");
  t.age_s = fields.number("age_s");
  return t;
}

ServiceSnapshot service_at(const Fields& fields) {
  using catalogue::name_of;
  ServiceSnapshot s;
  s.service = fields.value("name", static_cast<catalogue::Service>(catalogue::kNumberOfServices - 1));
  s.condition = fields.value("condition", ServiceCondition::kRestarted);
  fields.read("restarts", s.restarts);
  fields.read("inputs", s.inputs);
  fields.read("outputs", s.outputs);
  fields.read("heap_allocations", s.heap_allocations);
  s.processing_max_us = fields.number("processing_max_us");
  s.latency_mean_us = fields.number("latency_mean_us");
  s.latency_max_us = fields.number("latency_max_us");
  const Fields faults = fields.object("faults");
  for (std::size_t i = 0; i < kNumberOfFaults; ++i) {
    const std::string name(boresight::name_of(static_cast<Fault>(i)));
    if (faults.object().contains(name)) faults.read(name, s.faults[i]);
  }
  return s;
}

PipelineSnapshot pipeline_at(const Fields& fields) {
  PipelineSnapshot p;
  p.data_qualifier = fields.value("data_qualifier", DataQualifier::kNotAvailable);
  fields.read("failed_event_bits", p.failed_events);
  fields.read("lost_scans", p.lost_scans);
  fields.read("budget_hits", p.budget_hits);
  p.queueing_max_ms = fields.number("queueing_max_ms");
  p.latency_p99_ms = fields.number("latency_p99_ms");
  return p;
}

LatencyHistogram latency_at(const Fields& fields) {
  LatencyHistogram histogram;
  histogram.restore_max(fields.number("max"));
  for (const json::Value& bucket : fields.array("buckets")) {
    // A count of which any sum still is a number.
    constexpr std::uint64_t kMostCount = std::numeric_limits<std::uint32_t>::max();
    if (!bucket.is_array() || bucket.size() != 2 || !bucket[0].is_number_unsigned() ||
        !bucket[1].is_number_unsigned() || bucket[0].get<std::uint64_t>() >= LatencyHistogram::kBuckets ||
        bucket[1].get<std::uint64_t>() > kMostCount) {
      fields.refuse("buckets",
                    fmt::format("pairs of a bucket from 0 to {} and a count", LatencyHistogram::kBuckets - 1));
    }
    histogram.restore(bucket[0].get<std::size_t>(), bucket[1].get<std::uint64_t>());
  }
  return histogram;
}

template <typename Each, typename Read>
void read_array(const Fields& fields, const std::string& key, std::vector<Each>& out, const Read& read) {
  for (const json::Value& each : fields.array(key)) {
    out.push_back(read(Fields(each, fmt::format("{}[{}]", key, out.size()))));
  }
}

Snapshot snapshot_at(const Fields& fields) {
  Snapshot snapshot;
  fields.read("time_ns", snapshot.time_ns);
  snapshot.ego_speed_mps = fields.number("ego_speed_mps");
  snapshot.ego_yaw_rate_radps = fields.number("ego_yaw_rate_radps");
  fields.read("track_lists", snapshot.track_lists);
  snapshot.overall = fields.value("overall", DataQualifier::kNotAvailable);
  snapshot.pipeline = pipeline_at(fields.object("pipeline"));
  snapshot.load_change = fields.text("load_change");
  snapshot.speed_change = fields.text("speed_change");
  read_array(fields, "radars", snapshot.radars, radar_at);
  read_array(fields, "tracks", snapshot.tracks, track_at);
  read_array(fields, "services", snapshot.services, service_at);
  const Fields latencies = fields.object("latency_us");
  for (std::size_t i = 0; i < kNumberOfLatencies; ++i) {
    snapshot.latencies[i] = latency_at(latencies.object(std::string(kLatencyNames[i])));
  }
  return snapshot;
}

}  // namespace

std::vector<Snapshot> read_snapshots(std::istream& input, const std::string& name, DamagedLines& damaged) {
  std::vector<Snapshot> snapshots;
  std::uint64_t number = 0;
  for (std::string line; std::getline(input, line);) {
    ++number;
    try {
      const json::Value value = json::Value::parse(line, nullptr, false);
      if (value.is_discarded()) throw DamagedField("the line is no JSON");
      snapshots.push_back(snapshot_at({value, ""}));
    } catch (const DamagedField& problem) {
      damaged.add(name, number, problem.what());
    }
  }
  return snapshots;
}

}  // namespace boresight::monitor
