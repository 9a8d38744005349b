// Heading, class and box of a tracked object, from where its reflections are.
//
// The filter tracks one point p of the object: the middle of the reflections that it showed when its heading became
// known. By the reflection model (extended_object/reflection_model.hpp) and for a class k of length L_k, that point
// lies at ρ_k in the box, and a radar with another view sees the middle of its reflections at m_k. So the filter
// expects it at
//
//     (1)   p + R(h) δ_k,  δ_k = m_k − ρ_k,  covariance R(h) D_k R(h)ᵀ,
//     (2)   D_k = g gᵀ σ²(L_k) + σ_d² w wᵀ,  g = ∂m_k/∂L − ∂ρ_k/∂L,  w = u − u_ρ,
//
// u being the direction to the sensor, now and when p was chosen, and σ_d the object's own mean depth. From the same
// view δ and D are zero. A long vehicle shows one end to one radar and the other end to another: δ_k is then nearly its
// length, which the difference measures. The centre of the box is p − R(h) ρ_k. The published box is the mixture over
// the classes by its moments; their probabilities follow from the number of detections, their scatter, their place (1)
// and the largest speed.
#pragma once

#include <array>

#include <Eigen/Core>

#include "services/common/extended_object/object_classes.hpp"
#include "services/common/extended_object/reflection_model.hpp"
#include "services/tracker/core/ggiw/component.hpp"
#include "services/tracker/core/model/heading.hpp"
#include "services/tracker/core/model/road.hpp"
#include "services/tracker/core/model/turning.hpp"

namespace boresight::tracking {

struct BoxParameters {
  double evidence_share = 0.2;      ///< of a scan's log likelihood of a class: scans are not independent
  double stray_share = 0.1;         ///< of scans where a detection is not the object's
  double stray_m = 2.5;             ///< how far from the others
  double forget_s = 20.0;           ///< of the evidence for classes
  double side_slip_mps = 0.15;      ///< between heading and course
  TurnParameters turn;              ///< change of heading of a moving object
  RoadParameters road;              ///< what the road tells of headings
  double known_heading_rad = 0.35;  ///< deviation from which on the heading places the box
  double contradiction_chi2 = 9.0;  ///< squared distance from which on a course replaces a surer heading
  double sure_speed_sigma = 2.0;    ///< deviations below its speed that an object surely exceeds
  double least_length_share = 0.3;  ///< of the mean length of its class: no object is shorter
  double least_doubt = 1e-3;        ///< that a box holds a place or stays apart from another: no less likely
  double least_probability = 0.01;  ///< less likely classes are not computed
};

/// A radar, in local axes.
struct Viewpoint {
  Vector2<double> sensor_m;
  double facing_rad = 0.0, half_view_rad = 4.0, view_edge_rad = 0.0;
};

/// What an object of one class shows to a viewpoint; box axes.
struct ClassView {
  double probability = 0.0;  ///< 0: not computed
  extended_object::ReflectionMoments reflections;
  Eigen::Vector2d to_sensor{0.0, 0.0};                             ///< unit vector
  Eigen::Vector2d offset_m{0.0, 0.0};                              ///< δ of (1)
  Eigen::Matrix2d offset_covariance_m2 = Eigen::Matrix2d::Zero();  ///< D of (2)
  double expected_detections = 0.0;                                ///< in view
  double wide_share = 0.0;                                         ///< of them with range rates of moving parts
  double range_rate_variance_m2ps2 = 0.0;                          ///< of the body and small movements of its parts
};
using ClassViews = std::array<ClassView, extended_object::kRoadUserClasses>;

/// The detections of an object in a scan, in local axes.
struct BoxObservation {
  double elapsed_s = 0.0;
  Road road;
  double range_m = 0.0;         ///< from the sensor
  Symmetric2<double> noise_m2;  ///< of one position
  double detections = 0.0;      ///< 0: none
  Vector2<double> mean_m;
  Symmetric2<double> scatter;   ///< Σ (z − z̄)(z − z̄)ᵀ
  Vector2<double> predicted_m;  ///< p before the scan
  Symmetric2<double> predicted_covariance_m2;
};

struct ClassBox {
  double log_evidence = 0.0;
  double expected = 0.0, log_expected = 0.0;  ///< Σ m and Σ n log m over scans with n detections, m expected
  double length_m = 0.0, length_variance_m2 = 0.0;
  Eigen::Vector2d tracked_by_length_m2{0.0, 0.0};  ///< covariance of the tracked point and the length, box axes
  Eigen::Vector2d point_m{0.0, 0.0};               ///< ρ, box axes
  Eigen::Vector2d point_by_length{0.0, 0.0};       ///< ∂ρ/∂L
};

/// What is remembered of an object.
struct BoxMemory {
  std::array<ClassBox, extended_object::kRoadUserClasses> classes;
  std::array<double, extended_object::kRoadUserClasses> probability{};
  double heading_rad = 0.0, heading_variance_rad2 = 1e3;
  double largest_speed_mps = 0.0;       ///< of which it is sure
  double detections = 0.0;              ///< Σ n, as in ClassBox
  bool has_point = false;               ///< ρ is known
  Eigen::Vector2d to_sensor{0.0, 0.0};  ///< u_ρ, box axes
};

struct Box {
  Eigen::Vector2d centre_m{0.0, 0.0};
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Zero();
  double heading_rad = 0.0, heading_variance_rad2 = 0.0;
  double length_m = 0.0, length_variance_m2 = 0.0, width_m = 0.0, width_variance_m2 = 0.0, height_m = 0.0;
  Eigen::Vector2d centre_length_covariance_m2{0.0, 0.0};
};

class BoxEstimator {
 public:
  BoxEstimator(const extended_object::ObjectClassTable& table, const BoxParameters& parameters);

