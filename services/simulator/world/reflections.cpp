#include "services/simulator/world/reflections.hpp"

#include <array>
#include <cmath>
#include <span>

namespace boresight::simulator {

namespace {

/// Motion of a spot relative to its body.
enum class Micro : std::uint8_t { kNone, kWheel, kLimb, kPedal };

/// A reflection centre on a body. `ahead` and `left` are shares of half the length and half the width.
struct Spot {
  double ahead, left;
  double height_m;
  double facing_ahead, facing_left;
  double rcs_dbsm;
  Micro micro = Micro::kNone;
  double phase = 0.0;  ///< added to the body's phase
};

constexpr double kDiagonal = 0.70710678118654752;
constexpr double kWheelRadius_m = 0.32;
constexpr double kGaitLength_m = 1.4;  // two steps
constexpr double kGaitSwing = 0.9;     // a limb's speed swings by this share of the body's
constexpr double kPedalRadius_m = 0.17;
constexpr double kPedalGear_m = 5.0;  // distance travelled per turn of the cranks

// Point reflectors at corners and middles, as usual in extended-target models of automotive radar: ends and corners are
// strong, rims are weaker.
constexpr std::array<Spot, 12> kCar = {{{1, 1, 0.6, kDiagonal, kDiagonal, 7},
                                        {1, -1, 0.6, kDiagonal, -kDiagonal, 7},
                                        {-1, 1, 0.6, -kDiagonal, kDiagonal, 7},
                                        {-1, -1, 0.6, -kDiagonal, -kDiagonal, 7},
                                        {1, 0, 0.6, 1, 0, 9},
                                        {-1, 0, 0.6, -1, 0, 9},
                                        {0, 1, 0.6, 0, 1, 8},
                                        {0, -1, 0.6, 0, -1, 8},
                                        {0.6, 1, kWheelRadius_m, 0, 1, -6, Micro::kWheel, 0.0},
                                        {0.6, -1, kWheelRadius_m, 0, -1, -6, Micro::kWheel, 0.3},
                                        {-0.6, 1, kWheelRadius_m, 0, 1, -6, Micro::kWheel, 0.6},
                                        {-0.6, -1, kWheelRadius_m, 0, -1, -6, Micro::kWheel, 0.8}}};
constexpr std::array<Spot, 20> kTruck = {{{1, 1, 0.9, kDiagonal, kDiagonal, 12},
                                          {1, -1, 0.9, kDiagonal, -kDiagonal, 12},
                                          {-1, 1, 1.2, -kDiagonal, kDiagonal, 12},
                                          {-1, -1, 1.2, -kDiagonal, -kDiagonal, 12},
                                          {1, 0, 0.8, 1, 0, 14},
                                          {-1, 0, 1.1, -1, 0, 14},
                                          {0.55, 1, 1.1, 0, 1, 10},
                                          {0.55, -1, 1.1, 0, -1, 10},
                                          {0.1, 1, 1.2, 0, 1, 10},
                                          {0.1, -1, 1.2, 0, -1, 10},
                                          {-0.35, 1, 1.2, 0, 1, 10},
                                          {-0.35, -1, 1.2, 0, -1, 10},
                                          {-0.75, 1, 1.1, 0, 1, 10},
                                          {-0.75, -1, 1.1, 0, -1, 10},
                                          {0.7, 1, 0.5, 0, 1, -4, Micro::kWheel, 0.0},
                                          {0.7, -1, 0.5, 0, -1, -4, Micro::kWheel, 0.3},
                                          {-0.5, 1, 0.5, 0, 1, -4, Micro::kWheel, 0.6},
                                          {-0.5, -1, 0.5, 0, -1, -4, Micro::kWheel, 0.8},
                                          {-0.7, 1, 0.5, 0, 1, -4, Micro::kWheel, 0.1},
                                          {-0.7, -1, 0.5, 0, -1, -4, Micro::kWheel, 0.5}}};
constexpr std::array<Spot, 5> kPedestrian = {{{0, 0, 1.1, 0, 0, -6},
                                              {0, 0.5, 0.4, 0, 0, -13, Micro::kLimb, 0.0},
                                              {0, -0.5, 0.4, 0, 0, -13, Micro::kLimb, 0.5},
                                              {0, 0.9, 1.0, 0, 0, -17, Micro::kLimb, 0.5},
                                              {0, -0.9, 1.0, 0, 0, -17, Micro::kLimb, 0.0}}};
constexpr std::array<Spot, 6> kCyclist = {{{0, 0, 1.2, 0, 0, -4},
                                           {-0.1, 0, 0.6, 0, 0, -4},
                                           {0.6, 0, kWheelRadius_m, 0, 0, -12, Micro::kWheel, 0.0},
                                           {-0.6, 0, kWheelRadius_m, 0, 0, -12, Micro::kWheel, 0.4},
                                           {0, 0.4, 0.4, 0, 0, -14, Micro::kPedal, 0.0},
                                           {0, -0.4, 0.4, 0, 0, -14, Micro::kPedal, 0.5}}};

std::span<const Spot> spots_of(BodyKind kind) {
  switch (kind) {
    case BodyKind::kCar:
    case BodyKind::kVan:
      return kCar;
    case BodyKind::kTruck:
      return kTruck;
    case BodyKind::kPedestrian:
      return kPedestrian;
    case BodyKind::kCyclist:
      return kCyclist;
  }
  return {};
}

/// Displacement of a spot ahead and up, and its rate.
struct Swing {
  double ahead_m = 0.0, up_m = 0.0, ahead_mps = 0.0, up_mps = 0.0;
};

/// A point that rotates at `radius_m` about an axle, once per `turn_m` of distance travelled.
Swing turning(double radius_m, double turn_m, double travelled_m, double speed_mps, double phase) {
  const double angle = 2.0 * M_PI * (travelled_m / turn_m + phase);
  const double rim_mps = 2.0 * M_PI * radius_m / turn_m * speed_mps;
  return {radius_m * std::sin(angle), radius_m * std::cos(angle), rim_mps * std::cos(angle),
          -rim_mps * std::sin(angle)};
}

Swing swing_of(const Spot& spot, double travelled_m, double speed_mps, GaitPhase body_phase) {
  const double phase = spot.phase + body_phase;
  switch (spot.micro) {
    case Micro::kNone:
      return {};
    case Micro::kWheel:
      // The rim lies a little inside the tyre.
      return turning(0.85 * kWheelRadius_m, 2.0 * M_PI * kWheelRadius_m, travelled_m, speed_mps, phase);
    case Micro::kPedal:
      return turning(kPedalRadius_m, kPedalGear_m, travelled_m, speed_mps, phase);
    case Micro::kLimb: {
      const double angle = 2.0 * M_PI * (travelled_m / kGaitLength_m + phase);
      return {kGaitSwing * kGaitLength_m / (2.0 * M_PI) * std::sin(angle), 0.0,
              kGaitSwing * speed_mps * std::cos(angle), 0.0};
    }
  }
  return {};
}

}  // namespace

Dimensions dimensions_of(BodyKind kind) {
  switch (kind) {
    case BodyKind::kCar:
      return {4.5, 1.9, 1.5, 0.2};
    case BodyKind::kVan:
      return {5.5, 2.0, 2.4, 0.25, 0.25};
    case BodyKind::kTruck:
      // Underrun guards hang at most 0.55 m above the road (UN regulations 58 and 73). The sides therefore mirror at
      // the height of radars and cars, although waves pass below the body.
      return {12.0, 2.5, 3.8, 0.8, 0.5};
    case BodyKind::kPedestrian:
      return {0.5, 0.5, 1.75, 0.0};
    case BodyKind::kCyclist:
      return {1.8, 0.6, 1.75, 0.0};
  }
  return {};
}

void add_centres(Body& body, double travelled_m, double speed_mps, GaitPhase phase,
                 std::vector<ReflectionCentre>& centres) {
  const std::span<const Spot> spots = spots_of(body.kind);
  body.first_centre = static_cast<std::uint32_t>(centres.size());
  body.number_of_centres = static_cast<std::uint32_t>(spots.size());
  const Eigen::Vector2d ahead(std::cos(body.heading_rad), std::sin(body.heading_rad));
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  for (const Spot& spot : spots) {
    const Swing swing = swing_of(spot, travelled_m, speed_mps, phase);
    const Eigen::Vector2d offset =
        (0.5 * body.length_m * spot.ahead + swing.ahead_m) * ahead + 0.5 * body.width_m * spot.left * left;
    const Eigen::Vector2d position = body.position_m + offset;
    const Eigen::Vector2d velocity =
        body.velocity_mps + body.yaw_rate_radps * Eigen::Vector2d(-offset.y(), offset.x()) + swing.ahead_mps * ahead;
    const Eigen::Vector2d facing = spot.facing_ahead * ahead + spot.facing_left * left;
    centres.push_back({{position.x(), position.y(), spot.height_m + swing.up_m},
                       {velocity.x(), velocity.y(), swing.up_mps},
                       {facing.x(), facing.y(), 0.0},
                       spot.rcs_dbsm});
  }
}

void add_sides(const Body& body, double loss_db, std::vector<MirrorSurface>& surfaces) {
  if (body.kind != BodyKind::kTruck && body.kind != BodyKind::kVan) return;
  const Eigen::Vector2d ahead(std::cos(body.heading_rad), std::sin(body.heading_rad));
  const Eigen::Vector2d along = 0.5 * body.length_m * ahead;
  const Eigen::Vector2d across = 0.5 * body.width_m * Eigen::Vector2d(-ahead.y(), ahead.x());
  const std::array<Eigen::Vector2d, 4> corners = {body.position_m + along + across, body.position_m - along + across,
                                                  body.position_m - along - across, body.position_m + along - across};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    surfaces.push_back({corners[i], corners[(i + 1) % corners.size()], body.side_low_m, body.height_m, loss_db,
                        body.velocity_mps, body.id, true});
  }
}

}  // namespace boresight::simulator
