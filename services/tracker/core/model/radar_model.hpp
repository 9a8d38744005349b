// The model of recorded radar scans: local axes that do not turn with the vehicle, polar noise, field of view,
// zero-Doppler blindness, learnt clutter, side lobes of objects, births anywhere.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "interfaces/messages/radar_scan.hpp"
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
  [[nodiscard]] std::span<const double> class_probabilities(std::uint32_t label) const override;
  [[nodiscard]] Vector2<double> sensor_m() const override { return sensor_m_; }
  [[nodiscard]] double spread() const override { return parameters_.detection.spread; }
  [[nodiscard]] bool are_linked(const Measurement<double>& a, const Measurement<double>& b) const override;
  [[nodiscard]] double link_distance_m() const override { return parameters_.birth.link_distance_m; }
  void learn(std::span<const double> explained, std::span<const ObjectEstimate> objects) override;

  [[nodiscard]] const LocalAxes& axes() const { return axes_; }
  /// Index of the radar of the scan, −1 if it is none of the vehicle's.
  [[nodiscard]] int radar_index() const { return radar_index_; }
  /// Of an object after the scan. What hides it is not looked for where it is in view with less than the probability
  /// `likely`, nor any further where that share is hidden.
  [[nodiscard]] Sight sight(const Component<double>& component, double likely) const;
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
    double strength_sum_db = 0.0, strengths = 0.0;  // of moving detections
    double levels_time_s = 0.0;
  };
  struct Look {
    View<double> view;
    Sight sight;
  };
  /// Range and range rate as the radar of the scan measures them, the same for an object and its side lobes.
  struct Ring {
    double range_m = 0.0, range_rate_mps = 0.0;  // relative to the sensor
    double range_variance_m2 = 0.0, range_rate_variance_m2ps2 = 0.0;
    Vector2<double> sight;
  };
  struct KnownObject {
    Component<double> component;
    double existence = 0.0;
    double side_lobe = 0.0;  // probability that it is a side lobe
    Ring ring;               // in the scan
    double ring_depth_m2 = 0.0;
    double in_beam = 0.0;        // probability that it exists in view of the radar
    double lobes_on_ring = 0.0;  // expected number of side lobes on its ring
  };
  struct MeanStrength {
    double mean_db = 0.0, number = 0.0;
  };
  /// For a component that is a side lobe of known objects.
  struct LobeEvidence {
    double odds = 0.0, on_ring = 0.0;
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
    double hidden_parent = 0.0;                                  // odds to an object
  };

  /// The objects after a scan; their side lobes are expected in the next one.
  void note_objects(std::span<const ObjectEstimate> objects);
  void move_axes(const ClassifiedScan& scan, double elapsed_s);
  /// Log of the factor by which the ghost filter's evidence raises the clutter intensity.
  [[nodiscard]] double log_origin(double log_likelihood_ratio) const;
  void read_detections(const ClassifiedScan& scan);
  void find_occlusion();
  /// Adds expected detections of a kind with so much `share` of the clutter at the measurement.
  static void add_clutter(Measurement<double>& z, double added, double& share);
  void add_side_lobes();
  void add_wide_range_rates();
  /// Chances that the scan shows what the measurements are side lobes of.
  void find_partners();
  void find_rings();
  /// Variances of a place about the ring of an object.
  struct RingSpread {
    double range_m2, range_rate_m2ps2;
  };
  [[nodiscard]] RingSpread ring_spread(const KnownObject& parent, const Ring& place) const;
  [[nodiscard]] Ring ring_of(const Component<double>& component) const;
  /// Squared distance of a place from the ring of an object, in deviations of side lobes.
  [[nodiscard]] double ring_distance(const KnownObject& parent, const Ring& place) const;
  /// Density of one side lobe per m² and m/s, at that distance from the ring.
  [[nodiscard]] double side_lobe_density(const KnownObject& parent, const Ring& place, double distance) const;
  /// Expected number of side lobes of an object that has so many lasting ones.
  [[nodiscard]] double side_lobe_level(double lobes_on_ring) const;
  /// Probability that a detection there is beside the main lobe on the object and beside its body.
  [[nodiscard]] double beside_share(const KnownObject& object, const Vector2<double>& place_m,
                                    const Symmetric2<double>& noise_m2, const Vector2<double>& sight) const;
  /// How much likelier the difference of the strengths is of a side lobe and its parent than of two objects.
  [[nodiscard]] double strength_odds(const MeanStrength& lobe, const MeanStrength& parent) const;
  /// Probability that a known object is one; 0 for others.
  [[nodiscard]] double side_lobe_of(std::uint32_t label) const;
  [[nodiscard]] LobeEvidence side_lobe_evidence(const Component<double>& component) const;
  /// The newborn `component` is a side lobe of an object that is not established with the odds `hidden` to an object.
  void begin_side_lobe(SourceClasses<double>& source, const Component<double>& component, double hidden) const;
  void weigh_side_lobe(Component<double>& component) const;
  /// Prediction of place, extent and classes without the evidence for side lobes.
  double move(Component<double>& component, double elapsed_s) const;
  /// Probability that an object takes a place: nothing else can be there.
  [[nodiscard]] double taken_by(std::uint32_t label, const Vector2<double>& position_m,
                                const Symmetric2<double>& covariance_m2, double speed_mps,
                                const Vector2<double>& place_m) const;
  [[nodiscard]] Symmetric2<double> noise_at(const Vector2<double>& sight, double range_m) const;
  [[nodiscard]] double exposure_at(double range_m) const;
  [[nodiscard]] NewbornWeights newborn_weights(const Cell<double>& cell);

  /// Velocity that an unknown turn rate of an object pretends to a radar, equation (T18); one standard deviation.
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
  struct Lobe {
    double range_m, range_variance_m2;
    const KnownObject* object;
  };
  std::vector<Lobe> lobes_;            // known objects that may be side lobes
  std::vector<std::size_t> by_range_;  // measurements

  // The group.
  std::array<Newborn, kBirthKinds> newborn_;
  std::span<const Prediction<double>> group_objects_;
  std::span<const double> group_existence_;
};

}  // namespace boresight::tracking
