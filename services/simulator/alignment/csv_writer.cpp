#include "services/simulator/alignment/csv_writer.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "services/common/geometry/frames.hpp"
#include "services/common/geometry/so3.hpp"
#include "services/simulator/alignment/bound.hpp"
#include "services/simulator/alignment/drive.hpp"
#include "services/simulator/alignment/truth_text.hpp"
#include "services/simulator/alignment/vehicle_toml.hpp"
#include "services/simulator/text_file.hpp"

namespace boresight::simulator {

namespace {

/// Root mean square of the range-rate residuals of stationary detections against a model.
class Rmse {
 public:
  void add(double residual) {
    sum_ += residual * residual;
    ++count_;
  }
  [[nodiscard]] double value() const { return count_ > 0 ? std::sqrt(sum_ / static_cast<double>(count_)) : 0.0; }

 private:
  double sum_ = 0.0;
  std::uint64_t count_ = 0;
};

/// Range rate of a stationary detection at given angles, predicted from the signalled motion.
class Expectation {
 public:
  Expectation(MountingModel model, const Eigen::Matrix3d& rotation, const RadarConfig& radar, double speed_mps,
              double yaw_rate_radps)
      : model_(model),
        rotation_(rotation),
        angles_(geometry::euler_angles(rotation)),
        velocity_(geometry::sensor_velocity(1.0, speed_mps, yaw_rate_radps, radar.mounting_pose.position_m)) {}
  [[nodiscard]] double range_rate(double azimuth, double elevation) const {
    if (model_ == MountingModel::kExact) {
      return geometry::stationary_range_rate(rotation_ * geometry::direction(azimuth, elevation), velocity_);
    }
    const double c = std::cos(angles_.z()), s = std::sin(angles_.z());
    return geometry::stationary_range_rate(  // Burza 2025, (10)–(12)
        geometry::direction(angles_.x() + azimuth * c - elevation * s, angles_.y() + elevation * c + azimuth * s),
        velocity_);
  }

 private:
  MountingModel model_;
  Eigen::Matrix3d rotation_;
  Eigen::Vector3d angles_;
  Eigen::Vector3d velocity_;
};

class DriveTable {
 public:
  DriveTable(const std::filesystem::path& file, const AlignmentSpec& spec)
      : file_(file),
        spec_(spec),
        stds_(any([](const AlignmentRadar& r) { return r.states_stds; })),
        ambiguity_(any([](const AlignmentRadar& r) { return r.ambiguity_mps > 0.0; })) {
    std::fprintf(file_.get(), "t,radar,range,az,el,vr,is_stationary%s%s\n", stds_ ? ",az_std,el_std,vr_std" : "",
                 ambiguity_ ? ",vr_min,vr_max" : "");
  }

  void add(const AlignmentEvent& event) {
    const RadarScan& scan = *event.scan;
    const double stamp_s = static_cast<double>(scan.header.measurement_time_ns) * 1e-9;  // late if the radar's are
    for (std::size_t i = 0; i < event.truth->size(); ++i) {
      std::FILE* const out = file_.get();
      std::fprintf(out, "%.4f,%u,%.2f,%.6f,", stamp_s - AlignmentDrive::kStart_s, scan.header.source_id,
                   number(scan.range_m[i]), number(scan.azimuth_rad[i]));
      if (scan.has(scan_field::kElevation)) std::fprintf(out, "%.6f", number(scan.elevation_rad[i]));
      std::fprintf(out, ",%.4f,%d", number(scan.range_rate_mps[i]), (*event.truth)[i].stationary ? 1 : 0);
      if (stds_) add_stds(scan, i);
      if (ambiguity_) {
        if (scan.has(scan_field::kAmbiguity)) {
          std::fprintf(out, ",%.4f,%.4f", number(scan.range_rate_min_mps), number(scan.range_rate_max_mps));
        } else {
          std::fputs(",,", out);
        }
      }
      std::fputc('\n', out);
    }
  }
  void finish() const { file_.finish(); }

