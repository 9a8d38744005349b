// The plain tracker that every tracker must beat: clusters of one scan, nearest neighbour, Kalman filter with constant
// velocity. It knows no ghosts, no extents, no existence probability.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/common/geometry/dbscan.hpp"
#include "services/common/vehicle/vehicle.hpp"

namespace boresight::bench {

/// Nothing here was tuned on drives.
struct BaselineSettings {
  double cluster_radius_m = 2.0;       ///< choice: reflections of a car are nearer to each other than two cars
  std::size_t cluster_min_points = 1;  ///< choice: far cars have less than one detection a scan
  /// The test of the detection corrector (docs/algorithms/correction.md), with its defaults.
  double moving_sigma = 4.0;
  double body_motion_std_mps = 0.06;
  double gate = 9.21;           ///< χ² of 99 % with two degrees of freedom (Bar-Shalom, Li and Kirubarajan 2001)
  double position_std_m = 0.7;  ///< choice: where in a car the centre of a cluster lies
  double acceleration_std_mps2 = 3.0;       ///< choice: half of an emergency braking
  double radial_speed_std_mps = 1.0;        ///< choice: of the first velocity along the line of sight
  double tangential_speed_std_mps = 10.0;   ///< choice: across it, where nothing is measured
  int confirm_hits = 3, confirm_looks = 5;  ///< choice: usual 3 of 5
  int score_looks = 20;                     ///< at most 32; choice: a second of one radar
  int delete_misses = 5;                    ///< choice
  double longest_unseen_s = 1.0;            ///< choice: outside of all fields of view
  double length_m = 4.5, width_m = 1.8;     ///< choice: a car
};

/// A detection that the corrector did not reject, in the vehicle frame.
struct BaselineDetection {
  Eigen::Vector2d position_m;
  double range_rate_over_ground_mps = 0.0;
};

/// A scan with the motion of the vehicle and the sensor.
struct BaselineScan {
  double t_s = 0.0;
  std::uint32_t radar = 0;
  Eigen::Vector2d sensor_m = Eigen::Vector2d::Zero();  ///< vehicle frame
  Eigen::Vector2d sensor_velocity_mps = Eigen::Vector2d::Zero();
  double ego_speed_mps = 0.0, ego_yaw_rate_radps = 0.0;
  std::span<const BaselineDetection> detections;
};

struct BaselineTrack {
  std::uint32_t id = 0;
  bool confirmed = false, measured = false;
  double age_s = 0.0, since_update_s = 0.0;
  Eigen::Vector2d position_m, velocity_mps;  ///< vehicle frame; velocity over ground
  Eigen::Matrix4d covariance;                ///< over x, y, v_x, v_y
  std::uint32_t detections = 0;
  std::uint32_t hits = 0;  ///< in the last `score_looks` looks: the larger, the surer that there is an object
};

class BaselineTracker {
 public:
  explicit BaselineTracker(const VehicleConfig& vehicle, const BaselineSettings& settings = {});

  /// Scans in the order of time; a scan of an earlier time is taken at the time of the latest one.
  void step(const BaselineScan& scan);
  /// The tracks after the scan, confirmed ones first.
  [[nodiscard]] std::vector<BaselineTrack> tracks() const;
  /// Whether the range rate of a detection contradicts a stationary object.
  [[nodiscard]] bool is_moving(const BaselineDetection& detection, const BaselineScan& scan) const;

 private:
  /// State over (x, y, v_x, v_y) in a frame fixed to the ground.
  struct State {
    std::uint32_t id;
    double born_s, updated_s;
    Eigen::Vector4d mean;
    Eigen::Matrix4d covariance;
    std::uint32_t looks = 1;  // of the latest looks a bit each, 1: hit
    int misses = 0;
    bool confirmed = false, measured = true;
    std::uint32_t detections = 0;
  };
  struct Cluster {
    Eigen::Vector2d position_m;  // ground frame
    double range_rate_mps;
    std::uint32_t detections;
  };

  void move_ego(const BaselineScan& scan);
  void predict(double step_s);
  void find_clusters(const BaselineScan& scan);
  void associate();
  void update(State& track, const Cluster& cluster) const;
  [[nodiscard]] State born(const Cluster& cluster, const BaselineScan& scan);
  [[nodiscard]] bool sees(const BaselineScan& scan, const State& track) const;
  [[nodiscard]] Eigen::Matrix2d ego_rotation() const;

  VehicleConfig vehicle_;
  BaselineSettings settings_;
  geometry::Dbscan dbscan_;
  std::optional<double> time_s_;
  Eigen::Vector2d ego_m_ = Eigen::Vector2d::Zero();  // ground frame
  double ego_heading_rad_ = 0.0;
  std::uint32_t next_id_ = 1;
  std::vector<State> states_;
  std::vector<Cluster> clusters_;
  std::vector<std::size_t> cluster_of_;  // by track
  std::vector<bool> is_taken_;           // by cluster
};

}  // namespace boresight::bench
