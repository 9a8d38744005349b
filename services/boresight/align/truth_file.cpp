#include "services/boresight/align/truth_file.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <istream>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "interfaces/messages/header.hpp"
#include "services/boresight/input/csv_table.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"
#include "services/common/vehicle/drive_truth.hpp"

namespace boresight::align {

namespace {

/// The pairs of a word and the number after it: (a, 1) in "a 1 b text". Words without a number are skipped.
std::map<std::string, double> pairs(std::istringstream& words) {
  std::map<std::string, double> result;
  std::string key;
  for (std::string word; words >> word; key = word) {
    char* end = nullptr;
    const double value = std::strtod(word.c_str(), &end);
    if (!key.empty() && *end == '\0' && std::isfinite(value)) result.emplace(key, value);
  }
  return result;
}

std::optional<double> find(const std::map<std::string, double>& values, const std::string& key) {
  const auto found = values.find(key);
  return found == values.end() ? std::nullopt : std::optional(found->second);
}

std::optional<std::array<double, 3>> sensor_angles(const std::map<std::string, double>& values) {
  const auto alpha = find(values, "alpha_deg"), beta = find(values, "beta_deg"), gamma = find(values, "gamma_deg");
  if (!alpha || !beta || !gamma) return std::nullopt;
  return std::array<double, 3>{*alpha * kRadiansPerDegree, *beta * kRadiansPerDegree, *gamma * kRadiansPerDegree};
}

constexpr std::string_view kDriveTruthHeader = "quantity,";

std::ifstream opened(const std::filesystem::path& file) {
  errno = 0;
  std::ifstream stream(file);
  if (!stream || stream.peek() == std::ifstream::traits_type::eof()) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), errno != 0 ? std::strerror(errno) : "is empty"));
  }
  return stream;
}

/// truth.csv: the speed scale, and the angles at the start.
void take_drive_truth(const std::filesystem::path& file, Truth& truth) {
  std::ifstream stream = opened(file);
  const DriveTruth drive = read_drive_truth(stream);
  if (std::isfinite(drive.speed_scale)) truth.speed_scale = drive.speed_scale;
  for (const auto& [id, radar] : drive.radars) {
    if (radar.range_rate_scale != 1.0) truth.range_rate_scales[id] = radar.range_rate_scale;
    if (!std::isfinite(radar.yaw_rad + radar.pitch_rad + radar.roll_rad)) continue;
    truth.radars[id].sensor_rad = {radar.yaw_rad, radar.pitch_rad, radar.roll_rad};
  }
}

/// truth_sensors.csv: the first angles of a radar that truth.csv does not state, and each step change.
void take_sensor_truth(const std::filesystem::path& file, double origin_s, Truth& truth) {
  constexpr std::array<input::Column, 6> kColumns = {{{"t_s", -4e9, 4e9, "s"},
                                                      {"radar", 1.0, double{kMaxRadars}, ""},
                                                      {"alignment_yaw_deg", -360.0, 360.0, "deg"},
                                                      {"alignment_pitch_deg", -360.0, 360.0, "deg"},
                                                      {"alignment_roll_deg", -360.0, 360.0, "deg"},
                                                      {"step_changes", 0.0, 1e9, ""}}};
  recording::ByteSource source(file);
  input::Problems problems([](const std::string& problem) { throw input::TableError(problem); });
  input::CsvTable table(source, kColumns, problems);
  std::map<std::uint32_t, double> changes;
  std::array<double, kColumns.size()> row{};
  while (table.next(row)) {
    const auto id = static_cast<std::uint32_t>(row[1]);
    const std::array<double, 3> angles = {row[2] * kRadiansPerDegree, row[3] * kRadiansPerDegree,
                                          row[4] * kRadiansPerDegree};
    if (!truth.radars.contains(id)) truth.radars[id].sensor_rad = angles;
    const auto [before, is_first] = changes.try_emplace(id, 0.0);
    if (row[5] > before->second) truth.step_changes.push_back({origin_s + row[0], id, angles});
    before->second = row[5];
  }
}

}  // namespace

Truth read_truth_at(const std::filesystem::path& where, double origin_s) {
  if (!std::filesystem::is_directory(where)) {
    std::ifstream stream = opened(where);
    std::string first;
    std::getline(stream, first);
    if (!first.starts_with(kDriveTruthHeader)) {
      stream.clear();
      stream.seekg(0);
      return read_truth(stream, where.string());
    }
    Truth truth;
    take_drive_truth(where, truth);
    if (!truth.speed_scale && truth.radars.empty()) throw std::runtime_error(where.string() + ": holds no truth");
    return truth;
  }
  Truth truth;
  if (std::filesystem::exists(where / "truth.csv")) take_drive_truth(where / "truth.csv", truth);
  if (std::filesystem::exists(where / "truth_sensors.csv")) {
    take_sensor_truth(where / "truth_sensors.csv", origin_s, truth);
  }
  if (!truth.speed_scale && truth.radars.empty()) {
    throw std::runtime_error(where.string() + ": holds no truth of mountings (truth.csv, truth_sensors.csv)");
  }
  return truth;
}

