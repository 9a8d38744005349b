// Measured values of section 4. R: Schumann et al. 2021, N: Caesar et al. 2020; aggregate figures.
#include <array>
#include <tuple>

#include "tests/benchmarks/realism/rows/row.hpp"

namespace boresight::bench::realism {

namespace {

struct Levels {
  const char* range;
  double from_m, to_m;
  std::array<double, 3> vehicle, false_mover, stationary;  // dBsm at 10, 50, 90 %
  double vehicle_is_stronger;
};

constexpr std::array<Levels, kStrengthBins> kLevels_r{{
    {"0–10 m", 0, 10, {-21, -11, 0}, {-25, -18, -5}, {-26, -19, -10}, 0.70},
    {"10–20 m", 10, 20, {-20, -8, 5}, {-23, -14, 1}, {-22, -15, -4}, 0.63},
    {"20–30 m", 20, 30, {-12, 2, 20}, {-20, -10, 5}, {-19, -12, -3}, 0.76},
    {"30–45 m", 30, 45, {-12, 0, 15}, {-16, -7, 7}, {-16, -9, 1}, 0.69},
    {"45–65 m", 45, 65, {-8, 4, 16}, {-11, -3, 11}, {-12, -6, 5}, 0.69},
    {"65–100 m", 65, 100, {-1, 8, 18}, {-5, 4, 18}, {-7, -1, 10}, 0.61},
}};
constexpr std::array<double, 3> kLevelShares{0.1, 0.5, 0.9};

Row level_row(const std::string& name, Measured r, Measured n, Judged judged,
              std::function<double(const Statistics&)> figure) {
  return {4, name, "dBsm", 0, r, n, judged, std::move(figure), Scale::kLevel_db};
}

void add_levels(std::vector<Row>& rows) {
  for (const Levels& levels : kLevels_r) {
    for (const auto& [name, sort, values] : {std::tuple{"vehicles", Sort::kVehicle, levels.vehicle},
                                             std::tuple{"false movers", Sort::kFalseMover, levels.false_mover},
                                             std::tuple{"stationary", Sort::kStationary, levels.stationary}}) {
      for (std::size_t i = 0; i < kLevelShares.size(); ++i) {
        const double share = kLevelShares[i], from_m = levels.from_m, to_m = levels.to_m;
        const Sort of = sort;
        const std::string p = ": p" + std::to_string(static_cast<int>(kPercent * share + 0.5));
        rows.push_back(level_row(std::string(name) + " " + levels.range + p, values[i], {}, Judged::kOwn,
                                 [of, from_m, to_m, share](const Statistics& s) {
                                   return s.strength.quantile_dbsm(of, from_m, to_m, share);
                                 }));
      }
    }
  }
  for (const auto& [share, value] : {std::tuple{0.05, -4.0}, std::tuple{0.50, 5.0}, std::tuple{0.95, 18.0}}) {
    const double p = share;
    rows.push_back(level_row(
        "vehicles, all ranges: p" + std::to_string(static_cast<int>(kPercent * p + 0.5)), {}, value, Judged::kOwn,
        [p](const Statistics& s) { return s.strength.quantile_dbsm(Sort::kVehicle, 0.0, kEverywhere, p); }));
  }
  rows.push_back(level_row("false movers, all ranges: median", {-9, -4}, {}, Judged::kOwn, [](const Statistics& s) {
    return s.strength.quantile_dbsm(Sort::kFalseMover, 0.0, kEverywhere, 0.5);
  }));
}

void add_separation(std::vector<Row>& rows) {
  const auto add = [&rows](const char* range, double from_m, double to_m, Measured r, Measured n) {
    rows.push_back({4, std::string("vehicle stronger than false mover, ") + range, "", 2, r, n, Judged::kOwn,
                    [from_m, to_m](const Statistics& s) { return s.strength.vehicle_is_stronger(from_m, to_m); }});
  };
  for (const Levels& l : kLevels_r) add(l.range, l.from_m, l.to_m, l.vehicle_is_stronger, {});
  add("5–15 m", 5.0, 15.0, {}, 0.54);
  add("15–30 m", 15.0, 30.0, {}, 0.49);
  add("30–50 m", 30.0, 50.0, {}, 0.48);
  struct Valid {
    const char* range;
    double from_m, to_m, n;
  };
  for (const Valid& v :
       {Valid{"5–15 m", 5.0, 15.0, 0.70}, Valid{"15–30 m", 15.0, 30.0, 0.58}, Valid{"30–50 m", 30.0, 50.0, 0.51}}) {
    const double from_m = v.from_m, to_m = v.to_m;
    rows.push_back(
        {4,
         std::string("the same, valid by the sensor, ") + v.range,
         "",
         2,
         {},
         v.n,
         Judged::kOwn,
         [from_m, to_m](const Statistics& s) { return s.strength.valid_vehicle_is_stronger(from_m, to_m); }});
  }
}

void add_spread(std::vector<Row>& rows) {
  for (std::size_t bin = 0; bin < kStrengthBins; ++bin) {
    rows.push_back({4,
                    std::string("one vehicle, sd at ") + kLevels_r[bin].range,
                    "dB",
                    0,
                    {7, 13},
                    {},
                    Judged::kShared,
                    [bin](const Statistics& s) { return s.strength.std_in_bin_db(bin); }});
  }
  rows.push_back({4, "one vehicle, sd in one scan", "dB", 0, {5, 8}, {}, Judged::kNo, [](const Statistics& s) {
                    return s.strength.std_in_scan_db();
                  }});
  rows.push_back({4,
                  "strongest one of a vehicle, sd from scan to scan",
                  "dB",
                  1,
                  {3.4, 4.9},
                  {},
                  Judged::kShared,
                  [](const Statistics& s) { return s.strength.std_scan_to_scan_db(); }});
}

void add_strongest(std::vector<Row>& rows) {
  struct Median {
    const char* range;
    double from_m, to_m;
    Measured r;
  };
  for (const Median& m : {Median{"< 10 m", 0, 10, -4}, Median{"10–20 m", 10, 20, -2},
                          Median{"20–50 m", 20, 50, {0, 10}}, Median{"> 50 m", 50, kEverywhere, {9, 11}}}) {
    const double from_m = m.from_m, to_m = m.to_m;
    rows.push_back(
        level_row(std::string("strongest one of a vehicle, ") + m.range + ": median", m.r, {}, Judged::kNo,
                  [from_m, to_m](const Statistics& s) { return s.strength.strongest_median_dbsm(from_m, to_m); }));
  }
  struct Weak {
    const char* name;
    RoadUser user;
    double from_m, to_m, r;
  };
  for (const Weak& w :
       {Weak{"car < 20 m", RoadUser::kCar, 0, 20, 38}, Weak{"car 20–50 m", RoadUser::kCar, 20, 50, 23},
        Weak{"car > 50 m", RoadUser::kCar, 50, kEverywhere, 8}, Weak{"truck/bus < 20 m", RoadUser::kTruck, 0, 20, 22},
        Weak{"truck/bus 20–50 m", RoadUser::kTruck, 20, 50, 10},
        Weak{"truck/bus > 50 m", RoadUser::kTruck, 50, kEverywhere, 1}}) {
    const RoadUser user = w.user;
    const double from_m = w.from_m, to_m = w.to_m;
    rows.push_back({4,
                    std::string(w.name) + ": strongest one < −5 dBsm",
                    "%",
                    0,
                    w.r,
                    {},
                    Judged::kNo,
                    [user, from_m, to_m](const Statistics& s) {
                      return s.strength.percent_strongest_below(user, from_m, to_m, -5.0);
                    }});
  }
  rows.push_back(level_row("pedestrian: median", -8, 0, Judged::kNo,
                           [](const Statistics& s) { return s.strength.median_dbsm(RoadUser::kPedestrian); }));
  rows.push_back(level_row("two-wheeler: median", {-11, -9}, -1, Judged::kNo,
                           [](const Statistics& s) { return s.strength.median_dbsm(RoadUser::kTwoWheeler); }));
}

}  // namespace

void add_strength_rows(std::vector<Row>& rows) {
  add_levels(rows);
  add_separation(rows);
  add_spread(rows);
  add_strongest(rows);
}

}  // namespace boresight::bench::realism
