// Development driver: errors of methods on drives with a real car's effects.
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

#include "services/alignment_estimator/core/make_method.hpp"
#include "services/alignment_estimator/core/windows/windowed_filter.hpp"
#include "services/common/geometry/angles.hpp"
#include "services/simulator/car/real_car.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/alignment/common/runner.hpp"

using namespace boresight;

int main(int argc, char** argv) {
  const std::string kind = argc > 1 ? argv[1] : "none";
  const int drives = argc > 2 ? std::atoi(argv[2]) : 3;
  const std::uint64_t seed = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 9000;
  const std::string which = argc > 4 ? argv[4] : "windows";
  const double duration = argc > 5 ? std::atof(argv[5]) : 180.0;
  const auto preset = simulator::car::real_car_preset();
  double sum[4] = {}, nees[4] = {};
  int cover[4] = {}, n = 0, changes = 0;
  for (int d = 0; d < drives; ++d) {
    auto spec = bench::clean_drive(kind == "city" ? simulator::RoadKind::kCity : simulator::RoadKind::kMixed, duration,
                                   seed + static_cast<std::uint64_t>(d));
    auto& c = spec.real_car;
    if (kind == "disturbed") spec = bench::disturbed_drive(simulator::RoadKind::kMixed, duration, seed + static_cast<std::uint64_t>(d));
    if (kind == "real_car_flat") { c = preset; c.load_pitch_rad = 0; c.road_mirror_share = 0; spec.body_pitch_std_rad = 0.0052; spec.body_pitch_per_acceleration_radps2pm = 0.0035; }
    if (kind == "body") { spec.body_pitch_std_rad = 0.0052; spec.body_pitch_per_acceleration_radps2pm = 0.0035; }
    if (kind == "real_car") { c = preset; c.load_pitch_rad = 0; spec.body_pitch_std_rad = 0.0052; spec.body_pitch_per_acceleration_radps2pm = 0.0035; }
    if (kind == "scale") c.range_rate_scale = preset.range_rate_scale;
    if (kind == "curve") c.azimuth_curve_rms_rad = preset.azimuth_curve_rms_rad;
    if (kind == "position") c.position_error_m = preset.position_error_m;
    if (kind == "stamp") c.stamp_offset_s = preset.stamp_offset_s;
    if (kind == "slip") { c.side_slip_std_rad = preset.side_slip_std_rad; }
    if (kind == "gain") c.yaw_rate_gain = 0.01;
    if (kind == "mirror") c.road_mirror_share = preset.road_mirror_share;
    alignment::Config config;
    for (const auto& [name, m] : alignment::kMethodNames) if (name == which) config.method = m;
    bench::RunOptions options;
    options.snapshot_period_s = 60.0;
    if (std::getenv("VERBOSE")) options.look = [&](const alignment::Method& m, double t) {
      const auto* w = dynamic_cast<const alignment::WindowedFilter*>(&m);
      static double next = 0.0;
      if (!w || t < next) return;
      next = t + std::atof(std::getenv("VERBOSE"));
      const auto& s = w->solver();
      std::printf("t %.1f k %.6f b %.4f g %.4f c %.5f dive %.5f tau %.4f common yaw %.4f pitch %.4f scale %.6f\n", t, s.shared().speed_scale,
                  s.shared().yaw_rate_bias_radps * 57.3, s.shared().yaw_rate_gain, s.shared().slip_radps2pm, s.shared().pitch_per_acceleration_radps2pm,
                  s.shared().stamp_s, 57.3 * std::sqrt(s.common().variance[0]), 57.3 * std::sqrt(s.common().variance[1]), std::sqrt(s.common().variance[2]));
      for (std::size_t r = 0; r < s.size(); ++r) {
        const auto& q = s.radar(r);
        std::printf("   radar %zu scale %+.5f tau %.4f pos %.3f %.3f mirror %.2f curve %.3f own yaw %.4f pitch %.4f scale %.6f sd yaw %.4f\n", r, q.state.rate_scale, q.state.stamp_s,
                    q.state.position_error_m.x(), q.state.position_error_m.y(), q.state.mirror_share, 57.3 * std::sqrt(q.state.curve_rad.squaredNorm() / 11), 57.3 * std::sqrt(q.fluctuation.variance[0]),
                    57.3 * std::sqrt(q.fluctuation.variance[1]), std::sqrt(q.fluctuation.variance[2]), 57.3 * std::sqrt(q.covariance(3, 3)));
      }
    };
    const auto run = bench::run_drive(spec, [&](const VehicleConfig& v) { return alignment::make_method(v, config); }, options);
    changes += static_cast<int>(run.step_changes.size());
    std::printf("drive %d:", d);
    for (const auto& r : run.last().radars) {
      std::printf("  yaw %+.4f±%.4f pitch %+.3f±%.3f roll %+.2f±%.2f |", r.error(3) * 57.3, r.std(3) * 57.3, r.error(2) * 57.3, r.std(2) * 57.3, r.error(1) * 57.3, r.std(1) * 57.3);
      for (int k = 0; k < 4; ++k) {
        sum[k] += r.error(k) * r.error(k);
        const double z2 = r.error(k) * r.error(k) / (r.std(k) * r.std(k));
        nees[k] += z2;
        cover[k] += z2 < 3.84;
      }
      ++n;
    }
    std::printf(" k_v %+.6f±%.6f\n", run.last().radars[0].error(0), run.last().radars[0].std(0));
  }
  for (int k = 0; k < 4; ++k)
    std::printf("%-6s rms %.6g  NEES %.2f  cover %.0f %%\n", bench::kParameters[k], std::sqrt(sum[k] / n) * (k ? 57.2958 : 1), nees[k] / n, 100.0 * cover[k] / n);
  std::printf("%s %s: changes %d\n", kind.c_str(), which.c_str(), changes);
}
