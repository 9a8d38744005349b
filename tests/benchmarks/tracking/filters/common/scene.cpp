#include "tests/benchmarks/tracking/filters/common/scene.hpp"

#include <cmath>
#include <random>

namespace boresight::bench::filters {

namespace {

track::ObjectState state_of(double x, double v_x, double a_x, double y, double v_y, double a_y) {
  track::ObjectState state;
  state << x, v_x, a_x, y, v_y, a_y;
  return state;
}

}  // namespace

const std::array<Scene, 2>& scenes() {
  static const std::array<Scene, 2> kScenes = {Scene{"approach",
                                                     state_of(80.0, -12.0, 0.8, -3.0, 0.3, 0.0),
                                                     {{0.1149, 0.4503, 0.0258}, 3.19},
                                                     {{0.1138, 0.4425, 0.0252}, 0.68}},
                                               Scene{"crossing",
                                                     state_of(25.0, -1.0, 0.1, -20.0, 4.0, 0.0),
                                                     {{0.1136, 0.3579, 0.0258}, 0.68},
                                                     {{0.1135, 0.3554, 0.0257}, 0.62}}};
  return kScenes;
}

Eigen::Vector3d seen(const track::ObjectState& state) {
  const Eigen::Vector2d place(state(0), state(3)), velocity(state(1), state(4));
  return {place.norm(), std::atan2(place.y(), place.x()), place.dot(velocity) / place.norm()};
}

Run draw_run(const Scene& scene, std::uint64_t seed) {
  const track::FilterSetup setup;
  const Eigen::Vector3d std(setup.range_std_m, setup.azimuth_std_rad, setup.range_rate_std_mps);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Run run;
  for (std::size_t k = 0; k < kSteps; ++k) {
    const double t = setup.step_s * static_cast<double>(k);
    track::ObjectState state = scene.start;
    for (const Eigen::Index axis : {0, 3}) {
      state(axis) += t * scene.start(axis + 1) + 0.5 * t * t * scene.start(axis + 2);
      state(axis + 1) += t * scene.start(axis + 2);
    }
    Eigen::Vector3d measured = seen(state);
    for (Eigen::Index i = 0; i < 3; ++i) measured(i) += std(i) * normal(random);
    run.truth.push_back(state);
    run.measured.push_back(measured);
  }
  return run;
}

}  // namespace boresight::bench::filters
