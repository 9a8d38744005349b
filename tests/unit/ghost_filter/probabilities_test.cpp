// The mirror method publishes the shares of all origins, and its label follows from them.
#include <array>

#include "tests/unit/ghost_filter/mirror_scene.hpp"

namespace boresight::ghosts {
namespace {

const Plane kGuardRail{{0.0, -7.0}, {1.0, 0.0}};

TEST_F(MirrorFilterTest, ProbabilitiesOfOriginsSumToOneAndAgreeWithTheRuleOfTheLabel) {
  std::array<std::size_t, kNumberOfProvenances> labels{};
  std::size_t between = 0;
  for (int k = 0; k < 60; ++k) {
    drive(0.05, [&] {
      const Vector2d p(11.0, 2.0), v(24.0, 0.0);
      track(p, v);
      hand_over_tracks();
      rail(kGuardRail.point.y());
      direct(p + Vector2d(-2.25, 0.5), v);
      by_two_bounces(p + Vector2d(-2.25, 0.5), v, kGuardRail, true, -16.0);
      by_two_bounces(p + Vector2d(-2.25, -0.5), v, kGuardRail, false, -12.0);
      by_three_bounces(p + Vector2d(-2.25, 0.5), v, kGuardRail);
      if (k == 40) direct({40.0, 15.0}, {-20.0, 9.0}, -18.0);  // weak, and all alone
    });
    for (std::uint32_t i = 0; i < out_->number_of_valid_detections; ++i) {
      double sum = 0.0;
      for (const Provenance origin : kOrigins) {
        ASSERT_GE(out_->probability(origin, i), 0.0F);
        sum += static_cast<double>(out_->probability(origin, i));
        between += out_->probability(origin, i) > 0.01F && out_->probability(origin, i) < 0.99F ? 1 : 0;
      }
      ASSERT_NEAR(sum, 1.0, 1e-6);
      EXPECT_EQ(out_->probability(Provenance::kAmbiguity, i), 0.0F);
      ++labels[static_cast<std::size_t>(label(i))];
      const auto p = [&](Provenance origin) { return out_->probability(origin, i); };
      const float ghosts = p(Provenance::kGhostType1) + p(Provenance::kGhostType2);
      const Provenance direct =
          p(Provenance::kMoving) >= p(Provenance::kStationary) ? Provenance::kMoving : Provenance::kStationary;
      const Provenance ghost =
          p(Provenance::kGhostType1) > p(Provenance::kGhostType2) ? Provenance::kGhostType1 : Provenance::kGhostType2;
      EXPECT_EQ(label(i), out_->ghost_probability(i) < 0.5F  ? direct
                          : p(Provenance::kClutter) > ghosts ? Provenance::kClutter
                                                             : ghost);
    }
  }
  EXPECT_EQ(labels[0], 0u);
  for (const Provenance origin : kOrigins) {
    EXPECT_EQ(labels[static_cast<std::size_t>(origin)] > 0, origin != Provenance::kAmbiguity)
        << static_cast<int>(origin);
  }
  EXPECT_GT(between, 10u) << "shares of the densities, not labels as 0 and 1";
}

}  // namespace
}  // namespace boresight::ghosts
