#include "services/boresight/calibrate/reflectors_report.hpp"

#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "services/boresight/calibrate/seed_json.hpp"
#include "services/common/estimation/unknown.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/text/measured.hpp"

namespace boresight::calibrate {

namespace reflectors = alignment::reflectors;

namespace {

std::string angle(const char* name, double value_rad, double std_rad, bool observable) {
  if (!observable) return fmt::format("  {:6}not observable (±{:.2f} deg)\n", name, std_rad * kDegreesPerRadian);
  return fmt::format(
      "  {:6}{}\n", name,
      text::with_std(value_rad * kDegreesPerRadian, std_rad * kDegreesPerRadian, " deg", text::Sign::kAlways));
}

json::Value angle_of(bool known, double value_rad, double std_rad, bool observable) {
  json::Value object;
  object["value_deg"] = known ? json::significant(value_rad * kDegreesPerRadian) : kNaN;
  object["std_deg"] = known ? json::significant(std_rad * kDegreesPerRadian) : kNaN;
  object["observable"] = known && observable;
  return object;
}

json::Value line_of(const ReflectorRun& run) {
  const reflectors::LineResult& line = run.line;
  json::Value object;
  object["ok"] = line.ok();
  object["problem"] = problem_of(run, line.problem, line.problem_position);
  object["across"] = line.across;
  object["yaw"] = angle_of(line.ok(), line.yaw_rad, line.yaw_std_rad, true);
  object["pitch"] = angle_of(line.ok() && run.config.has_elevation, line.pitch_rad, line.pitch_std_rad, true);
  return object;
}

json::Value position_of(const ReflectorRun& run, std::size_t index) {
  const reflectors::Position& position = run.table.positions[index];
  const reflectors::Result& result = run.result;
  json::Value object;
  object["x_m"] = json::significant(position.surveyed_m.x());
  object["y_m"] = json::significant(position.surveyed_m.y());
  object["z_m"] = json::significant(position.surveyed_m.z());
  object["scans"] = position.scans;
  object["residual_azimuth_deg"] = json::significant(result.residual_azimuth_rad[index] * kDegreesPerRadian);
  object["residual_elevation_deg"] =
      run.config.has_elevation ? json::significant(result.residual_elevation_rad[index] * kDegreesPerRadian) : kNaN;
  object["used"] = static_cast<bool>(result.used[index]);
  return object;
}

}  // namespace

std::string problem_of(const ReflectorRun& run, reflectors::Problem problem, std::size_t position) {
  using reflectors::Problem;
  if (problem == Problem::kNone) return "";
  std::string text(reflectors::explain(problem));
  if (problem == Problem::kTooFewPositions) {
    return fmt::format("{}: {}: {} given, allowed are {} or more", run.source, text, run.table.positions.size(),
                       run.config.min_positions);
  }
  const bool is_of_one = problem == Problem::kNotFinite || problem == Problem::kOutOfRange ||
                         problem == Problem::kOutOfView || problem == Problem::kNotALine;
  if (!is_of_one || position >= run.table.positions.size()) return fmt::format("{}: {}", run.source, text);
  const Eigen::Vector3d& place = run.table.positions[position].surveyed_m;
  text = fmt::format("{}:{}: {}: ({:g}, {:g}, {:g}) m", run.source, run.table.lines[position], text, place.x(),
                     place.y(), place.z());
  if (problem == Problem::kOutOfRange) {
    const auto& mount = run.radar.mounting_pose.position_m;
    text += fmt::format(" is {:.2f} m from the radar at ({:g}, {:g}, {:g}) m, allowed are {:g} … {:g} m",
                        (place - Eigen::Vector3d(mount.data())).norm(), mount[0], mount[1], mount[2],
                        run.config.range_min_m, run.config.range_max_m);
  } else if (problem == Problem::kNotALine) {
    text += fmt::format(", at most {:g} m beside the line are allowed", run.config.line_tolerance_m);
  }
  return text;
}

std::string to_table(const ReflectorRun& run) {
  const reflectors::Result& result = run.result;
  std::string text = fmt::format("radar {} {}: {} reflector positions{}\n", run.radar.id, run.radar.name,
                                 run.table.positions.size(), run.config.has_elevation ? "" : ", no elevation");
  if (!result.used.empty()) {
    constexpr int kResidualDecimals = 3;
    text += "     x/m      y/m      z/m  range/m  scans  residual azimuth/deg  elevation/deg\n";
    for (std::size_t i = 0; i < run.table.positions.size(); ++i) {
      const reflectors::Position& position = run.table.positions[i];
      text += fmt::format("{:8.2f} {:8.2f} {:8.2f} {:8.2f} {:6d} {:>21}", position.surveyed_m.x(),
                          position.surveyed_m.y(), position.surveyed_m.z(), position.range_m, position.scans,
                          text::fixed(result.residual_azimuth_rad[i] * kDegreesPerRadian, kResidualDecimals));
      text += fmt::format(" {:>14}",
                          run.config.has_elevation
                              ? text::fixed(result.residual_elevation_rad[i] * kDegreesPerRadian, kResidualDecimals)
                              : "");
      text += result.used[i] ? "\n" : "  not used\n";
    }
  }
  if (result.ok()) {
    text += fmt::format("directions ({} of {} positions, noise {:.2f} × as stated):\n", result.positions_used,
                        run.table.positions.size(), result.noise_scale);
    text += angle("yaw", result.yaw_rad, result.yaw_std_rad, true);
    text += angle("pitch", result.pitch_rad, result.pitch_std_rad, result.pitch_observable);
    text += angle("roll", result.roll_rad, result.roll_std_rad, result.roll_observable);
  } else {
    text += "FAILED: " + problem_of(run, result.problem, result.problem_position) + "\n";
  }
  if (run.line.ok()) {
    text += fmt::format("published line ({} the driving direction):\n", run.line.across ? "square to" : "along");
    text += angle("yaw", run.line.yaw_rad, run.line.yaw_std_rad, true);
    if (run.config.has_elevation) text += angle("pitch", run.line.pitch_rad, run.line.pitch_std_rad, true);
  } else if (result.ok()) {
    text += "published line: " + problem_of(run, run.line.problem, run.line.problem_position) + "\n";
  }
  return text;
}

std::string to_json(const ReflectorRun& run) {
  const reflectors::Result& result = run.result;
  const bool known = result.ok();
  json::Value object;
  object["tool"] = "boresight calibrate reflectors";
  object["version"] = run.tool_version;
  object["source"] = run.source;
  object["radar"] = run.radar.id;
  object["ok"] = known;
  object["problem"] = problem_of(run, result.problem, result.problem_position);
  object["has_elevation"] = run.config.has_elevation;
  object["yaw"] = angle_of(known, result.yaw_rad, result.yaw_std_rad, true);
  object["pitch"] = angle_of(known, result.pitch_rad, result.pitch_std_rad, result.pitch_observable);
  object["roll"] = angle_of(known, result.roll_rad, result.roll_std_rad, result.roll_observable);
  object["noise_scale"] = known ? json::significant(result.noise_scale) : kNaN;
  object["positions_used"] = result.positions_used;
  object["line"] = line_of(run);
  json::Value& positions = object["positions"] = json::Value::array();
  for (std::size_t i = 0; i < result.used.size(); ++i) positions.push_back(position_of(run, i));
  if (known) object["seed"] = object_of(result.rotation);
  return json::line(object);
}

}  // namespace boresight::calibrate