Truth read_truth(std::istream& input, const std::string& name) {
  Truth truth;
  int number = 0;
  for (std::string line; std::getline(input, line);) {
    ++number;
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    const auto fail = [&](const std::string& what) {
      throw std::runtime_error(fmt::format("{}:{}: {}", name, number, what));
    };
    const auto radar_id = [&](double id) {
      if (!(id >= 1.0 && id <= kMaxRadars && id == std::floor(id))) {
        fail(fmt::format("{}: radar: an id 1 … {} must follow", kind, kMaxRadars));
      }
      return static_cast<std::uint32_t>(id);
    };
    if (kind == "k_v") {
      double value = NAN;
      if (!(words >> value) || !std::isfinite(value)) fail("k_v: a number must follow");
      truth.speed_scale = value;
    } else if (kind == "radar") {
      std::uint32_t id = 0;
      if (!(words >> id) || id < 1 || id > kMaxRadars) fail(fmt::format("radar: an id 1 … {} must follow", kMaxRadars));
      const auto values = pairs(words);
      Truth::Radar radar;
      constexpr std::array<const char*, 3> kMounts = {"mount_az_deg", "mount_pitch_deg", "mount_roll_deg"};
      for (std::size_t i = 0; i < 3; ++i) {
        if (const auto mount = find(values, kMounts.at(i))) radar.mount_rad.at(i) = *mount * kRadiansPerDegree;
      }
      const auto angles = sensor_angles(values);
      if (!angles) fail(fmt::format("radar {}: alpha_deg, beta_deg and gamma_deg must follow, each with a number", id));
      radar.sensor_rad = *angles;
      truth.radars[id] = radar;
    } else if (kind == "step_change") {
      const auto values = pairs(words);
      const auto time_s = find(values, "t"), id = find(values, "radar");
      const auto angles = sensor_angles(values);
      if (!time_s || !id || !angles) fail("step_change: t, radar, alpha_deg, beta_deg and gamma_deg must follow");
      truth.step_changes.push_back({*time_s, radar_id(*id), *angles});
    } else if (kind == "disturbance") {
      const auto values = pairs(words);
      truth.yaw_rate_bias_radps = find(values, "yaw_rate_bias");
      truth.slip_coefficient_radps2pm = find(values, "rear_slip_coeff");
    } else if (kind == "real_car") {
      const auto values = pairs(words);
      const auto scale = find(values, "range_rate_scale"), id = find(values, "radar");
      if (scale && !id) fail("real_car range_rate_scale: a number, the unit 1, and radar with an id must follow");
      if (scale) truth.range_rate_scales[radar_id(*id)] = *scale;
    } else if (!kind.empty() && kind.front() != '#' && kind != "noise" && kind != "stationary" && kind != "crlb_sd" &&
               kind != "prototype") {
      fail(fmt::format(
          "unknown line \"{}\"; known are k_v, radar, step_change, disturbance, noise, real_car, stationary, crlb_sd, "
          "prototype and comments (#)",
          kind.substr(0, 40)));
    }
  }
  std::stable_sort(truth.step_changes.begin(), truth.step_changes.end(),
                   [](const Truth::StepChange& a, const Truth::StepChange& b) { return a.time_s < b.time_s; });
  if (!truth.speed_scale && truth.radars.empty()) {
    throw std::runtime_error(name + ": holds no truth (lines \"k_v VALUE\" and \"radar ID … alpha_deg VALUE …\")");
  }
  return truth;
}

std::optional<double> Truth::speed_scale_seen_by(std::uint32_t radar) const {
  if (!speed_scale) return std::nullopt;
  const auto found = range_rate_scales.find(radar);
  return speed_scale_seen(*speed_scale, found == range_rate_scales.end() ? 1.0 : found->second);
}

Eigen::Matrix3d true_mounting(const Truth::Radar& truth, const MountingPose& nominal) {
  return geometry::sensor_to_vehicle(truth.mount_rad[0].value_or(nominal.yaw_rad) + truth.sensor_rad[0],
                                     truth.mount_rad[1].value_or(nominal.pitch_rad) + truth.sensor_rad[1],
                                     truth.mount_rad[2].value_or(nominal.roll_rad) + truth.sensor_rad[2]);
}

}  // namespace boresight::align
