#include "services/boresight/monitor/snapshot.hpp"

#include <cmath>
#include <istream>
#include <limits>
#include <ostream>

#include <fmt/format.h>

#include "services/boresight/monitor/words.hpp"
#include "services/common/geometry/angles.hpp"

namespace boresight::monitor {

namespace {

AngleEstimate read_angle(Words& words, const std::string& axis) {
  AngleEstimate result;
  words.read(axis, result.value_rad);
  words.read(axis + "'s std", result.std_rad);
  result.observable = words.at_most(axis + "'s observability", 1) != 0;
  return result;
}

void write_angle(std::ostream& output, const AngleEstimate& angle) {
  output << ' ' << angle.value_rad << ' ' << angle.std_rad << ' ' << (angle.observable ? 1 : 0);
}

void read_details(Words& words, AlignmentDetails& d) {
  d.yaw = read_angle(words, "yaw about the vehicle's axes");
  d.pitch = read_angle(words, "pitch about the vehicle's axes");
  d.roll = read_angle(words, "roll about the vehicle's axes");
  d.yaw_rate_bias = read_angle(words, "yaw rate bias");
  d.slip = read_angle(words, "slip");
  words.read("step_changes", d.step_changes);
  words.read("seconds to 95 % of yaw", d.yaw_seconds_to_95_percent);
  words.read("seconds to 95 % of pitch", d.pitch_seconds_to_95_percent);
  words.read("drift of yaw", d.yaw_drift_radpmin);
  words.read("residual", d.residual_rmse_mps);
  words.read("NEES", d.nees);
}

RadarSnapshot read_radar(Words& words) {
  RadarSnapshot r;
  words.read("radar id", r.id);
  r.name = words.text("radar's name");
  words.read("scans", r.scans);
  words.read("scans lost", r.lost);
  words.read("rate", r.rate_hz);
  words.read("detections", r.detections);
  words.read("moving", r.moving);
  words.read("ghosts", r.ghosts);
  r.state = words.value("alignment state", AlignmentState::kConverged);
  r.yaw = read_angle(words, "yaw");
  r.pitch = read_angle(words, "pitch");
  r.roll = read_angle(words, "roll");
  words.read("speed scale", r.speed_scale);
  words.read("std of the speed scale", r.speed_scale_std);
  r.data_qualifier = words.value("data qualifier", DataQualifier::kNotAvailable);
  r.extended_qualifier = words.value("extended qualifier", ExtendedQualifier::kInitialising);
  words.read("tolerance of yaw", r.yaw_tolerance_rad);
  words.read("conditions", r.conditions);
  words.read("missed", r.missed);
  words.read("suspect", r.suspect);
  if (!words.more()) return r;  // a record of an earlier version
  read_details(words, r.details);
  if (!words.more()) return r;  // the same
  for (std::uint64_t& count : r.labels.classified) words.read("detections with a label", count);
  words.read("detections rejected", r.labels.rejected);
  words.read("scans with labels", r.labels.scans);
  words.read("scans without tracks", r.labels.scans_without_tracks);
  return r;
}

TrackSnapshot read_track(Words& words) {
  TrackSnapshot t;
  words.read("track id", t.id);
  t.confirmed = words.at_most("confirmed", 1) != 0;
  t.movement = words.value("movement", MovementState::kStopped);
  words.read("x", t.x_m);
  words.read("y", t.y_m);
  words.read("speed along x", t.vx_mps);
  words.read("speed along y", t.vy_mps);
  words.read("age", t.age_s);
  return t;
}

ServiceSnapshot read_service(Words& words) {
  ServiceSnapshot s;
  s.service = words.value("service", static_cast<catalogue::Service>(catalogue::kNumberOfServices - 1));
  s.condition = words.value("condition", ServiceCondition::kRestarted);
  words.read("restarts", s.restarts);
  words.read("inputs", s.inputs);
  words.read("outputs", s.outputs);
  words.read("heap allocations", s.heap_allocations);
  words.read("longest processing", s.processing_max_us);
  for (std::uint64_t& fault : s.faults) words.read("faults", fault);
  return s;
}

void read_latency(Words& words, Snapshot& snapshot) {
  LatencyHistogram& histogram = snapshot.latencies[words.at_most("stage", kNumberOfLatencies - 1)];
  double max_us = 0.0;
  words.read("longest latency", max_us);
  histogram.restore_max(max_us);
  while (words.more() && words.ok()) {
    const std::size_t bucket = words.at_most("bucket", LatencyHistogram::kBuckets - 1);
    // A count of which any sum still is a number.
    histogram.restore(bucket, words.at_most("count of a bucket", std::numeric_limits<std::uint32_t>::max()));
  }
}

std::string json_number(double value) {
  return std::isfinite(value) ? fmt::format("{:.6g}", value) : "null";
}

std::string axis_json(const char* name, const AngleEstimate& angle, double unit) {
  return fmt::format(R"("{}":{{"value":{},"std":{},"observable":{}}},)", name, json_number(angle.value_rad * unit),
                     json_number(angle.std_rad * unit), angle.observable);
}

std::string details_json(const AlignmentDetails& d) {
  return axis_json("vehicle_yaw_deg", d.yaw, kDegreesPerRadian) +
         axis_json("vehicle_pitch_deg", d.pitch, kDegreesPerRadian) +
         axis_json("vehicle_roll_deg", d.roll, kDegreesPerRadian) +
         axis_json("yaw_rate_bias_degps", d.yaw_rate_bias, kDegreesPerRadian) +
         axis_json("slip_coefficient_radps2pm", d.slip, 1.0) +
         fmt::format(R"("step_changes":{},"yaw_seconds_to_95_percent":{},"pitch_seconds_to_95_percent":{},)"
                     R"("yaw_drift_degpmin":{},"residual_rmse_mps":{},"nees":{})",
                     d.step_changes, json_number(d.yaw_seconds_to_95_percent),
                     json_number(d.pitch_seconds_to_95_percent), json_number(d.yaw_drift_radpmin * kDegreesPerRadian),
                     json_number(d.residual_rmse_mps), json_number(d.nees));
}

/// Sums since the start of the monitor.
std::string labels_json(const LabelCounts& labels) {
  const auto& by_label = labels.classified;
  return fmt::format(R"("classified":{{"unknown":{},"moving":{},"stationary":{},"ghost_type_1":{},"ghost_type_2":{},)"
                     R"("clutter":{},"rejected":{}}},"classified_scans":{},"classified_without_tracks":{})",
                     by_label[0], by_label[1], by_label[2], by_label[3], by_label[4], by_label[5], labels.rejected,
                     labels.scans, labels.scans_without_tracks);
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
    output << ' ' << d.step_changes << ' ' << d.yaw_seconds_to_95_percent << ' ' << d.pitch_seconds_to_95_percent << ' '
           << d.yaw_drift_radpmin << ' ' << d.residual_rmse_mps << ' ' << d.nees;
    for (const std::uint64_t count : r.labels.classified) output << ' ' << count;
    output << ' ' << r.labels.rejected << ' ' << r.labels.scans << ' ' << r.labels.scans_without_tracks << '\n';
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
  bool spoilt = false;  // it has a damaged line and is skipped
  std::uint64_t number = 0;
  for (std::string line; std::getline(input, line);) {
    ++number;
    Words words(line);
    const std::string_view tag = words.word();
    if (tag == "snapshot") {
      if (open) damaged.add(name, number, "the snapshot before has no end");
      current = Snapshot();
      open = true;
      spoilt = false;
      words.read("time", current.time_ns);
      words.read("speed", current.ego_speed_mps);
      words.read("yaw rate", current.ego_yaw_rate_radps);
      words.read("track lists", current.track_lists);
    } else if (!open && !spoilt) {
      words.refuse("kind of line", tag, "snapshot");
    } else if (tag == "radar") {
      current.radars.push_back(read_radar(words));
    } else if (tag == "track") {
      current.tracks.push_back(read_track(words));
    } else if (tag == "service") {
      current.services.push_back(read_service(words));
    } else if (tag == "latency") {
      read_latency(words, current);
    } else if (tag != "end") {
      words.refuse("kind of line", tag, "snapshot, radar, track, service, latency or end");
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
        name_of(r.state), json_number(r.yaw.value_rad * kDegreesPerRadian),
        json_number(r.yaw.std_rad * kDegreesPerRadian), json_number(r.pitch.value_rad * kDegreesPerRadian),
        json_number(r.pitch.std_rad * kDegreesPerRadian), json_number(r.speed_scale), json_number(r.speed_scale_std),
        name_of(r.data_qualifier), name_of(r.extended_qualifier), r.missed, r.suspect,
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
