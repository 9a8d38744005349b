#include "tests/benchmarks/alignment/common/published_result.hpp"

#include <cmath>

#include "services/common/geometry/angles.hpp"
#include "tests/benchmarks/alignment/common/drives.hpp"
#include "tests/benchmarks/common/report.hpp"

namespace boresight::bench {

namespace {

double bias_of(const Run& run, std::size_t radar, std::size_t parameter, double duration_s) {
  double sum = 0.0, count = 0.0;
  for (const Snapshot& s : run.snapshots) {
    if (s.time_s < 0.8 * duration_s) continue;
    sum += published_error(s.radars[radar], parameter);
    count += 1.0;
  }
  return std::abs(sum / count);
}

}  // namespace

double published_error(const RadarError& radar, std::size_t parameter) {
  return parameter == 0 ? radar.error(kSpeedScale)
                        : radar.sensor_error_rad(static_cast<Eigen::Index>(parameter) - 1) / kRadiansPerDegree;
}

PublishedResult published_result(const std::vector<Run>& runs, double duration_s) {
  PublishedResult result;
  for (std::size_t p = 0; p < 4; ++p) {
    std::vector<double> iterations;
    double bias = 0.0, count = 0.0;
    for (const Run& run : runs) {
      for (std::size_t r = 0; r < run.last().radars.size(); ++r) {
        const TimeTo95 time = p == 0 ? time_to_95(run, r, kSpeedScale, 1e-4)
                                     : time_to_95_sensor(run, r, static_cast<int>(p) - 1, 0.1 * kRadiansPerDegree);
        iterations.push_back(time.first_iterations);
        bias += bias_of(run, r, p, duration_s);
        count += 1.0;
      }
    }
    result.iterations[p] = median(iterations);
    result.bias[p] = bias / count;
  }
  for (const Run& run : runs) {
    result.corrected.add(run.corrected);
    result.uncorrected.add(run.uncorrected);
  }
  return result;
}

std::vector<std::string> published_row(const std::string& name, const PublishedResult& result) {
  std::vector<std::string> row = {name};
  for (const double iterations : result.iterations) row.push_back(fixed(iterations, 0));
  row.push_back(number(result.bias[0]));
  for (std::size_t p = 1; p < 4; ++p) row.push_back(fixed(result.bias[p], 4));
  row.push_back(fixed(result.corrected.rmse(), 4));
  row.push_back(fixed(result.corrected.skewness(), 3) + " / " + fixed(result.corrected.kurtosis(), 2));
  return row;
}

std::vector<std::string> published_header(const std::string& first) {
  return {first, "k_v", "α", "β", "γ", "bias k_v", "α °", "β °", "γ °", "RMSE m/s", "skewness / kurtosis"};
}

std::vector<simulator::AlignmentSpec> of_seeds(const simulator::AlignmentSpec& spec, std::size_t seeds,
                                               double duration_s) {
  std::vector<simulator::AlignmentSpec> specs;
  for (std::size_t seed = 0; seed < seeds; ++seed) {
    specs.push_back(spec);
    specs.back().seed = 40 + seed;
    specs.back().duration_s = duration_s;
  }
  return specs;
}

}  // namespace boresight::bench
