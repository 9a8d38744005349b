// Stationary obstacles on the vehicle's path, tracked over scans. Equations (W9), (W10).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "services/common/geometry/dbscan.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/tracker/core/surroundings/ego_path.hpp"
#include "services/tracker/core/surroundings/stationary_memory.hpp"

namespace boresight::tracking {

struct PathObstacle {
  std::uint32_t id = 0;
  Eigen::Vector2d position_m{0.0, 0.0};  ///< mean of its detections
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Identity();
  Eigen::Matrix2d spread_m2 = Eigen::Matrix2d::Identity();  ///< of its detections about the mean
  double spread_weight = 0.0;
  double log_odds = 0.0;
  double age_s = 0.0, since_update_s = 0.0;
  bool is_detected = false;  ///< in this scan

  /// Half extent in a direction: that of a uniform density with its spread.
  [[nodiscard]] double half_extent_m(const Eigen::Vector2d& direction) const;
};

class PathObstacles {
 public:
  PathObstacles(const VehicleConfig& vehicle, const ObstacleParameters& parameters, double front_m);

  void clear();
  void step(const ClassifiedScan& scan, const StationaryMemory& memory, const EgoPath& path,
            const geometry::EgoStep& step, double elapsed_s);
  [[nodiscard]] std::span<const PathObstacle> obstacles() const { return obstacles_; }

 private:
  static constexpr std::size_t kMaxObstacles = 32;
  static constexpr std::size_t kBins = 8;
  static constexpr double kBin_m = 10.0;
  struct Radar {
    std::uint32_t id;
    FieldOfView view;
    std::array<double, kBins> density_per_m2{};  ///< of stationary detections in a scan, in the swept path
    double weight = 0.0;
  };
  void move(const geometry::EgoStep& step, double elapsed_s);
  void learn_density(const StationaryMemory& memory, const EgoPath& path, Radar& radar, double elapsed_s);
  void associate(const StationaryMemory& memory, const EgoPath& path);
  void judge(const ClassifiedScan& scan, const StationaryMemory& memory, const EgoPath& path);
  void update(PathObstacle& o, const StationaryMemory& memory, std::size_t index, double elapsed_s);
  void start(const StationaryMemory& memory, const EgoPath& path);
  void drop();

  ObstacleParameters parameters_;
  double front_m_;
  std::vector<Radar> radars_;
  std::vector<PathObstacle> obstacles_;
  std::vector<std::int32_t> owner_;  // of each detection of the scan
  std::vector<Eigen::Vector2d> places_;
  geometry::Dbscan clusters_;
  std::uint32_t next_id_ = 1;
  std::uint32_t scans_ = 0;
};

}  // namespace boresight::tracking
