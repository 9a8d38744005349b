// What a multi-object filter must know of the world: motion, sensor, clutter and births. The filters know nothing else.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "interfaces/messages/classified_scan.hpp"
#include "services/tracker/core/ggiw/component.hpp"
#include "services/tracker/core/ggiw/prediction.hpp"
#include "services/tracker/core/model/heading.hpp"

namespace boresight::tracking {

/// A component of the Poisson intensity of objects that nothing has detected yet.
struct PoissonComponent {
  double weight = 0.0;  ///< expected number of such objects
  Component<double> component;
};

/// Time of a scan relative to the one before, and what reading it found.
struct ScanStart {
  double elapsed_s = 0.0;  ///< negative for a scan that finished out of order
  bool restarted = false;  ///< the clock jumped: whatever was tracked is meaningless
  bool out_of_order = false;
  std::uint32_t dropped_detections = 0;
};

/// One object as a filter holds it after a scan.
struct ObjectEstimate {
  std::uint32_t id = 0;                          ///< never reused
  double existence = 0.0;                        ///< probability that there is an object
  double source_existence = 0.0;                 ///< probability that there is an object or a source of clutter
  bool detected = false;                         ///< the likeliest hypothesis has detections in this scan
  double detections = 0.0;                       ///< their number; fractional where shared
  Symmetric2<double> scatter;                    ///< Σ (z − z̄)(z − z̄)ᵀ of them, m²
  const Component<double>* component = nullptr;  ///< of the likeliest hypothesis; valid until the next step
  Vector2<double> mean_m{};                      ///< of the detections
  /// Share of its detections that are another object's by their weights. Of an object without detections: 1 if another
  /// has detections in its gate.
  double shared = 0.0;
  /// By the filter's own rule; without one, the reader of its existence decides.
  std::optional<bool> confirmed;
  /// Of its length axis, from the outline of its detections; independent of its course.
  std::optional<Heading> shape_heading;
};

class Model {
 public:
  virtual ~Model() = default;

  /// Reads a scan: its measurements in local axes, and the sensor's place for view().
  virtual ScanStart begin_scan(const ClassifiedScan& scan) = 0;
  [[nodiscard]] virtual std::span<const Measurement<double>> measurements() const = 0;

  /// Predicts a component to the scan; returns the probability that its object is still there.
  virtual double predict(Component<double>& component, double elapsed_s) const = 0;
  [[nodiscard]] virtual View<double> view(const Component<double>& component) const = 0;

  /// Births of this scan as components; empty where objects appear anywhere.
  [[nodiscard]] virtual std::span<const PoissonComponent> births() const = 0;
  /// Whether log_newborn() counts: objects may appear at any place, at any speed.
  [[nodiscard]] virtual bool has_births_anywhere() const = 0;
  /// The objects that a group holds already: a new one is unlikely inside them. `existence` as an object, by
  /// prediction.
  virtual void begin_group(std::span<const Measurement<double>> group, std::span<const Prediction<double>> objects,
                           std::span<const double> existence) = 0;
  /// log of the intensity of new objects that give this cell, over its clutter densities.
  [[nodiscard]] virtual double log_newborn(const Cell<double>& cell) = 0;
  [[nodiscard]] virtual Component<double> newborn(const Cell<double>& cell) = 0;

  /// log of how much likelier `part` is a part of the object `whole` than an object of its own, over the odds that are
  /// asked for; both exist, and have known speeds.
  [[nodiscard]] virtual double log_odds_of_part(const Component<double>& whole, const Component<double>& part) = 0;
  /// The object `whole` has the part from now on; what is known of it is that of the object `label`.
  virtual void join(const Component<double>& whole, const Component<double>& part, std::uint32_t label) = 0;
  /// Probabilities of an object's classes, in the order of RoadUserClass; empty where classes are not known.
  [[nodiscard]] virtual std::span<const double> class_probabilities(std::uint32_t) const { return {}; }
  /// Place of the scan's sensor in local axes.
  [[nodiscard]] virtual Vector2<double> sensor_m() const { return {}; }
  /// Covariance of detections relative to the extent.
  [[nodiscard]] virtual double spread() const = 0;
  /// Whether two measurements may be of one new object.
  [[nodiscard]] virtual bool are_linked(const Measurement<double>& a, const Measurement<double>& b) const = 0;
  [[nodiscard]] virtual double link_distance_m() const = 0;

  /// After the update: of each measurement the probability that a tracked object explains it, and the objects. The rest
  /// is clutter, from which the model learns.
  virtual void learn(std::span<const double> explained, std::span<const ObjectEstimate> objects) = 0;
};

}  // namespace boresight::tracking
