// Measured values of section 1. R: Schumann et al. 2021, N: Caesar et al. 2020; aggregate figures.
#include "tests/benchmarks/realism/rows/row.hpp"

namespace boresight::bench::realism {

namespace {

struct MeasuredCount {
  const char* name;
  CountSelection of;
  Measured mean_r, none_r, mean_n, none_n;
  int digits = 1;
};

CountSelection select(RoadUser user, double from_m, double to_m) {
  return {user, from_m, to_m, 0.0, 4.0};
}

const std::vector<MeasuredCount>& measured_counts() {
  using U = RoadUser;
  const Measured none{};
  static const std::vector<MeasuredCount> kCounts = {
      {"car 10–20 m", select(U::kCar, 10, 20), 3.1, 18, 3.4, 0},
      {"car 20–30 m", select(U::kCar, 20, 30), 1.4, 23, 2.8, 0},
      {"car 30–40 m", select(U::kCar, 30, 40), 1.5, 22, none, none},
      {"car 30–45 m", select(U::kCar, 30, 45), none, none, 2.9, 3},
      {"car 50–65 m", select(U::kCar, 50, 65), 1.07, 30, none, none, 2},
      {"car 65–80 m", select(U::kCar, 65, 80), 0.84, 41, none, none, 2},
      {"car 80–100 m", select(U::kCar, 80, 100), 0.64, 53, none, none, 2},
      {"car, all ranges", select(U::kCar, 0, kEverywhere), 1.5, 28, none, none},
      {"standing car 10–20 m", select(U::kStandingCar, 10, 20), none, none, 1.6, 33},
      {"standing car 20–30 m", select(U::kStandingCar, 20, 30), none, none, 1.4, 32},
      {"standing car 30–45 m", select(U::kStandingCar, 30, 45), none, none, 1.3, 35},
      {"truck/bus 10–20 m", select(U::kTruck, 10, 20), 5.1, 6, 10.9, 4},
      {"truck/bus 20–30 m", select(U::kTruck, 20, 30), 3.3, 17, none, none},
      {"truck/bus 30–40 m", select(U::kTruck, 30, 40), 2.6, 19, none, none},
      {"truck/bus 65–100 m", select(U::kTruck, 65, 100), 1.6, 42, none, none},
      {"standing truck/bus 20–30 m", select(U::kStandingTruck, 20, 30), none, none, 2.5, 30},
      {"standing truck/bus 30–40 m", select(U::kStandingTruck, 30, 40), none, none, 1.8, 38},
      {"pedestrian walking 10–20 m", select(U::kPedestrian, 10, 20), 1.4, 29, 0.62, 58},
      {"pedestrian walking 20–30 m", select(U::kPedestrian, 20, 30), 0.9, 46, 1.3, 27},
      {"two-wheeler 20–50 m", select(U::kTwoWheeler, 20, 50), 0.75, 47, none, none, 2},
      {"two-wheeler, all ranges", select(U::kTwoWheeler, 0, kEverywhere), none, none, 0.76, 36, 2},
  };
  return kCounts;
}

void add_means(std::vector<Row>& rows) {
  for (const MeasuredCount& m : measured_counts()) {
    const CountSelection of = m.of;
    rows.push_back({1, std::string(m.name) + ": mean", "", m.digits, m.mean_r, m.mean_n, Judged::kOwn,
                    [of](const Statistics& s) { return s.counts.mean(s.counting, of); }});
    rows.push_back({1, std::string(m.name) + ": none", "%", 0, m.none_r, m.none_n, Judged::kOwn,
                    [of](const Statistics& s) { return s.counts.percent_none(s.counting, of); }});
  }
  const CountSelection car{}, truck{RoadUser::kTruck};
  rows.push_back({1, "car in sight: mean", "", 1, {}, {}, Judged::kNo, [car](const Statistics& s) {
                    return s.counts.mean(Counting::kInSight, car);
                  }});
  rows.push_back({1, "car in sight: none", "%", 0, {}, {}, Judged::kNo, [car](const Statistics& s) {
                    return s.counts.percent_none(Counting::kInSight, car);
                  }});
  const CountSelection beside = select(RoadUser::kCar, 0, 10), ahead = select(RoadUser::kCar, 20, 30);
  rows.push_back({1, "car < 10 m: most in one scan", "", 0, 20, {}, Judged::kShared, [beside](const Statistics& s) {
                    return s.counts.most(beside);
                  }});
  rows.push_back({1, "car 20–30 m: most in one scan", "", 0, 12, {}, Judged::kNo, [ahead](const Statistics& s) {
                    return s.counts.most(ahead);
                  }});
  rows.push_back({1, "truck/bus: most in one scan", "", 0, 35, {}, Judged::kNo, [truck](const Statistics& s) {
                    return s.counts.most(truck);
                  }});
}

void add_aspects(std::vector<Row>& rows) {
  struct Aspect {
    const char* name;
    double from_rad, to_rad, mean_r;
  };
  for (const Aspect& a : {Aspect{"rear", 0.0, kEndSector_rad, 1.3}, Aspect{"side", kSideFrom_rad, kSideTo_rad, 4.7},
                          Aspect{"front", M_PI - kEndSector_rad, 4.0, 1.7}}) {
    const CountSelection of{RoadUser::kCar, 0.0, 60.0, a.from_rad, a.to_rad};
    rows.push_back({1,
                    std::string("car < 60 m, ") + a.name + ": mean",
                    "",
                    1,
                    a.mean_r,
                    {},
                    Judged::kOwn,
                    [of](const Statistics& s) { return s.counts.mean(s.counting, of); }});
  }
}

void add_spreads(std::vector<Row>& rows) {
  const CountSelection far = select(RoadUser::kCar, 30, kEverywhere), near = select(RoadUser::kCar, 0, 30);
  const CountSelection truck{RoadUser::kTruck};
  rows.push_back({1, "car > 30 m: variance / mean", "", 1, {0.7, 1.1}, {}, Judged::kNo, [far](const Statistics& s) {
                    return s.counts.variance_over_mean(s.counting, far);
                  }});
  rows.push_back({1, "car < 30 m: variance / mean", "", 0, {2, 5}, {}, Judged::kNo, [near](const Statistics& s) {
                    return s.counts.variance_over_mean(s.counting, near);
                  }});
  rows.push_back({1, "truck/bus: variance / mean", "", 0, {2, 5}, {}, Judged::kNo, [truck](const Statistics& s) {
                    return s.counts.variance_over_mean(s.counting, truck);
                  }});
  for (const auto& [name, user, value] :
       {std::tuple{"car", RoadUser::kCar, 0.71}, std::tuple{"truck/bus", RoadUser::kTruck, 1.39}}) {
    const RoadUser u = user;
    rows.push_back({1,
                    std::string(name) + ", one track and range bin: variance / mean",
                    "",
                    2,
                    value,
                    {},
                    Judged::kNo,
                    [u](const Statistics& s) { return s.counts.variance_over_mean_in_track(s.counting, u); }});
  }
}

void add_misses(std::vector<Row>& rows) {
  struct Miss {
    const char* name;
    RoadUser user;
    Measured none_r, after_r, none_n, after_n;
    Judged judged;
  };
  const Measured none{};
  for (const Miss& m : {Miss{"car", RoadUser::kCar, 0.27, 0.67, none, none, Judged::kOwn},
                        Miss{"truck/bus", RoadUser::kTruck, 0.31, 0.76, none, none, Judged::kOwn},
                        Miss{"two-wheeler", RoadUser::kTwoWheeler, 0.50, 0.78, 0.34, 0.53, Judged::kOwn},
                        Miss{"pedestrian", RoadUser::kPedestrian, 0.24, 0.66, 0.56, 0.83, Judged::kOwn},
                        Miss{"standing car", RoadUser::kStandingCar, none, none, 0.34, 0.81, Judged::kShared}}) {
    const RoadUser user = m.user;
    rows.push_back(
        {1, std::string(m.name) + ": P(none)", "", 2, m.none_r, m.none_n, Judged::kOwn, [user](const Statistics& s) {
           return s.counts.percent_none(s.counting, select(user, 0, kEverywhere)) / kPercent;
         }});
    rows.push_back({1, std::string(m.name) + ": P(none given none)", "", 2, m.after_r, m.after_n, m.judged,
                    [user](const Statistics& s) { return s.counts.none_after_none(s.counting, user); }});
  }
  struct Gap {
    const char* name;
    RoadUser user;
    double mean, p90, p99;
  };
  for (const Gap& g : {Gap{"car", RoadUser::kCar, 3, 6, 20}, Gap{"truck/bus", RoadUser::kTruck, 4, 9, 38}}) {
    const RoadUser user = g.user;
    const std::string name = std::string(g.name) + ", gap: ";
    rows.push_back({1, name + "mean", "scans", 0, g.mean, {}, Judged::kNo, [user](const Statistics& s) {
                      return s.counts.gaps(s.counting, user).mean();
                    }});
    rows.push_back({1, name + "p90", "scans", 0, g.p90, {}, Judged::kNo, [user](const Statistics& s) {
                      return s.counts.gaps(s.counting, user).quantile(0.90);
                    }});
    rows.push_back({1, name + "p99", "scans", 0, g.p99, {}, Judged::kNo, [user](const Statistics& s) {
                      return s.counts.gaps(s.counting, user).quantile(0.99);
                    }});
  }
  struct Lag {
    const char* name;
    std::size_t scans;
    Measured value;
  };
  for (const Lag& l :
       {Lag{"one scan", 1, {0.23, 0.45}}, Lag{"two scans", 2, {0.15, 0.36}}, Lag{"five scans", 5, 0.0}}) {
    const std::size_t lag = l.scans;
    rows.push_back({1,
                    std::string("car: correlation of counts after ") + l.name,
                    "",
                    2,
                    l.value,
                    {},
                    Judged::kNo,
                    [lag](const Statistics& s) { return s.counts.correlation(s.counting, RoadUser::kCar, lag); }});
  }
}

void add_births(std::vector<Row>& rows) {
  for (const auto& [name, user, value] :
       {std::tuple{"car", RoadUser::kCar, 55.0}, std::tuple{"truck/bus", RoadUser::kTruck, 79.0}}) {
    const RoadUser u = user;
    rows.push_back(
        {1, std::string(name) + ", first seen: median", "m", 0, value, {}, Judged::kNo, [u](const Statistics& s) {
           return s.births.first_range_m(u).quantile(0.5);
         }});
  }
  rows.push_back({1,
                  "first detections within 6 m of the largest range",
                  "%",
                  0,
                  {23, 29},
                  {},
                  Judged::kNo,
                  [](const Statistics& s) { return s.births.percent_first_at_largest_range(); }});
  rows.push_back(
      {1, "last detections within 6 m of the largest range", "%", 0, 3, {}, Judged::kNo, [](const Statistics& s) {
         return s.births.percent_last_at_largest_range();
       }});
  rows.push_back(
      {1, "last detections within 6° of the view's edge", "%", 0, {20, 24}, {}, Judged::kNo, [](const Statistics& s) {
         return s.births.percent_last_at_edge();
       }});
  rows.push_back({1, "first and last detections elsewhere", "%", 0, 75, {}, Judged::kNo, [](const Statistics& s) {
                    return s.births.percent_elsewhere();
                  }});
}

}  // namespace

void add_count_rows(std::vector<Row>& rows) {
  add_means(rows);
  add_aspects(rows);
  add_spreads(rows);
  add_misses(rows);
  add_births(rows);
}

}  // namespace boresight::bench::realism
