#include "services/boresight/decode/csv.hpp"

#include <array>
#include <charconv>
#include <cstdlib>

#include "services/boresight/input/flag_words.hpp"

namespace boresight::decode {

namespace {

constexpr std::size_t kMaxNumber = 32;  // the longest text of a float or a 64-bit integer is shorter

/// Writes cells of one row straight into the text.
class Row {
 public:
  explicit Row(std::string& text) : text_(text) {}

  template <typename Number>
  void number(Number value) {
    separate();
    std::array<char, kMaxNumber> digits;
    text_.append(digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), value).ptr);
  }
  template <typename Number>
  void number_if(bool known, Number value) {
    if (known) {
      number(value);
    } else {
      separate();
    }
  }
  void word(std::string_view value) {
    separate();
    text_ += value;
  }
  void seconds(std::int64_t time_ns) {
    constexpr std::int64_t kSecond_ns = 1'000'000'000;
    separate();
    if (time_ns < 0) text_ += '-';
    std::array<char, kMaxNumber> digits;
    char* const end = std::to_chars(digits.data(), digits.data() + digits.size(), std::abs(time_ns / kSecond_ns)).ptr;
    text_.append(digits.data(), end);
    std::int64_t fraction = std::abs(time_ns % kSecond_ns);
    std::array<char, 10> decimals;
    for (std::size_t i = 9; i > 0; --i, fraction /= 10) decimals[i] = static_cast<char>('0' + fraction % 10);
    decimals[0] = '.';
    text_.append(decimals.data(), decimals.size());
  }
  void end() { text_ += '\n'; }

 private:
  void separate() {
    if (!first_) text_ += ',';
    first_ = false;
  }
  std::string& text_;
  bool first_ = true;
};

}  // namespace

std::string_view name_of(TimeSource source) {
  switch (source) {
    case TimeSource::kUnknown:
      return "unknown";
    case TimeSource::kSensorSynchronised:
      return "sensor_synchronised";
    case TimeSource::kSensorFreeRunning:
      return "sensor_free_running";
    case TimeSource::kLinkArrival:
      return "link_arrival";
    case TimeSource::kUserArrival:
      return "user_arrival";
  }
  return "unknown";
}

std::string integrity_names(std::uint16_t bits) {
  constexpr std::array<std::string_view, scan_integrity::kNumberOfBits> kNames = {
      "counter_gap", "repeated",        "frozen",     "stale",
      "implausible", "contradicts_ego", "incomplete", "impossible_copies"};
  std::string names;
  for (std::size_t bit = 0; bit < kNames.size(); ++bit) {
    if ((bits >> bit & 1) == 0) continue;
    if (!names.empty()) names += '+';
    names += kNames[bit];
  }
  return names;
}

std::string_view detection_header() {
  return "time_s,radar,cycle,index,range_m,azimuth_rad,elevation_rad,range_rate_mps,rcs_dbsm,snr_db,range_std_m,"
         "azimuth_std_rad,elevation_std_rad,range_rate_std_mps,range_rate_min_mps,range_rate_max_mps,existence,flags,"
         "time_source,integrity\n";
}

std::string_view ego_header() {
  return "time_s,speed_mps,speed_std_mps,yaw_rate_radps,yaw_rate_std_radps,steering_angle_rad,steering_angle_std_rad,"
         "longitudinal_acceleration_mps2,direction_known,time_source\n";
}

void append_detections(std::string& rows, const RadarScan& scan, std::uint32_t radar_id,
                       const ingest::MeasurementTime& time) {
  const std::string integrity = integrity_names(scan.integrity);
  const bool has_elevation = scan.has(scan_field::kElevation);
  const bool has_stds = scan.has(scan_field::kStds);
  const bool has_interval = scan.has(scan_field::kAmbiguity);
  for (std::uint32_t i = 0; i < scan.number_of_valid_detections && i < kMaxDetections; ++i) {
    Row row(rows);
    row.seconds(time.time_ns);
    row.number(radar_id);
    row.number(scan.cycle_counter);
    row.number(i);
    row.number(scan.range_m[i]);
    row.number(scan.azimuth_rad[i]);
    row.number_if(has_elevation, scan.elevation_rad[i]);
    row.number(scan.range_rate_mps[i]);
    row.number_if(scan.has(scan_field::kRcs), scan.rcs_dbsm[i]);
    row.number_if(scan.has(scan_field::kSnr), scan.snr_db[i]);
    row.number_if(has_stds, scan.range_std_m[i]);
    row.number_if(has_stds, scan.azimuth_std_rad[i]);
    row.number_if(has_stds && has_elevation, scan.elevation_std_rad[i]);
    row.number_if(has_stds, scan.range_rate_std_mps[i]);
    row.number_if(has_interval, scan.range_rate_min_mps);
    row.number_if(has_interval, scan.range_rate_max_mps);
    row.number_if(scan.has(scan_field::kExistence), scan.existence_probability[i]);
    row.word(input::kFlagWords[scan.detection_flags[i] % input::kFlagWords.size()]);
    row.word(name_of(time.source));
    row.word(integrity);
    row.end();
  }
}

void append_ego(std::string& rows, const EgoMotion& ego, const ingest::MeasurementTime& time) {
  const bool has_speed = ego.has(ego_field::kSpeed);
  const bool has_yaw_rate = ego.has(ego_field::kYawRate);
  const bool has_steering = ego.has(ego_field::kSteeringAngle);
  Row row(rows);
  row.seconds(time.time_ns);
  row.number_if(has_speed, ego.speed_mps);
  row.number_if(has_speed, ego.speed_std_mps);
  row.number_if(has_yaw_rate, ego.yaw_rate_radps);
  row.number_if(has_yaw_rate, ego.yaw_rate_std_radps);
  row.number_if(has_steering, ego.steering_angle_rad);
  row.number_if(has_steering, ego.steering_angle_std_rad);
  row.number(ego.longitudinal_acceleration_mps2);
  row.number(ego.has(ego_field::kReverse) ? 1 : 0);
  row.word(name_of(time.source));
  row.end();
}

}  // namespace boresight::decode
