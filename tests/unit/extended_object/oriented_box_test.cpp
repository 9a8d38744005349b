#include "services/common/extended_object/oriented_box.hpp"

#include <cmath>
#include <random>

#include <gtest/gtest.h>

namespace boresight::extended_object {
namespace {

using Eigen::Vector2d;

struct Case {
  OrientedBox box;
  Vector2d point;
};

/// Boxes anywhere, points inside, near and far.
class OrientedBoxGeometry : public testing::Test {
 protected:
  Case next() {
    std::uniform_real_distribution<double> place(-20.0, 20.0), angle(-7.0, 7.0), size(0.2, 12.0), near(-10.0, 10.0);
    const OrientedBox box{{place(random_), place(random_)}, angle(random_), size(random_), size(random_)};
    return {box, box.centre_m + Vector2d(near(random_), near(random_))};
  }

  std::mt19937 random_{7};
};

double cross(const Vector2d& a, const Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// By the sides of the polygon of corners.
bool is_within_polygon(const OrientedBox& box, const Vector2d& point) {
  const auto corners = box.corners();
  for (std::size_t i = 0; i < 4; ++i) {
    if (cross(corners[(i + 1) % 4] - corners[i], point - corners[i]) < 0.0) return false;
  }
  return true;
}

/// Least distance to points along the edges, 4 mm apart at most.
double distance_to_outline(const OrientedBox& box, const Vector2d& point) {
  const auto corners = box.corners();
  double least = 1e9;
  for (std::size_t i = 0; i < 4; ++i) {
    for (int k = 0; k <= 3000; ++k) {
      const Vector2d on_edge = corners[i] + k / 3000.0 * (corners[(i + 1) % 4] - corners[i]);
      least = std::min(least, (on_edge - point).norm());
    }
  }
  return least;
}

TEST_F(OrientedBoxGeometry, CornersRunCounterClockwiseAroundTheArea) {
  for (int i = 0; i < 100; ++i) {
    const OrientedBox box = next().box;
    const auto corners = box.corners();
    double area = 0.0;
    for (std::size_t k = 0; k < 4; ++k) area += 0.5 * cross(corners[k], corners[(k + 1) % 4]);
    EXPECT_NEAR(area, box.length_m * box.width_m, 1e-9);
  }
}

TEST_F(OrientedBoxGeometry, ContainsAgreesWithThePolygonOfCorners) {
  for (int i = 0; i < 2000; ++i) {
    const auto [box, point] = next();
    EXPECT_EQ(box.contains(point), is_within_polygon(box, point));
  }
}

TEST_F(OrientedBoxGeometry, MarginGrowsTheBoxOnEverySide) {
  for (int i = 0; i < 500; ++i) {
    const auto [box, point] = next();
    OrientedBox grown = box;
    grown.length_m += 1.0;
    grown.width_m += 1.0;
    EXPECT_EQ(box.contains(point, 0.5), grown.contains(point));
    EXPECT_EQ(grown.contains(point, -0.5), box.contains(point));
  }
}

TEST_F(OrientedBoxGeometry, DistanceAndDepthAgreeWithTheSampledOutline) {
  for (int i = 0; i < 100; ++i) {
    const auto [box, point] = next();
    const double to_outline = distance_to_outline(box, point);
    const bool inside = is_within_polygon(box, point);
    EXPECT_NEAR(box.distance_m(point), inside ? 0.0 : to_outline, 5e-3);
    EXPECT_NEAR(box.depth_m(point), inside ? to_outline : -to_outline, 5e-3);
  }
}

TEST_F(OrientedBoxGeometry, NearestPointLiesInTheBoxAtTheDistance) {
  for (int i = 0; i < 500; ++i) {
    const auto [box, point] = next();
    const Vector2d nearest = box.nearest_point(point);
    EXPECT_TRUE(box.contains(nearest, 1e-9));
    EXPECT_NEAR((nearest - point).norm(), box.distance_m(point), 1e-9);
  }
}

TEST_F(OrientedBoxGeometry, BoxCoordinatesRoundTrip) {
  for (int i = 0; i < 100; ++i) {
    const auto [box, point] = next();
    EXPECT_LT((box.from_box(box.to_box(point)) - point).norm(), 1e-12);
  }
  const OrientedBox left{{10.0, 0.0}, 0.5 * M_PI, 4.0, 2.0};
  EXPECT_LT((left.from_box({2.0, 1.0}) - Vector2d(9.0, 2.0)).norm(), 1e-12);
}

TEST_F(OrientedBoxGeometry, HalfExtentIsTheFarthestCorner) {
  std::uniform_real_distribution<double> angle(-M_PI, M_PI);
  for (int i = 0; i < 500; ++i) {
    const OrientedBox box = next().box;
    const double at = angle(random_);
    const Vector2d direction(std::cos(at), std::sin(at));
    double most = -1e9;
    for (const Vector2d& corner : box.corners()) most = std::max(most, direction.dot(corner - box.centre_m));
    EXPECT_NEAR(box.half_extent_along_m(direction), most, 1e-9);
  }
}

TEST_F(OrientedBoxGeometry, VisibleFacesAreThoseWithAClearLineOfSight) {
  for (int i = 0; i < 500; ++i) {
    const auto [box, sensor] = next();
    const VisibleFaces faces = box.visible_faces(sensor);
    const auto is_clear = [&, &b = box, &s = sensor](const Vector2d& middle_of_face) {
      for (int k = 1; k < 200; ++k) {
        if (b.contains(s + k / 200.0 * (b.from_box(middle_of_face) - s), -1e-9)) return false;
      }
      return true;
    };
    const Vector2d half = box.half_size_m();
    EXPECT_EQ(faces.front, is_clear({half.x(), 0.0}));
    EXPECT_EQ(faces.rear, is_clear({-half.x(), 0.0}));
    EXPECT_EQ(faces.left, is_clear({0.0, half.y()}));
    EXPECT_EQ(faces.right, is_clear({0.0, -half.y()}));
  }
}

TEST_F(OrientedBoxGeometry, OfSizeZeroIsAPoint) {
  const OrientedBox box{{1.0, 2.0}, 0.3, 0.0, 0.0};
  EXPECT_DOUBLE_EQ(box.distance_m({4.0, 6.0}), 5.0);
  EXPECT_DOUBLE_EQ(box.half_extent_along_m({1.0, 0.0}), 0.0);
  EXPECT_LT((box.nearest_point({4.0, 6.0}) - box.centre_m).norm(), 1e-12);
}

}  // namespace
}  // namespace boresight::extended_object
