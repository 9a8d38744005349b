// Class and box of a tracked object, from where its reflections are.
//
// The filter's place p is the centre of the reflections. Given a class k and its size, the reflection model says where
// that lies in the box: p = c + R(h) m_k. So the centre of the box is c = p − R(h) m_k, with the covariance of p and
// that of m_k (extended_object/reflection_model.hpp). The published box is the mixture over the classes by its moments;
// the class probabilities follow from the number of detections, their scatter and the largest speed.
#pragma once

#include <array>

#include <Eigen/Core>

#include "services/common/extended_object/object_classes.hpp"
#include "services/tracker/core/ggiw/component.hpp"

namespace boresight::tracking {

struct BoxParameters {
  double evidence_share = 0.2;        ///< of a scan's log likelihood of a class: scans are not independent
  double forget_s = 20.0;             ///< of the evidence for classes
  double side_slip_mps = 0.15;        ///< between heading and course
  double turn_rate_std_radps = 0.15;  ///< change of heading of a moving object
  double offset_gain = 0.3;           ///< with which the mean offset follows the latest scan
};

/// The scan as a box estimate needs it, in local axes.
struct BoxObservation {
  Vector2<double> sensor_m;
  Symmetric2<double> noise_m2;  ///< of one position
  double detections = 0.0;      ///< 0: none
  Symmetric2<double> scatter;   ///< Σ (z − z̄)(z − z̄)ᵀ
  double elapsed_s = 0.0;
};

struct ClassBox {
  double log_evidence = 0.0;
  double length_m = 0.0, length_variance_m2 = 0.0;
  Eigen::Vector2d offset_m{0.0, 0.0};  ///< m_k in box axes, mean of the latest scans
  Eigen::Matrix2d offset_covariance_m2 = Eigen::Matrix2d::Zero();
  bool has_offset = false;
};

/// What is remembered of a track.
struct BoxMemory {
  std::array<ClassBox, extended_object::kRoadUserClasses> classes;
  double heading_rad = 0.0, heading_variance_rad2 = 1e3;
  double largest_speed_mps = 0.0;  ///< of which it is sure
};

struct Box {
  Eigen::Vector2d centre_m{0.0, 0.0};
  Eigen::Matrix2d covariance_m2 = Eigen::Matrix2d::Zero();
  double heading_rad = 0.0, heading_variance_rad2 = 0.0;
  double length_m = 0.0, length_variance_m2 = 0.0, width_m = 0.0, width_variance_m2 = 0.0, height_m = 0.0;
  Eigen::Vector2d centre_length_covariance_m2{0.0, 0.0};
  std::array<double, extended_object::kRoadUserClasses> probability{};
};

class BoxEstimator {
 public:
  BoxEstimator(const extended_object::ObjectClassTable& table, const BoxParameters& parameters)
      : table_(table), parameters_(parameters) {}

  [[nodiscard]] BoxMemory begin() const;
  void update(BoxMemory& memory, const Component<double>& object, const BoxObservation& scan) const;
  [[nodiscard]] Box box(const BoxMemory& memory, const Component<double>& object) const;

 private:
  void follow_course(BoxMemory& memory, const Component<double>& object, double elapsed_s) const;
  [[nodiscard]] std::array<double, extended_object::kRoadUserClasses> probabilities(const BoxMemory& memory) const;

  extended_object::ObjectClassTable table_;
  BoxParameters parameters_;
};

}  // namespace boresight::tracking
