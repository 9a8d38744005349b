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
    const bool with_event = kind == "step_yaw" || kind == "step_pitch" || kind == "load";
    if (with_event || kind == "real_car_load") { c = preset; c.load_pitch_rad = kind.find("load") != std::string::npos ? 0.8 / 57.2958 : 0.0; c.load_time_s = 90; spec.body_pitch_std_rad = 0.0052; spec.body_pitch_per_acceleration_radps2pm = 0.0035; }
    const std::size_t turned = static_cast<std::size_t>(d) % 4;
    const double sign = d / 4 % 2 ? 1.0 : -1.0;
    if (kind == "step_yaw") spec.step_changes.push_back({91.0, turned, {0, 0, sign / 57.2958}});
    if (kind == "step_pitch") spec.step_changes.push_back({91.0, turned, {0, sign * 2.0 / 57.2958, 0}});
    if (kind == "drift") for (int i = 0; i < 180; ++i) spec.step_changes.push_back({1.0 + i, turned, {0, 0, sign * 0.4 / 180 / 57.2958 * (i ? 1 : 1)}});
    if (kind == "body") { spec.body_pitch_std_rad = 0.0052; spec.body_pitch_per_acceleration_radps2pm = 0.0035; }
    if (kind == "real_car") { c = preset; c.load_pitch_rad = 0; spec.body_pitch_std_rad = 0.0052; spec.body_pitch_per_acceleration_radps2pm = 0.0035; }
    if (kind == "scale") c.range_rate_scale = preset.range_rate_scale;
    if (kind == "curve") c.azimuth_curve_rms_rad = preset.azimuth_curve_rms_rad;
    if (kind == "position") c.position_error_m = preset.position_error_m;
    if (kind == "stamp") c.stamp_offset_s = preset.stamp_offset_s;
    if (kind == "slip") { c.side_slip_std_rad = preset.side_slip_std_rad; }
    if (kind == "gain") c.yaw_rate_gain = 0.01;
    if (kind == "mirror") c.road_mirror_share = preset.road_mirror_share;
    if (const char* list = std::getenv("SIMOFF")) {
      const std::string simoff = list;
      const auto without = [&](const char* name) { return simoff.find(name) != std::string::npos; };
      if (without("scale")) c.range_rate_scale = 0;
      if (without("curve")) c.azimuth_curve_rms_rad = 0;
      if (without("position")) c.position_error_m = 0;
      if (without("stamp")) c.stamp_offset_s = 0;
      if (without("wind")) c.side_slip_std_rad = 0;
      if (without("bend")) c.slip_coefficient_radps2pm = 0;
      if (without("gain")) c.yaw_rate_gain = 0;
      if (without("bias")) c.yaw_rate_bias_radps = 0;
      if (without("step")) c.speed_step_mps = 0;
      if (without("mirror")) c.road_mirror_share = 0;
      if (without("dive")) spec.body_pitch_per_acceleration_radps2pm = 0;
      if (without("shake")) spec.body_pitch_std_rad = 0;
      if (without("body")) spec.body_pitch_std_rad = spec.body_pitch_per_acceleration_radps2pm = 0;
    }
    alignment::Config config;
    for (const auto& [name, m] : alignment::kMethodNames) if (name == which) config.method = m;
    bench::RunOptions options;
    options.snapshot_period_s = 60.0;
    static unsigned drifting = 0; drifting = 0;
    static int loads = 0;
    static double load_deg = 0, load_at = 0;
    if (!std::getenv("VERBOSE")) options.look = [&](const alignment::Method& m, double t) {
      for (std::size_t r = 0; r < 4; ++r) if (m.estimate(r).drift.since_ns) drifting |= 1u << r;
      if (const auto* w = dynamic_cast<const alignment::WindowedFilter*>(&m)) {
        if (w->load_changes() != loads) load_at = t;
        loads = w->load_changes();
        load_deg = w->load_rad() * 57.2958;
      }
    };
    options.snapshot_period_s = 1.0;
    if (std::getenv("VERBOSE")) options.look = [&](const alignment::Method& m, double t) {
      const auto* w = dynamic_cast<const alignment::WindowedFilter*>(&m);
      static double next = 0.0;
      if (!w || t < next) return;
      next = t + std::atof(std::getenv("VERBOSE"));
      const auto& s = w->solver();
      std::printf("load %.3f t %.1f k %.6f b %.4f g %.4f c %.5f dive %.5f tau %.4f common yaw %.4f (%.1f s) pitch %.4f (%.1f s) scale %.6f (%.1f s)\n", w->load_rad() * 57.3, t, s.shared().speed_scale,
                  s.shared().yaw_rate_bias_radps * 57.3, s.shared().yaw_rate_gain, s.shared().slip_radps2pm, s.shared().pitch_per_acceleration_radps2pm,
                  s.shared().stamp_s, 57.3 * std::sqrt(s.common().variance[0]), s.correlation_s(0), 57.3 * std::sqrt(s.common().variance[1]), s.correlation_s(1), std::sqrt(s.common().variance[2]), s.correlation_s(2));
      for (std::size_t r = 0; r < s.size(); ++r) {
        const auto& q = s.radar(r);
        std::printf("   radar %zu scale %+.5f tau %.4f pos %.3f %.3f above %.3f mirror %.2f curve %.3f own yaw %.4f pitch %.4f scale %.6f sd yaw %.4f\n", r, q.state.rate_scale, q.state.stamp_s,
                    q.state.position_error_m.x(), q.state.position_error_m.y(), q.state.height_excess, q.state.mirror_share, 57.3 * std::sqrt(q.state.curve_rad.squaredNorm() / 11), 57.3 * std::sqrt(q.fluctuation.variance[0]),
                    57.3 * std::sqrt(q.fluctuation.variance[1]), std::sqrt(q.fluctuation.variance[2]), 57.3 * std::sqrt(q.covariance(3, 3)));
      }
    };
    alignment::windows::Priors priors;
    const std::string off = std::getenv("OFF") ? std::getenv("OFF") : "";
    const auto is_off = [&](const char* name) { return off.find(name) != std::string::npos; };
    if (is_off("scale")) priors.rate_scale_std = 0, priors.own_std[2] = 0;
    if (is_off("gain")) priors.yaw_rate_gain_std = 0;
    if (is_off("bias")) priors.yaw_rate_bias_std_radps = 0;
    if (is_off("slip")) priors.slip_std_radps2pm = 0;
    if (is_off("dive")) priors.pitch_per_acceleration_std_radps2pm = 0;
    if (is_off("stamp")) priors.stamp_std_s = priors.common_stamp_std_s = 0;
    if (is_off("position")) priors.position_std_m = 0;
    if (is_off("curve")) priors.curve_std_rad = 0;
    if (is_off("mirror")) priors.mirror_share_std = 0;
    if (is_off("tol")) priors.mirror_share_tolerance = 0;
    if (is_off("above")) priors.height_excess_std = 0;
    if (std::getenv("KAPPA")) priors.height_excess_std = std::atof(std::getenv("KAPPA"));
    if (is_off("cscale")) priors.common_std[2] = 0;
    if (is_off("oscale")) priors.own_std[2] = 0;
    if (is_off("cyaw")) priors.common_std[0] = 0;
    if (is_off("cpitch")) priors.common_std[1] = 0;
    const bench::MakeMethod make = [&](const VehicleConfig& v) -> std::unique_ptr<alignment::Method> {
      if (config.method == alignment::MethodName::kWindows) return std::make_unique<alignment::WindowedFilter>(v, config.filter, alignment::windows::WindowsConfig{priors, {}, {}});
      return alignment::make_method(v, config);
    };
    const auto run = bench::run_drive(spec, make, options);
    changes += static_cast<int>(run.step_changes.size());
    for (const auto& s : run.step_changes) std::printf("  change of radar %zu at %.1f s%s\n", s.radar, s.time_s, with_event && s.radar == turned ? " (turned)" : "");
    if (loads) std::printf("  load changes %d: %.3f deg, first seen %.1f s\n", loads, load_deg, load_at);
    if (drifting) std::printf("  drift of radars %u (%u)\n", drifting, with_event || kind == "drift" ? 1u << turned : 0u);
    loads = 0;
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