 private:
  template <typename Predicate>
  [[nodiscard]] bool any(const Predicate& predicate) const {
    return std::any_of(spec_.radars.begin(), spec_.radars.end(), predicate);
  }
  static double number(float value) { return static_cast<double>(value); }
  void add_stds(const RadarScan& scan, std::size_t i) {
    if (!scan.has(scan_field::kStds)) {
      std::fputs(",,,", file_.get());
      return;
    }
    std::fprintf(file_.get(), ",%.6f,", number(scan.azimuth_std_rad[i]));
    if (scan.has(scan_field::kElevation)) std::fprintf(file_.get(), "%.6f", number(scan.elevation_std_rad[i]));
    std::fprintf(file_.get(), ",%.4f", number(scan.range_rate_std_mps[i]));
  }

  TextFile file_;
  const AlignmentSpec& spec_;
  bool stds_, ambiguity_;
};

}  // namespace

AlignmentFiles write_alignment_drive(const AlignmentSpec& spec, const std::filesystem::path& folder,
                                     const std::function<void(double)>& progress) {
  std::filesystem::create_directories(folder);
  AlignmentFiles files{folder / "drive.csv", folder / "ego.csv", folder / "vehicle.toml", folder / "truth.txt"};
  AlignmentDrive drive(spec);
  // An estimator does not know the disturbances of the drive: the bound has a prior for each.
  BoundPriors priors;
  if (spec.total_yaw_rate_bias_radps() != 0.0) priors.yaw_rate_bias_std_radps = 0.003;
  if (spec.total_slip_coefficient_radps2pm() != 0.0) priors.slip_coefficient_std_radps2pm = 0.005;
  std::optional<CramerRaoBound> bound;
  if (spec.model == MountingModel::kExact) bound.emplace(spec, drive, priors);

  DriveTable table(files.drive, spec);
  const TextFile ego(files.ego);
  std::fputs("t,v,yaw_rate\n", ego.get());
  Rmse uncorrected, at_truth;
  double speed = 0.0, yaw_rate = 0.0;  // as signalled last
  AlignmentEvent event;
  while (drive.next(event)) {
    if (bound) bound->add(event);
    if (event.ego != nullptr) {
      speed = static_cast<double>(event.ego->speed_mps);
      yaw_rate = static_cast<double>(event.ego->yaw_rate_radps);
      std::fprintf(ego.get(), "%.4f,%.5f,%.6f\n", event.time_s - AlignmentDrive::kStart_s, speed, yaw_rate);
      progress((event.time_s - AlignmentDrive::kStart_s) / spec.duration_s);
      continue;
    }
    table.add(event);
    ++files.scans;
    files.detections += event.truth->size();
    const AlignmentRadar& radar = spec.radars[event.radar];
    const Expectation nominal(spec.model, geometry::sensor_to_vehicle(radar.config.mounting_pose, 0.0, 0.0, 0.0),
                              radar.config, speed, yaw_rate);
    const Expectation truth(spec.model, drive.sensor_to_vehicle(event.radar, event.time_s), radar.config,
                            spec.speed_scale * speed, yaw_rate);
    for (std::size_t i = 0; i < event.truth->size(); ++i) {
      if (!(*event.truth)[i].stationary) continue;
      const RadarScan& scan = *event.scan;
      const auto azimuth = static_cast<double>(scan.azimuth_rad[i]);
      const auto elevation = static_cast<double>(scan.elevation_rad[i]);
      const auto residual = [&](const Expectation& expected) {
        const double difference = expected.range_rate(azimuth, elevation) - static_cast<double>(scan.range_rate_mps[i]);
        return radar.ambiguity_mps > 0.0 ? std::remainder(difference, radar.ambiguity_mps) : difference;
      };
      uncorrected.add(residual(nominal));
      at_truth.add(residual(truth));
    }
  }
  const TextFile vehicle(files.vehicle), truth(files.truth);
  std::fputs(vehicle_toml(drive.vehicle()).c_str(), vehicle.get());
  std::fputs(truth_text(spec, drive, {uncorrected.value(), at_truth.value()}, bound ? &*bound : nullptr).c_str(),
             truth.get());
  table.finish();
  for (const TextFile* file : {&ego, &vehicle, &truth}) file->finish();
  progress(1.0);
  return files;
}

}  // namespace boresight::simulator
