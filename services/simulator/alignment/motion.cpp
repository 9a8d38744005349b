#include "services/simulator/alignment/motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace boresight::simulator {

namespace {

constexpr double kStep_s = 0.01;
constexpr double kSlowest_mps = 5.0;  // Burza 2025: slower scans carry too little information

enum class Shape : std::uint8_t { kStraight, kWide, kCurve, kCorner };

struct Habit {
  std::array<double, 4> shares;  // by Shape
  double slowest_mps, fastest_mps;
};

Habit habit_of(RoadKind road) {
  switch (road) {
    case RoadKind::kCity:
      return {{0.5, 0.0, 0.3, 0.2}, 6.0, 15.0};
    case RoadKind::kMotorway:
      return {{0.6, 0.4, 0.0, 0.0}, 24.0, 35.0};
    case RoadKind::kStraight:
      return {{1.0, 0.0, 0.0, 0.0}, 5.0, 35.0};
    case RoadKind::kSlow:
      return {{0.55, 0.0, 0.3, 0.15}, 5.5, 11.5};
    case RoadKind::kMixed:
      break;
  }
  return {{0.4, 0.2, 0.25, 0.15}, 5.0, 35.0};
}

Shape draw_shape(const Habit& habit, Stream& stream) {
  double left = stream.uniform();
  for (std::size_t i = 0; i + 1 < habit.shares.size(); ++i) {
    left -= habit.shares[i];
    if (left < 0.0) return static_cast<Shape>(i);
  }
  return habit.shares.back() > 0.0 ? Shape::kCorner : Shape::kStraight;
}

}  // namespace

AlignmentRoad::AlignmentRoad(const AlignmentSpec& spec)
    : spec_(spec),
      segments_(spec.seed, "alignment road"),
      pitch_(spec.seed, "alignment body pitch"),
      side_slip_(spec.real_car, spec.seed, spec.duration_s),
      pitch_decay_(std::exp(-kStep_s / std::max(spec.body_pitch_correlation_s, 1e-6))),
      segment_(draw_segment()),
      segment_end_s_(segment_.duration_s),
      before_{segment_.speed_mps, 0.0, 0.0, spec.body_pitch_std_rad * pitch_.gaussian()},
      after_(before_) {
  step();
}

AlignmentRoad::Segment AlignmentRoad::draw_segment() {
  const Habit habit = habit_of(spec_.road);
  const Shape shape = draw_shape(habit, segments_);
  // Every segment takes the same number of draws, whatever its shape.
  const double speed = segments_.uniform(), length = segments_.uniform(), radius = segments_.uniform();
  const double side = segments_.uniform() < 0.5 ? -1.0 : 1.0;
  const auto between = [](double low, double high, double share) { return low + (high - low) * share; };
  double slowest = habit.slowest_mps, fastest = habit.fastest_mps;
  if (spec_.road == RoadKind::kMixed && shape == Shape::kCurve) slowest = 8.0, fastest = 20.0;
  if (shape == Shape::kCorner) slowest = 5.0, fastest = 7.5;
  Segment segment{between(slowest, fastest, speed), 0.0, 0.0};
  switch (shape) {
    case Shape::kStraight:
      segment.duration_s = between(5.0, 20.0, length);
      break;
    case Shape::kWide:
      segment.duration_s = between(5.0, 15.0, length);
      segment.curvature_per_m = side / between(400.0, 1500.0, radius);
      break;
    case Shape::kCurve:
      segment.duration_s = between(4.0, 10.0, length);
      segment.curvature_per_m = side / between(40.0, 250.0, radius);
      break;
    case Shape::kCorner:
      segment.duration_s = between(3.0, 6.0, length);
      segment.curvature_per_m = side / between(9.0, 18.0, radius);
      break;
  }
  constexpr double kComfortable_mps2 = 3.0;
  if (segment.curvature_per_m != 0.0) {
    segment.speed_mps = std::min(segment.speed_mps, std::sqrt(kComfortable_mps2 / std::abs(segment.curvature_per_m)));
  }
  segment.speed_mps = std::max(segment.speed_mps, kSlowest_mps);
  return segment;
}

void AlignmentRoad::step() {
  before_ = after_;
  if (static_cast<double>(index_) * kStep_s >= segment_end_s_) {
    segment_ = draw_segment();
    segment_end_s_ += segment_.duration_s;
  }
  // The driver reaches the segment's speed and curvature with delays of 1.5 and 0.8 s.
  after_.acceleration_mps2 = std::clamp((segment_.speed_mps - before_.speed_mps) / 1.5, -3.0, 2.0);
  after_.speed_mps = before_.speed_mps + after_.acceleration_mps2 * kStep_s;
  after_.curvature_per_m =
      before_.curvature_per_m + (segment_.curvature_per_m - before_.curvature_per_m) / 0.8 * kStep_s;
  after_.pitch_rad = pitch_decay_ * before_.pitch_rad +
                     spec_.body_pitch_std_rad * std::sqrt(1.0 - pitch_decay_ * pitch_decay_) * pitch_.gaussian();
}

AlignmentMotion AlignmentRoad::at(double time_s) {
  while (time_s >= static_cast<double>(index_ + 1) * kStep_s) {
    ++index_;
    step();
  }
  const double share = std::clamp(time_s / kStep_s - static_cast<double>(index_), 0.0, 1.0);
  const auto blend = [share](double a, double b) { return a + share * (b - a); };
  AlignmentMotion motion;
  motion.speed_mps = blend(before_.speed_mps, after_.speed_mps);
  motion.acceleration_mps2 = blend(before_.acceleration_mps2, after_.acceleration_mps2);
  constexpr double kGrip_mps2 = 3.2;  // largest lateral acceleration
  const double speed = std::max(motion.speed_mps, 1.0), sharpest_per_m = kGrip_mps2 / (speed * speed);
  motion.yaw_rate_radps = motion.speed_mps * std::clamp(blend(before_.curvature_per_m, after_.curvature_per_m),
                                                        -sharpest_per_m, sharpest_per_m);
  motion.lateral_speed_mps =
      -spec_.total_slip_coefficient_radps2pm() * motion.speed_mps * motion.speed_mps * motion.yaw_rate_radps;
  const double side_slip_rad = car::side_slip_share(motion.speed_mps) * side_slip_.at(time_s);
  if (side_slip_rad != 0.0) motion.lateral_speed_mps += motion.speed_mps * std::tan(side_slip_rad);
  double nose_down_rad = blend(before_.pitch_rad, after_.pitch_rad) -
                         spec_.body_pitch_per_acceleration_radps2pm * motion.acceleration_mps2;
  if (spec_.real_car.load_pitch_rad != 0.0) nose_down_rad -= car::load_pitch_rad(spec_.real_car, time_s);
  motion.vertical_speed_mps = motion.speed_mps * nose_down_rad;
  return motion;
}

}  // namespace boresight::simulator