  /// Of an object that nothing is known of.
  [[nodiscard]] const BoxMemory& begin() const { return begun_; }
  [[nodiscard]] bool knows_heading(const BoxMemory& memory) const {
    return memory.heading_variance_rad2 < parameters_.known_heading_rad * parameters_.known_heading_rad;
  }
  /// Of an object with its tracked point at `position_m`; empty while its heading is unknown.
  [[nodiscard]] ClassViews view(const BoxMemory& memory, const Vector2<double>& position_m, double speed_mps,
                                const Viewpoint& viewpoint) const;
  void update(BoxMemory& memory, const Component<double>& object, const BoxObservation& scan,
              const ClassViews& views) const;
  /// A heading of the length axis, independent of the course; it corrects a heading that is known.
  void observe_heading(BoxMemory& memory, const Heading& heading) const;
  [[nodiscard]] Box box(const BoxMemory& memory, const Component<double>& object,
                        const Vector2<double>& sensor_m) const;
  /// Of an object that moves.
  [[nodiscard]] Course course(const Component<double>& object) const;
  /// Probability that it is no pedestrian.
  [[nodiscard]] static double vehicle_probability(const BoxMemory& memory);
  /// A place relative to an object's tracked point, in box axes; the covariance is that of the difference.
  struct Place {
    Eigen::Vector2d from_point_m{0.0, 0.0};
    Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Zero();
  };
  [[nodiscard]] Place place(const BoxMemory& memory, const Vector2<double>& from_point_m,
                            const Symmetric2<double>& covariance_m2) const;
  /// Probability that a place lies in the object's box grown by `margin_m`, if it is of the class; 0 while its heading
  /// is unknown.
  [[nodiscard]] double inside(const BoxMemory& memory, std::size_t object_class, const Place& place,
                              const Eigen::Vector2d& margin_m) const;
  /// Reflections at a place are the object's: it is of a class whose box holds them.
  void add_part(BoxMemory& memory, const Vector2<double>& from_point_m, const Symmetric2<double>& covariance_m2) const;
  [[nodiscard]] const extended_object::ObjectClassTable& table() const { return table_; }

 private:
  void follow_course(BoxMemory& memory, const Component<double>& object, double elapsed_s, const Road& road) const;
  /// Evidence for classes from number and spread of the detections, the heading unknown.
  void learn_without_heading(BoxMemory& memory, const BoxObservation& scan) const;
  void weigh_classes(BoxMemory& memory) const;
  /// log of the probability of all counts of an object of class k whose own level is gamma distributed, without terms
  /// that all classes share: its level lasts, so that counts alone never make sure of a class.
  [[nodiscard]] double log_counts(std::size_t k, double n, const ClassBox& box) const;
  /// Notes n detections where each class expects some; 0: not computed.
  void count(BoxMemory& memory, double n, const std::array<double, extended_object::kRoadUserClasses>& expected) const;
  /// log p(scan | class), and what the scan tells about the class's length.
  double learn_class(ClassBox& box, const ClassView& view, const extended_object::ObjectClassModel& model,
                     const BoxObservation& scan, const Eigen::Matrix2d& to_local,
                     const Eigen::Vector2d& to_sensor_of_point) const;

  extended_object::ObjectClassTable table_;
  BoxParameters parameters_;
  /// Of each class seen from afar, the heading unknown: distance from the middle of the reflections to the centre, away
  /// from the sensor, and the variances along the line of sight and across.
  struct AnyHeading {
    double depth_m = 0.0, along_m2 = 0.0, across_m2 = 0.0;
    double scatter_m2 = 0.0;  ///< of one reflection in each direction
  };
  std::array<AnyHeading, extended_object::kRoadUserClasses> any_heading_;
  /// Of each class: logs of its share and of terms of its number of detections.
  struct Prior {
    double log_share = 0.0, log_gamma_of_shape = 0.0, shape_log_shape = 0.0;
  };
  std::array<Prior, extended_object::kRoadUserClasses> prior_;
  BoxMemory begun_;
};

}  // namespace boresight::tracking
