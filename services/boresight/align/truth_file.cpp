#include "services/boresight/align/truth_file.hpp"

#include <algorithm>
#include <cmath>
#include <istream>
#include <sstream>
#include <stdexcept>

#include <fmt/format.h>

#include "interfaces/messages/header.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/common/geometry/frames.hpp"

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

}  // namespace

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
      truth.step_changes.push_back({*time_s, static_cast<std::uint32_t>(std::clamp(*id, 0.0, 99.0)), *angles});
    } else if (kind == "disturbance") {
      const auto values = pairs(words);
      truth.yaw_rate_bias_radps = find(values, "yaw_rate_bias");
      truth.slip_coefficient_radps2pm = find(values, "rear_slip_coeff");
    }
  }
  std::stable_sort(truth.step_changes.begin(), truth.step_changes.end(),
                   [](const Truth::StepChange& a, const Truth::StepChange& b) { return a.time_s < b.time_s; });
  if (!truth.speed_scale && truth.radars.empty()) {
    throw std::runtime_error(name + ": holds no truth (lines \"k_v VALUE\" and \"radar ID … alpha_deg VALUE …\")");
  }
  return truth;
}

Eigen::Matrix3d true_mounting(const Truth::Radar& truth, const MountingPose& nominal) {
  return geometry::sensor_to_vehicle(truth.mount_rad[0].value_or(nominal.yaw_rad) + truth.sensor_rad[0],
                                     truth.mount_rad[1].value_or(nominal.pitch_rad) + truth.sensor_rad[1],
                                     truth.mount_rad[2].value_or(nominal.roll_rad) + truth.sensor_rad[2]);
}

}  // namespace boresight::align
