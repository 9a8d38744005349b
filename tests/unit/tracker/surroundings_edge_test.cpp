// Road edges: the line and its covariance, the search, and edges over a drive.
#include <gtest/gtest.h>

#include "tests/unit/tracker/surroundings_scene.hpp"

namespace boresight::tracking {
namespace {

StationaryPoint point(double x_m, double y_m, double std_m = 0.1) {
  StationaryPoint p;
  p.position_m = {x_m, y_m};
  p.covariance_m2 = std_m * std_m * Eigen::Matrix2d::Identity();
  return p;
}

TEST(EdgeLine, KeepsItsPlaceInTheWorldWhileTheVehicleTurns) {
  RoadEdgeParameters still;
  still.offset_density_m2pm = still.slope_density_pm = still.curvature_density_pm3 = 0.0;
  for (const double yaw_rate : {-0.3, 0.0, 0.3}) {
    EdgeLine line;
    line.c = {4.0, 0.05, 0.004};
    std::vector<Eigen::Vector2d> places;
    for (double x = 2.0; x <= 20.0; x += 3.0) places.emplace_back(x, line.at(x));
    const geometry::EgoStep step = geometry::ego_step(15.0, yaw_rate, 0.025);
    for (int i = 0; i < 20; ++i) {
      line.predict(step, yaw_rate * 0.025, still);
      for (Eigen::Vector2d& p : places) p = step.move_point(p);
    }
    // A parabola turned by 9° is a parabola to a few centimetres.
    for (const Eigen::Vector2d& p : places) EXPECT_NEAR(line.at(p.x()), p.y(), 0.08) << yaw_rate << " " << p.x();
  }
}

TEST(EdgeLine, UpdateIsTheWeightedLeastSquaresFit) {
  RoadEdgeParameters parameters;
  parameters.curvature_rate_std_pm2 = 0.0;
  EdgeLine line;
  line.c = {5.0, 0.0, 0.0};
  line.covariance = Eigen::Vector3d(0.3, 0.02, 0.002).cwiseAbs2().asDiagonal();
  std::vector<StationaryPoint> points;
  for (int i = 0; i < 12; ++i) points.push_back(point(2.5 * i, 5.0 + 0.1 * std::sin(1.0 + i)));
  const double scatter_m2 = 0.01;
  // No clutter: each detection is on the line. Normal equations of prior and points as rows, solved by a QR.
  Eigen::MatrixXd rows(15, 3);
  Eigen::VectorXd values(15);
  const Eigen::Vector3d prior_std(0.3, 0.02, 0.002);
  for (Eigen::Index k = 0; k < 3; ++k) {
    rows.row(k) = Eigen::RowVector3d::Unit(k) / prior_std(k);
    values(k) = line.c(k) / prior_std(k);
  }
  for (Eigen::Index i = 0; i < 12; ++i) {
    const double x = points[static_cast<std::size_t>(i)].position_m.x();
    const double std_m = std::sqrt((0.01 + scatter_m2) * parameters.repeat_factor);
    rows.row(3 + i) = Eigen::RowVector3d(1.0, x, 0.5 * x * x) / std_m;
    values(3 + i) = points[static_cast<std::size_t>(i)].position_m.y() / std_m;
  }
  const Eigen::Vector3d expected = rows.colPivHouseholderQr().solve(values);
  const Eigen::Matrix3d covariance = (rows.transpose() * rows).inverse();
  const EdgeEvidence found = line.update(points, 1.0, {10.0, 0.0, 0.0}, scatter_m2, parameters);
  EXPECT_NEAR(found.detections, 12.0, 1e-9);
  for (Eigen::Index k = 0; k < 3; ++k) {
    EXPECT_NEAR(line.c(k), expected(k), 1e-9);
    EXPECT_NEAR(line.covariance(k, k), covariance(k, k), 1e-9 * covariance(k, k) + 1e-15);
  }
}

TEST(EdgeLine, DetectionsBesideItDoNotMoveIt) {
  const RoadEdgeParameters parameters;
  EdgeLine line;
  line.c = {5.0, 0.0, 0.0};
  line.covariance = Eigen::Vector3d(0.1, 0.01, 0.001).cwiseAbs2().asDiagonal();
  std::vector<StationaryPoint> points;
  for (int i = 0; i < 12; ++i) points.push_back(point(2.5 * i, 3.5));
  const EdgeEvidence found = line.update(points, 1.0, {10.0, 5.0, 5.0}, 0.01, parameters);
  EXPECT_FALSE(found.is_seen);
  EXPECT_NEAR(line.c(0), 5.0, 0.01);
  EXPECT_EQ(line.update({}, 1.0, {}, 0.01, parameters).detections, 0.0) << "a scan without detections";
}

TEST(RoadEdges, FindTheRailsAmongClutterOnBothSides) {
  StandingWorld world(1);
  world.add_rail(7.5, -50.0, 400.0);
  world.add_rail(-6.0, -50.0, 400.0);
  world.add_clutter(0.1, -50.0, 400.0, 1.8, 12.0);
  Watched watched;
  watched.drive(world, 80);
  for (const auto& [side, lateral] : {std::pair(RoadSide::kLeft, 7.5), std::pair(RoadSide::kRight, -6.0)}) {
    const RoadEdge* const edge = watched.edge(side);
    ASSERT_NE(edge, nullptr);
    EXPECT_GT(edge->existence_probability, 0.9F);
    EXPECT_GT(edge->end_x_m, 20.0F);
    for (const double x : {5.0, 15.0, 25.0}) EXPECT_NEAR(edge_at(*edge, x), lateral, 0.3) << x;
  }
}

TEST(RoadEdges, AreNotFoundInClutterAlone) {
  for (std::uint64_t seed = 1; seed <= 5; ++seed) {
    StandingWorld world(seed);
    world.add_clutter(0.15, -50.0, 400.0, 1.8, 16.0);
    Watched watched;
    int lists = 0;
    for (int i = 0; i < 300; ++i) lists += watched.take(world.scan(0.025)).number_of_road_edges > 0 ? 1 : 0;
    EXPECT_LT(lists, 30) << seed;
  }
}

TEST(RoadEdges, OfAMirroredWorldAreMirrored) {
  const auto driven = [](double mirror) {
    StandingWorld world(3);
    world.mirror = mirror;
    world.yaw_rate_radps = 0.02;
    world.add_rail(6.0, -50.0, 200.0);
    world.add_clutter(0.05, -50.0, 200.0, 2.0, 12.0);
    auto watched = std::make_unique<Watched>();
    watched->drive(world, 80);
    return watched;
  };
  const auto left = driven(1.0), right = driven(-1.0);
  const RoadEdge *const a = left->edge(RoadSide::kLeft), *const b = right->edge(RoadSide::kRight);
  ASSERT_NE(a, nullptr);
  ASSERT_NE(b, nullptr);
  // The search takes turns among the sides, one scan apart.
  for (const double x : {0.0, 10.0, 20.0}) EXPECT_NEAR(edge_at(*a, x), -edge_at(*b, x), 0.1);
}

TEST(RoadEdges, FollowTheBendThatTheVehicleDrives) {
  StandingWorld world(4);
  world.yaw_rate_radps = 0.15;
  // Rail outside of the circle about (0, 100) that the vehicle drives on.
  constexpr double kRadius_m = 100.0, kRail_m = 105.0;
  for (double angle = -0.6; angle < 3.0; angle += 0.02) {
    world.points.push_back({{kRail_m * std::sin(angle), kRadius_m - kRail_m * std::cos(angle)}});
  }
  world.add_clutter(0.05, -50.0, 100.0, 2.0, 12.0);
  Watched watched;
  watched.drive(world, 80);
  const RoadEdge* const edge = watched.edge(RoadSide::kRight);
  ASSERT_NE(edge, nullptr);
  EXPECT_NEAR(edge->coefficients[2], 1.0 / kRail_m, 0.003);
  EXPECT_NEAR(edge->coefficients[0], kRadius_m - kRail_m, 0.3);
}

TEST(RoadEdges, AreTheSameThroughATurnedRadar) {
  StandingWorld world(5);
  world.add_rail(13.0, -50.0, 400.0);  // far enough that its view holds a long part
  Watched watched;
  watched.drive(world, 80, 0.025, 2);  // looks to the left
  const RoadEdge* const edge = watched.edge(RoadSide::kLeft);
  ASSERT_NE(edge, nullptr);
  EXPECT_NEAR(edge_at(*edge, 5.0), 13.0, 0.2);
}

TEST(RoadEdges, AreLostBehindTheEndOfTheRail) {
  StandingWorld world(6);
  world.add_rail(6.0, -50.0, 40.0);
  Watched watched;
  watched.drive(world, 40);
  ASSERT_NE(watched.edge(RoadSide::kLeft), nullptr);
  EXPECT_LT(watched.edge(RoadSide::kLeft)->end_x_m, 33.0F);
  watched.drive(world, 240);
  EXPECT_EQ(watched.edge(RoadSide::kLeft), nullptr);
}

TEST(RoadEdges, SurviveAStandingVehicle) {
  StandingWorld world(7);
  world.add_rail(6.0, -50.0, 60.0);
  Watched watched;
  watched.drive(world, 60);
  const std::uint32_t id = watched.edge(RoadSide::kLeft)->edge_id;
  world.speed_mps = 0.0;
  watched.drive(world, 200);
  ASSERT_NE(watched.edge(RoadSide::kLeft), nullptr);
  EXPECT_EQ(watched.edge(RoadSide::kLeft)->edge_id, id);
  EXPECT_NEAR(edge_at(*watched.edge(RoadSide::kLeft), 10.0), 6.0, 0.2);
}

TEST(RoadEdges, StateTheirErrorsHonestly) {
  double squares = 0.0, count = 0.0;
  for (std::uint64_t seed = 100; seed < 130; ++seed) {
    StandingWorld world(seed);
    world.add_rail(6.0, -50.0, 200.0);
    world.add_clutter(0.05, -50.0, 200.0, 2.0, 12.0);
    Watched watched;
    watched.drive(world, 60);
    const RoadEdge* const edge = watched.edge(RoadSide::kLeft);
    ASSERT_NE(edge, nullptr) << seed;
    for (const double x : {5.0, 15.0, 25.0}) {
      const Eigen::Vector3d h = EdgeLine::basis(x);
      const Eigen::Matrix3d covariance =
          Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(edge->covariance.data()).cast<double>();
      const double error = edge_at(*edge, x) - 6.0;
      squares += error * error / h.dot(covariance * h);
      count += 1.0;
    }
  }
  // The model allows for roads that bend, scatter and misaligned radars, which this one lacks: it may be cautious.
  EXPECT_LT(squares / count, 1.5);
  EXPECT_GT(squares / count, 0.05);
}

}  // namespace
}  // namespace boresight::tracking
