// Measured values of section 6. R: Schumann et al. 2021, N: Caesar et al. 2020; aggregate figures.
#include <array>
#include <tuple>

#include "tests/benchmarks/realism/rows/row.hpp"

namespace boresight::bench::realism {

namespace {

using Figure = std::function<double(const Statistics&)>;

void add(std::vector<Row>& rows, std::string name, std::string unit, int digits, Measured r, Measured n, Judged judged,
         Figure figure, Scale scale = Scale::kRatio) {
  rows.push_back({6, std::move(name), std::move(unit), digits, r, n, judged, std::move(figure), scale});
}

void add_numbers(std::vector<Row>& rows) {
  add(rows, "a scan, mean", "", 1, {7.5, 15.8}, {}, Judged::kOwn,
      [](const Statistics& s) { return s.false_movers.per_scan(); });
  add(rows, "a scan, forward radars", "", 0, {9, 28}, {}, Judged::kOwn,
      [](const Statistics& s) { return s.false_movers.per_scan(Facing::kForward).mean(); });
  add(rows, "a scan, radars to the side", "", 0, {5, 8}, {}, Judged::kOwn,
      [](const Statistics& s) { return s.false_movers.per_scan(Facing::kSideways).mean(); });
  add(rows, "a scan within 50 m, outside all boxes", "", 1, {}, 4.4, Judged::kOwn,
      [](const Statistics& s) { return s.false_movers.near_per_scan(); });
  add(rows, "the same, forward radars", "", 1, {}, 4.1, Judged::kNo,
      [](const Statistics& s) { return s.false_movers.near_per_scan(Facing::kForward).mean(); });
  add(rows, "the same, radars to the side", "", 1, {}, 3.0, Judged::kNo,
      [](const Statistics& s) { return s.false_movers.near_per_scan(Facing::kSideways).mean(); });
  add(rows, "the same, radars to the rear", "", 1, {}, {5.5, 6.5}, Judged::kNo,
      [](const Statistics& s) { return s.false_movers.near_per_scan(Facing::kRear).mean(); });
  add(rows, "the same, valid by the sensor", "", 2, {}, 0.75, Judged::kOwn,
      [](const Statistics& s) { return s.false_movers.near_valid_per_scan(); });
  for (const auto& [share, low, high] : {std::tuple{0.10, 2.0, 4.0}, std::tuple{0.50, 8.0, 17.0},
                                         std::tuple{0.90, 18.0, 80.0}, std::tuple{0.99, 34.0, 124.0}}) {
    const double p = share;
    add(rows, "a scan, forward radars: p" + std::to_string(static_cast<int>(kPercent * p + 0.5)), "", 0, {low, high},
        {}, Judged::kOwn, [p](const Statistics& s) { return s.false_movers.per_scan(Facing::kForward).quantile(p); });
  }
  const std::array<std::tuple<const char*, double>, 3> kBeyond{
      {{"a scan, > 0.5 m/s", 13.2}, {"a scan, > 2 m/s", 9.6}, {"a scan, > 5 m/s", 7.4}}};
  for (std::size_t i = 0; i < kBeyond.size(); ++i) {
    add(rows, std::get<0>(kBeyond[i]), "", 1, std::get<1>(kBeyond[i]), {}, Judged::kNo,
        [i](const Statistics& s) { return s.false_movers.per_scan_beyond(i); });
  }
  add(rows, "of all that is of no labelled mover", "%", 1, {4.4, 10}, {}, Judged::kNo,
      [](const Statistics& s) { return s.false_movers.percent_of_unlabelled(); });
}

void add_distribution(std::vector<Row>& rows) {
  const std::array<std::tuple<const char*, double, double>, FalseMovers::kDensities> kDensity{
      {{"0–10 m", 16, 16}, {"10–25 m", 7, 11}, {"25–50 m", 2, 5}, {"50–100 m", 0.4, 1.2}}};
  for (std::size_t ring = 0; ring < kDensity.size(); ++ring) {
    const auto& [range, low, high] = kDensity[ring];
    add(rows, std::string("density at ") + range, "1e-5/(m²·m/s)", 1, {low, high}, {}, Judged::kNo,
        [ring](const Statistics& s) { return 1e5 * s.false_movers.density_per_m2_mps(ring); });
  }
  add(rows, "density in the whole view", "1e-5/(m²·m/s)", 1, {1.2, 2.5}, {}, Judged::kNo,
      [](const Statistics& s) { return 1e5 * s.false_movers.density_of_view_per_m2_mps(); });
  const std::array<std::tuple<const char*, double>, FalseMovers::kDeviations> kDeviation{
      {{"1–2", 14}, {"2–5", 20}, {"5–10", 16}, {"10–20", 32}, {"20–36", 17}}};
  for (std::size_t band = 0; band < kDeviation.size(); ++band) {
    const auto& [name, value] = kDeviation[band];
    add(rows, std::string("deviation of ") + name + " m/s", "%", 0, value, {}, Judged::kOwn,
        [band](const Statistics& s) { return s.false_movers.percent_of_deviation(band); });
  }
  add(rows, "range rate within ±1 m/s", "%", 0, 22, {}, Judged::kNo,
      [](const Statistics& s) { return s.false_movers.percent_near_zero_rate(); });
  for (const auto& [share, low, high, judged] :
       {std::tuple{0.10, 8.0, 12.0, Judged::kOwn}, std::tuple{0.25, 16.0, 22.0, Judged::kNo},
        std::tuple{0.50, 29.0, 37.0, Judged::kOwn}, std::tuple{0.75, 49.0, 62.0, Judged::kNo},
        std::tuple{0.90, 67.0, 84.0, Judged::kOwn}}) {
    const double p = share;
    add(rows, "range: p" + std::to_string(static_cast<int>(kPercent * p + 0.5)), "m", 0, {low, high}, {}, judged,
        [p](const Statistics& s) { return s.false_movers.range_m().quantile(p); });
  }
}

void add_persistence(std::vector<Row>& rows) {
  add(rows, "seen again in the next scan", "", 2, {0.21, 0.24}, 0.37, Judged::kNo,
      [](const Statistics& s) { return s.false_movers.seen_again(); });
  add(rows, "the same by chance", "", 2, {0.02, 0.13}, {}, Judged::kNo,
      [](const Statistics& s) { return s.false_movers.seen_again_by_chance(); });
  add(rows, "chains of one scan", "%", 0, {85, 88}, {}, Judged::kOwn,
      [](const Statistics& s) { return s.false_movers.percent_of_chains_single(); });
  add(rows, "detections in chains of ≥ 6 scans", "%", 0, 8, {}, Judged::kOwn,
      [](const Statistics& s) { return s.false_movers.percent_in_chains_of(6); });
  add(rows, "detections in chains of > 13 scans", "%", 0, 3, {}, Judged::kNo,
      [](const Statistics& s) { return s.false_movers.percent_in_chains_of(14); });
  add(rows, "correlation of counts after one scan", "", 2, {0.7, 0.97}, {}, Judged::kNo,
      [](const Statistics& s) { return s.false_movers.correlation(0); });
  add(rows, "correlation of counts after 1 s", "", 1, {0.3, 0.9}, {}, Judged::kShared,
      [](const Statistics& s) { return s.false_movers.correlation(1); });
  add(rows, "correlation of counts after 3 s", "", 1, {0.2, 0.8}, {}, Judged::kNo,
      [](const Statistics& s) { return s.false_movers.correlation(2); });
  add(rows, "variance / mean about the rate", "", 1, {1.2, 1.5}, {}, Judged::kNo,
      [](const Statistics& s) { return s.false_movers.variance_over_mean(); });
}

void add_origins(std::vector<Row>& rows) {
  add(rows, "Doppler ambiguity, as measured", "%", 0, {15, 16}, {}, Judged::kNo,
      [](const Statistics& s) { return s.false_movers.percent_doppler_measured(); });
  add(rows, "Doppler ambiguity, by the truth", "%", 0, {15, 16}, {}, Judged::kNo,
      [](const Statistics& s) { return s.false_movers.percent_doppler_by_truth(); });
  add(rows, "Doppler ambiguity, of stationary detections, as measured", "%", 1, 1.0, {}, Judged::kNo,
      [](const Statistics& s) { return s.false_movers.percent_doppler_of_stationary(); });
  add(rows, "Doppler ambiguity, of stationary detections, by the truth", "%", 1, 1.0, {}, Judged::kOwn,
      [](const Statistics& s) { return s.false_movers.percent_doppler_of_stationary_by_truth(); });
  add(rows, "Doppler ambiguity, of labelled movers", "%", 1, {2.0, 5.3}, {}, Judged::kOwn,
      [](const Statistics& s) { return s.false_movers.percent_doppler_of_movers(); });
  add(rows, "azimuth ambiguity beyond chance, as measured", "%", 0, 12, {}, Judged::kNo,
      [](const Statistics& s) { return s.false_movers.percent_azimuth_measured(); });
  add(rows, "azimuth ambiguity, by the truth", "%", 0, 12, {}, Judged::kNo,
      [](const Statistics& s) { return s.false_movers.percent_azimuth_by_truth(); });
  add(rows, "azimuth ambiguity, by the truth: a scan", "", 1, 1.3, {}, Judged::kOwn,
      [](const Statistics& s) { return s.false_movers.azimuth_by_truth_per_scan(); });
  add(rows, "azimuth ambiguity: step of sin(azimuth)", "", 2, 0.72, {}, Judged::kOwn,
      [](const Statistics& s) { return s.origins.sine_step(); });
  add(rows, "beside a labelled object", "%", 0, {6, 10}, {}, Judged::kNo,
      [](const Statistics& s) { return s.false_movers.percent_beside_object(); });
  add(rows, "beside a tracked object, detected or not", "%", 0, {18, 20}, {}, Judged::kNo,
      [](const Statistics& s) { return s.origins.percent_beside_tracked_object(); });
  add(rows, "behind an object at its range rate", "%", 0, {3, 8}, {}, Judged::kNo,
      [](const Statistics& s) { return s.origins.percent_behind_object(); });
  add(rows, "the same 10° beside it", "%", 0, {3, 8}, {}, Judged::kNo,
      [](const Statistics& s) { return s.origins.percent_beside_behind_object(); });
  add(rows, "twice range and range rate of an object", "%", 1, 0.2, {}, Judged::kNo,
      [](const Statistics& s) { return s.origins.percent_at_twice_the_range(); });
  add(rows, "mirror images of type 2, by the truth", "%", 0, {5, 20}, {}, Judged::kNo,
      [](const Statistics& s) { return s.origins.percent_mirror_images(); });
  add(rows, "unlabelled rest of an object", "%", 0, {2, 4}, {}, Judged::kNo,
      [](const Statistics& s) { return s.origins.percent_rest_of_object(); });
  add(rows, "none of these", "%", 0, 30, {}, Judged::kNo,
      [](const Statistics& s) { return s.origins.percent_of_no_origin(); });
}

void add_ghosts(std::vector<Row>& rows) {
  for (const auto& [share, value, judged] :
       {std::tuple{0.10, -29.0, Judged::kShared}, std::tuple{0.25, -21.0, Judged::kNo},
        std::tuple{0.50, -12.0, Judged::kShared}, std::tuple{0.75, -4.0, Judged::kNo},
        std::tuple{0.90, 3.0, Judged::kShared}}) {
    const double p = share;
    add(
        rows, "strength against the object: p" + std::to_string(static_cast<int>(kPercent * p + 0.5)), "dB", 0, value,
        {}, judged, [p](const Statistics& s) { return s.ghosts.quantile_db(p); }, Scale::kLevel_db);
  }
  add(rows, "stronger than the object", "%", 0, 15, {}, Judged::kNo,
      [](const Statistics& s) { return s.ghosts.percent_stronger(); });
  for (const auto& [share, value] : {std::tuple{0.10, -29.0}, std::tuple{0.50, -12.0}, std::tuple{0.90, 3.0}}) {
    const double p = share;
    add(
        rows,
        "mirror images against the object, by the truth: p" + std::to_string(static_cast<int>(kPercent * p + 0.5)),
        "dB", 0, value, {}, Judged::kNo, [p](const Statistics& s) { return s.ghosts.mirror_image_quantile_db(p); },
        Scale::kLevel_db);
  }
}

void add_validity(std::vector<Row>& rows) {
  add(rows, "valid by the sensor: movers in their box", "%", 0, {}, 47, Judged::kOwn,
      [](const Statistics& s) { return s.false_movers.percent_valid(true); });
  add(rows, "valid by the sensor: false movers", "%", 0, {}, 17, Judged::kOwn,
      [](const Statistics& s) { return s.false_movers.percent_valid(false); });
  add(rows, "unambiguous by the sensor: movers in their box", "%", 0, {}, 56, Judged::kNo,
      [](const Statistics& s) { return s.false_movers.percent_unambiguous(true); });
  add(rows, "unambiguous by the sensor: false movers", "%", 0, {}, 18, Judged::kNo,
      [](const Statistics& s) { return s.false_movers.percent_unambiguous(false); });
  add(rows, "existence probability of a mover exceeds a false mover's", "", 2, {}, {0.65, 0.73}, Judged::kNo,
      [](const Statistics& s) { return s.false_movers.existence_separates(); });
}

}  // namespace

void add_false_mover_rows(std::vector<Row>& rows) {
  add_numbers(rows);
  add_distribution(rows);
  add_persistence(rows);
  add_origins(rows);
  add_ghosts(rows);
  add_validity(rows);
}

}  // namespace boresight::bench::realism
