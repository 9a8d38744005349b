// Measured values of sections 2 and 3. R: Schumann et al. 2021, N: Caesar et al. 2020; aggregate figures.
#include <tuple>

#include "tests/benchmarks/realism/rows/row.hpp"

namespace boresight::bench::realism {

namespace {

using SamplesOf = Samples BodyPlaces::Figures::*;

Row quantile_row(const std::string& name, RoadUser user, SamplesOf which, double share, int digits, Measured r,
                 Measured n, Judged judged) {
  const std::string p = ": p" + std::to_string(static_cast<int>(kPercent * share + 0.5));
  return {2,      name + p,
          "m",    digits,
          r,      n,
          judged, [user, which, share](const Statistics& s) { return (s.places.of(user).*which).quantile(share); }};
}

Row above_row(const std::string& name, RoadUser user, SamplesOf which, double limit_m, int digits, Measured r,
              Measured n, Judged judged) {
  return {2,
          name,
          "%",
          digits,
          r,
          n,
          judged,
          [user, which, limit_m](const Statistics& s) { return (s.places.of(user).*which).percent_above(limit_m); }};
}

void add_quantiles(std::vector<Row>& rows, const std::string& name, RoadUser user, SamplesOf which, int digits,
                   const std::vector<std::tuple<double, double>>& shares_and_values, bool is_nuscenes) {
  for (const auto& [share, value] : shares_and_values) {
    rows.push_back(quantile_row(name, user, which, share, digits, is_nuscenes ? Measured{} : Measured{value},
                                is_nuscenes ? Measured{value} : Measured{}, Judged::kNo));
  }
}

std::vector<std::tuple<const char*, DeviationSelection>> aspects_of(RoadUser user) {
  return {{"all", {user, 0.0, 4.0}},
          {"from behind", {user, 0.0, kEndSector_rad}},
          {"from the side", {user, kSideFrom_rad, kSideTo_rad}},
          {"from ahead", {user, M_PI - kEndSector_rad, 4.0}}};
}

}  // namespace

void add_place_rows(std::vector<Row>& rows) {
  using F = BodyPlaces::Figures;
  using U = RoadUser;
  add_quantiles(rows, "car, depth inside the box", U::kCar, &F::depth_m, 2, {{0.1, -0.18}, {0.5, 0.36}, {0.9, 0.78}},
                true);
  add_quantiles(rows, "standing car, depth inside the box", U::kStandingCar, &F::depth_m, 2,
                {{0.1, -0.34}, {0.5, 0.24}, {0.9, 0.58}}, true);
  rows.push_back(above_row("car: more than 0.7 m inside", U::kCar, &F::depth_m, 0.7, 0, {}, 15, Judged::kShared));
  rows.push_back(above_row("truck/bus: more than 0.7 m inside", U::kTruck, &F::depth_m, 0.7, 0, {}, 43, Judged::kNo));
  add_quantiles(rows, "car, length shown by a scan", U::kCar, &F::shown_length_m, 1,
                {{0.5, 2.4}, {0.9, 3.8}, {0.99, 4.7}}, false);
  add_quantiles(rows, "car, width shown by a scan", U::kCar, &F::shown_width_m, 1,
                {{0.5, 1.1}, {0.9, 1.8}, {0.99, 2.4}}, false);
  add_quantiles(rows, "truck/bus, length shown by a scan", U::kTruck, &F::shown_length_m, 1,
                {{0.5, 4.2}, {0.9, 8.3}, {0.99, 11.7}}, false);
  rows.push_back(
      above_row("car: > 1 m behind the nearest one", U::kCar, &F::behind_nearest_m, 1.0, 0, 47, {}, Judged::kNo));
  rows.push_back(
      above_row("car: > 2 m behind the nearest one", U::kCar, &F::behind_nearest_m, 2.0, 0, 17, {}, Judged::kShared));
  rows.push_back(
      above_row("car: > 3 m behind the nearest one", U::kCar, &F::behind_nearest_m, 3.0, 0, 5, {}, Judged::kNo));
  rows.push_back(above_row("truck/bus: > 2 m behind the nearest one", U::kTruck, &F::behind_nearest_m, 2.0, 0, 57, {},
                           Judged::kNo));
  rows.push_back(above_row("truck/bus: > 5 m behind the nearest one", U::kTruck, &F::behind_nearest_m, 5.0, 0, 16, {},
                           Judged::kNo));
  rows.push_back(above_row("truck/bus: > 8 m behind the nearest one", U::kTruck, &F::behind_nearest_m, 8.0, 0, 4, {},
                           Judged::kNo));
  rows.push_back({2, "car: sd across the track", "m", 2, 0.51, {}, Judged::kNo, [](const Statistics& s) {
                    return s.places.of(U::kCar).across_m.std_dev();
                  }});
  rows.push_back(
      above_row("car: > 1.5 m across the track", U::kCar, &F::across_from_mean_m, 1.5, 1, 0.3, {}, Judged::kNo));
}

void add_deviation_rows(std::vector<Row>& rows) {
  using U = RoadUser;
  struct Shares {
    std::string name;
    DeviationSelection of;
    double half, one, two;  // percent beyond 0.5, 1, 2 m/s
    Judged judged;
  };
  const auto car = aspects_of(U::kCar), truck = aspects_of(U::kTruck);
  const std::vector<Shares> all = {
      {"car", std::get<1>(car[0]), 4.7, 2.2, 0.9, Judged::kNo},
      {"car from behind", std::get<1>(car[1]), 2.2, 1.1, 0.4, Judged::kShared},
      {"car from the side", std::get<1>(car[2]), 24, 11, 3, Judged::kShared},
      {"car from ahead", std::get<1>(car[3]), 4.0, 2.1, 1.5, Judged::kShared},
      {"truck/bus", std::get<1>(truck[0]), 3.5, 1.6, 0.8, Judged::kNo},
      {"truck/bus from the side", std::get<1>(truck[2]), 31, 16, 10, Judged::kShared},
      {"pedestrian", {U::kPedestrian, 0.0, 4.0}, 18, 3.4, 0, Judged::kNo},
      {"two-wheeler", {U::kTwoWheeler, 0.0, 4.0}, 1.5, 0.5, 0, Judged::kNo},
  };
  for (const Shares& shares : all) {
    const int digits = shares.half >= 10.0 ? 0 : 1;
    for (const auto& [limit, value, judged] :
         {std::tuple{0.5, shares.half, shares.judged}, std::tuple{1.0, shares.one, Judged::kNo},
          std::tuple{2.0, shares.two, Judged::kNo}}) {
      const double limit_mps = limit;
      const DeviationSelection of = shares.of;
      const char* const beyond = limit == 0.5 ? ": > 0.5 m/s" : limit == 1.0 ? ": > 1 m/s" : ": > 2 m/s";
      rows.push_back({3, shares.name + beyond, "%", digits, value, {}, judged, [of, limit_mps](const Statistics& s) {
                        return s.deviations.percent_beyond(of, limit_mps);
                      }});
    }
  }
  for (const auto& [share, value] : {std::tuple{0.05, -0.88}, std::tuple{0.25, -0.47}, std::tuple{0.50, -0.11},
                                     std::tuple{0.75, 0.18}, std::tuple{0.95, 0.52}}) {
    const double p = share;
    rows.push_back(
        {3,
         "car, beyond 1 m/s: deviation / radial speed, p" + std::to_string(static_cast<int>(kPercent * p + 0.5)),
         "",
         2,
         value,
         {},
         Judged::kShared,
         [p](const Statistics& s) {
           return s.deviations.ratio({U::kCar, 0.0, 4.0}, p);
         }});
  }
  for (const auto& [name, user, value, digits] :
       {std::tuple{"car", U::kCar, 0.049, 3}, std::tuple{"truck/bus", U::kTruck, 0.037, 3},
        std::tuple{"pedestrian", U::kPedestrian, 0.28, 2}}) {
    const RoadUser u = user;
    rows.push_back({3,
                    std::string(name) + ": robust sd of the rest",
                    "m/s",
                    digits,
                    value,
                    {},
                    Judged::kNo,
                    [u](const Statistics& s) {
                      return s.deviations.rest_std_mps({u, 0.0, 4.0});
                    }});
  }
}

}  // namespace boresight::bench::realism
