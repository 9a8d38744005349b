// Measured values of section 5. R: Schumann et al. 2021, N: Caesar et al. 2020; aggregate figures.
#include <array>
#include <tuple>

#include "tests/benchmarks/realism/rows/row.hpp"

namespace boresight::bench::realism {

void add_stationary_rows(std::vector<Row>& rows) {
  rows.push_back({5, "a scan, forward radars", "", 0, {177, 204}, {}, Judged::kOwn, [](const Statistics& s) {
                    return s.stationary.per_scan(Facing::kForward).mean();
                  }});
  rows.push_back({5, "a scan, radars to the side", "", 0, {85, 133}, {}, Judged::kOwn, [](const Statistics& s) {
                    return s.stationary.per_scan(Facing::kSideways).mean();
                  }});
  rows.push_back({5, "a scan, detections of any kind", "", 0, {}, {45, 114}, Judged::kOwn, [](const Statistics& s) {
                    return s.stationary.all_per_scan().mean();
                  }});
  rows.push_back({5, "a scan, forward radars: sd", "", 0, {36, 70}, {}, Judged::kNo, [](const Statistics& s) {
                    return s.stationary.per_scan(Facing::kForward).std_dev();
                  }});
  rows.push_back({5, "a scan, radars to the side: sd", "", 0, {36, 70}, {}, Judged::kNo, [](const Statistics& s) {
                    return s.stationary.per_scan(Facing::kSideways).std_dev();
                  }});
  constexpr std::array<double, StationaryWorld::kRanges> kShares{20, 26, 17, 12, 8, 6, 4, 3, 2, 1};
  for (std::size_t ring = 0; ring < kShares.size(); ++ring) {
    rows.push_back({5,
                    "share at " + std::to_string(10 * ring) + "–" + std::to_string(10 * ring + 10) + " m",
                    "%",
                    0,
                    kShares[ring],
                    {},
                    Judged::kNo,
                    [ring](const Statistics& s) { return s.stationary.percent_of_rings(ring, ring); }});
  }
  rows.push_back({5, "share within 20 m", "%", 0, 46, {}, Judged::kShared, [](const Statistics& s) {
                    return s.stationary.percent_of_rings(0, 1);
                  }});
  for (const auto& [share, value] : {std::tuple{0.05, -24.0}, std::tuple{0.50, -11.5}, std::tuple{0.95, 5.5}}) {
    const double p = share;
    rows.push_back({5,
                    "RCS: p" + std::to_string(static_cast<int>(kPercent * p + 0.5)),
                    "dBsm",
                    1,
                    value,
                    {},
                    Judged::kNo,
                    [p](const Statistics& s) { return s.stationary.rcs_dbsm().quantile(p); },
                    Scale::kLevel_db});
  }
  for (const auto& [share, value] : {std::tuple{0.1, 0.23}, std::tuple{0.5, 0.77}, std::tuple{0.9, 2.2}}) {
    const double p = share;
    rows.push_back({5,
                    "nearest neighbour: p" + std::to_string(static_cast<int>(kPercent * p + 0.5)),
                    "m",
                    2,
                    value,
                    {},
                    Judged::kNo,
                    [p](const Statistics& s) { return s.stationary.nearest_m().quantile(p); }});
  }
  rows.push_back({5, "at least 2 others within 1 m", "%", 0, 42, {}, Judged::kShared, [](const Statistics& s) {
                    return s.stationary.percent_with_two_near();
                  }});
  rows.push_back(
      {5, "another one within 0.5 m in the next scan", "", 2, 0.56, {}, Judged::kNo, [](const Statistics& s) {
         return s.stationary.seen_again();
       }});
  rows.push_back({5, "the same by chance", "", 2, 0.25, {}, Judged::kNo, [](const Statistics& s) {
                    return s.stationary.seen_again_by_chance();
                  }});
  rows.push_back({5, "the same beyond chance", "", 2, 0.41, {}, Judged::kShared, [](const Statistics& s) {
                    const double chance = s.stationary.seen_again_by_chance();
                    return (s.stationary.seen_again() - chance) / (1.0 - chance);
                  }});
  rows.push_back({5, "another one within 0.5 m 13 scans later", "", 2, 0.30, {}, Judged::kNo, [](const Statistics& s) {
                    return s.stationary.seen_later();
                  }});
  struct Level {
    const char* name;
    std::size_t level;
    double r;
  };
  for (const Level& l : {Level{"< −10 dBsm", 0, 0.083}, Level{"−10 … 0 dBsm", 1, 0.064}, Level{"0 … 10 dBsm", 2, 0.046},
                         Level{"> 10 dBsm", 3, 0.033}}) {
    const std::size_t level = l.level;
    rows.push_back({5,
                    std::string("range rate, robust sd, ") + l.name,
                    "m/s",
                    3,
                    l.r,
                    {},
                    Judged::kNo,
                    [level](const Statistics& s) { return s.stationary.rate_std_mps(level); }});
  }
  rows.push_back({5, "range rate: kurtosis", "", 0, 9, {}, Judged::kNo, [](const Statistics& s) {
                    return s.stationary.rate_kurtosis();
                  }});
  rows.push_back(
      {5, "range rate: p95 of the absolute deviation", "m/s", 2, 0.21, {}, Judged::kNo, [](const Statistics& s) {
         return s.stationary.rate_p95_mps();
       }});
  struct Band {
    const char* name;
    std::size_t band;
    Measured r;
    int digits;
  };
  for (const Band& b :
       {Band{"≤ 20°", 0, {0.0, 0.05}, 2}, Band{"20–50°", 1, {0.2, 0.3}, 1}, Band{"60–70°", 2, 0.6, 1}}) {
    const std::size_t band = b.band;
    rows.push_back({5,
                    std::string("azimuth, sd, ") + b.name + " off boresight",
                    "°",
                    b.digits,
                    b.r,
                    {},
                    Judged::kNo,
                    [band](const Statistics& s) { return s.azimuth_noise.azimuth_std_deg(band); }});
  }
  for (const auto& [name, range] : {std::tuple{"20–50 m", std::size_t{0}}, std::tuple{"50–100 m", std::size_t{1}}}) {
    const std::size_t r = range;
    rows.push_back({5,
                    std::string("car ") + name + ": robust sd across the line of sight",
                    "m",
                    2,
                    {0.43, 0.50},
                    {},
                    Judged::kNo,
                    [r](const Statistics& s) { return s.azimuth_noise.car_std_m(r); }});
  }
}

}  // namespace boresight::bench::realism
