// The model of recorded radar scans: local axes that do not turn with the vehicle, polar noise, field of view,
// zero-Doppler blindness, learnt clutter, side lobes of objects, births anywhere.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "interfaces/messages/track_list.hpp"
#include "services/common/vehicle/vehicle.hpp"
#include "services/tracker/core/model/clutter_map.hpp"
#include "services/tracker/core/model/model.hpp"
#include "services/tracker/core/model/radar_parameters.hpp"

namespace boresight::tracking {

/// Place and axes of the vehicle in the tracker's local axes: the origin moves with the vehicle, the axes do not turn.
struct LocalAxes {
  double heading_rad = 0.0;  ///< of the vehicle
  [[nodiscard]] Vector2<double> to_local(const Vector2<double>& vehicle) const;
  [[nodiscard]] Vector2<double> to_vehicle(const Vector2<double>& local) const;
  [[nodiscard]] Symmetric2<double> to_vehicle(const Symmetric2<double>& local) const;
  [[nodiscard]] Matrix2<double> to_vehicle(const Matrix2<double>& local) const;

 private:
  [[nodiscard]] Matrix2<double> rotation() const;
};

class RadarModel final : public Model {
 public:
  RadarModel(const VehicleConfig& vehicle, const RadarModelParameters& parameters);

  ScanStart begin_scan(const ClassifiedScan& scan) override;
  [[nodiscard]] std::span<const Measurement<double>> measurements() const override { return measurements_; }
  double predict(Component<double>& component, double elapsed_s) const override;
  [[nodiscard]] View<double> view(const Component<double>& component) const override;
  [[nodiscard]] std::span<const PoissonComponent> births() const override { return {}; }
  [[nodiscard]] bool has_births_anywhere() const override { return true; }
  void begin_group(std::span<const Measurement<double>> group, std::span<const Prediction<double>> objects,
                   std::span<const double> existence) override;
  [[nodiscard]] double log_newborn(const Cell<double>& cell) override;
  [[nodiscard]] Component<double> newborn(const Cell<double>& cell) override;
  [[nodiscard]] bool are_one(const Component<double>& a, const Component<double>& b) const override;
  [[nodiscard]] double spread() const override { return parameters_.detection.spread; }
  [[nodiscard]] bool are_linked(const Measurement<double>& a, const Measurement<double>& b) const override;
  [[nodiscard]] double link_distance_m() const override { return parameters_.birth.link_distance_m; }
  void learn(std::span<const double> explained, std::span<const ObjectEstimate> objects) override;

  [[nodiscard]] const LocalAxes& axes() const { return axes_; }
  /// The sensor of the scan, in local axes.
  [[nodiscard]] const Vector2<double>& sensor_m() const { return sensor_m_; }

 private:
  struct Radar {
    std::uint32_t id = 0;
    double view_middle_rad = 0.0, half_view_rad = 0.0, range_max_m = 0.0;  // in the sensor's frame
    double range_std_m = 0.0, azimuth_std_rad = 0.0, range_rate_std_mps = 0.0;
    ClutterMap clutter;
    double moving_sum = 0.5, moving_count = 1.0, moving_time_s = 0.0;  // of the ghost filter's probabilities
  };
  struct KnownObject {
    Vector2<double> position_m, velocity_mps;
    Symmetric2<double> extent_m2;
    double existence = 0.0;
  };
  static constexpr std::size_t kBirthKinds = 3;
  /// A new object of one kind of motion, at a place known so badly that any cell near is as likely as any other.
  struct Newborn {
    Component<double> component;
    Prediction<double> prediction;
    double log_density = 0.0;
  };
  /// Logs of the likelihoods of what a new cell may be, over its clutter.
  struct NewbornWeights {
    std::array<double, kBirthKinds> object{};
    double source = 0.0, side_lobe = 0.0, top = 0.0, sum = 0.0;  // sum: relative to e^top
  };

  /// The objects after a scan; their side lobes are expected in the next one.
  void note_objects(std::span<const ObjectEstimate> objects);
  void move_axes(const ClassifiedScan& scan, double elapsed_s);
  /// log of how much likelier than for the radar's usual detection it is that this one is no moving object's.
  [[nodiscard]] double log_origin(double moving_probability) const;
  void read_detections(const ClassifiedScan& scan);
  void add_side_lobes();
  /// Half the size of the place that an object takes about its reflections, along its course and across: nothing else
  /// can be there.
  [[nodiscard]] Vector2<double> taken_m(double speed_mps, double extent_along_m2) const;
  [[nodiscard]] Symmetric2<double> noise_at(const Vector2<double>& sight, double range_m) const;
  [[nodiscard]] double exposure_at(double range_m) const;
  [[nodiscard]] NewbornWeights newborn_weights(const Cell<double>& cell);

  RadarModelParameters parameters_;
  std::vector<Radar> radars_;
  LocalAxes axes_;
  std::int64_t time_ns_ = 0;
  bool has_time_ = false;

  // The scan.
  Radar* radar_ = nullptr;
  int radar_index_ = -1;
  Vector2<double> sensor_m_;             // local axes
  Vector2<double> displacement_m_;       // of the origin since the scan before
  double facing_rad_ = 0.0;              // of the field of view's middle, local axes
  Vector2<double> sensor_velocity_mps_;  // over ground, local axes
  std::vector<Measurement<double>> measurements_;
  std::vector<ClutterPlace> places_;
  std::vector<KnownObject> objects_;

  // The group.
  std::array<Newborn, kBirthKinds> newborn_;
  std::span<const Prediction<double>> group_objects_;
  std::span<const double> group_existence_;
};

}  // namespace boresight::tracking
