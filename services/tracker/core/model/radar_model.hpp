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
#include "services/tracker/core/model/object_boxes.hpp"
#include "services/tracker/core/model/radar_occlusion.hpp"
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

/// What the radar of a scan may detect of an object, as moving.
struct Sight {
  double in_view = 0.0;       ///< probability that it is in view
  double hidden_share = 0.0;  ///< share of it that other tracked objects hide
  double seems_moving = 0.0;  ///< probability that its range rate is not taken for that of a stationary object
};

class RadarModel final : public Model {
 public:
  RadarModel(const VehicleConfig& vehicle, const RadarModelParameters& parameters, std::size_t max_objects);

  ScanStart begin_scan(const ClassifiedScan& scan) override;
  [[nodiscard]] std::span<const Measurement<double>> measurements() const override { return measurements_; }
  double predict(Component<double>& component, double elapsed_s) const override;
  [[nodiscard]] View<double> view(const Component<double>& component) const override { return look(component).view; }
  [[nodiscard]] std::span<const PoissonComponent> births() const override { return {}; }
  [[nodiscard]] bool has_births_anywhere() const override { return true; }
  void begin_group(std::span<const Measurement<double>> group, std::span<const Prediction<double>> objects,
                   std::span<const double> existence) override;
  [[nodiscard]] double log_newborn(const Cell<double>& cell) override;
  [[nodiscard]] Component<double> newborn(const Cell<double>& cell) override;
  [[nodiscard]] double log_odds_of_part(const Component<double>& whole, const Component<double>& part) override;
  void join(const Component<double>& whole, const Component<double>& part, std::uint32_t label) override;
  [[nodiscard]] double spread() const override { return parameters_.detection.spread; }
  [[nodiscard]] bool are_linked(const Measurement<double>& a, const Measurement<double>& b) const override;
  [[nodiscard]] double link_distance_m() const override { return parameters_.birth.link_distance_m; }
  void learn(std::span<const double> explained, std::span<const ObjectEstimate> objects) override;

  [[nodiscard]] const LocalAxes& axes() const { return axes_; }
  /// Index of the radar of the scan, −1 if it is none of the vehicle's.
  [[nodiscard]] int radar_index() const { return radar_index_; }
  /// Of an object after the scan.
  [[nodiscard]] Sight sight(const Component<double>& component) const;
  /// Of an object after the scan, in local axes; and the probabilities of its classes.
  [[nodiscard]] Box box(const Component<double>& object) const { return boxes_.box(object); }
  [[nodiscard]] const BoxMemory* memory(std::uint32_t label) const;

 private:
  struct Radar {
    std::uint32_t id = 0;
    double view_middle_rad = 0.0, half_view_rad = 0.0, range_max_m = 0.0;  // in the sensor's frame
    double range_std_m = 0.0, azimuth_std_rad = 0.0, range_rate_std_mps = 0.0;
    ClutterMap clutter;
    double wide_seen = 0.0, wide_expected = 0.0;  // detections of objects with wide range rates, and those of the table
    double moving_sum = 0.0, moving_count = 1.0, moving_time_s = 0.0;  // of the ghost filter's probabilities
  };
  struct Look {
    View<double> view;
    Sight sight;
  };
  struct KnownObject {
    Component<double> component;
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
  void find_occlusion();
  void add_side_lobes();
  void add_wide_range_rates();
  /// Probability that an object takes a place: nothing else can be there.
  [[nodiscard]] double taken_by(std::uint32_t label, const Vector2<double>& position_m,
                                const Symmetric2<double>& covariance_m2, double speed_mps,
                                const Vector2<double>& place_m) const;
  [[nodiscard]] Symmetric2<double> noise_at(const Vector2<double>& sight, double range_m) const;
  [[nodiscard]] double exposure_at(double range_m) const;
  [[nodiscard]] NewbornWeights newborn_weights(const Cell<double>& cell);

  /// Velocity that an unknown turn rate of an object pretends to a radar, equation (T16); one standard deviation.
  [[nodiscard]] Vector2<double> turn_at(const Vector2<double>& from_sensor_m, const Component<double>& component) const;
  [[nodiscard]] Look look(const Component<double>& component) const;
  /// Probability that an object of unknown heading is in view by azimuth.
  [[nodiscard]] double in_view(const Component<double>& component) const;
  /// Probability that its detections are not taken for those of a stationary object.
  [[nodiscard]] double seems_moving(const Vector2<double>& sight, const Component<double>& component,
                                    double range_rate_variance) const;
  /// Where an object's detections lie, by what it may be, and the variance of their range rates. Returns the share of
  /// its reflections that are in view; none while its heading is not known.
  std::optional<double> read_box(const Component<double>& component, View<double>& view) const;
  /// The same for all hypotheses of an object.
  [[nodiscard]] BoxReadings readings_of(const ObjectBoxes::Record& object) const;

  RadarModelParameters parameters_;
  double reach_m_ = 0.0;       ///< hardly any road user is longer: places farther apart are not of one
  mutable ObjectBoxes boxes_;  // views are computed when first asked for
  Occlusion occlusion_;
  std::vector<Radar> radars_;
  double elapsed_s_ = 0.0;
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
