#include "services/boresight/track/estimates.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "services/boresight/run/csv_row.hpp"
#include "services/boresight/score/table.hpp"

namespace boresight::track {

namespace {

constexpr std::int64_t kLastStep = 1'000'000;
constexpr double kFarthest_m = 1e6, kFastest_mps = 1e6, kLargestExtent_m2 = 1e9;

ExtendedObject object_of(const score::Table& table) {
  ExtendedObject object;
  object.ellipse.centre_m = {table.number("cx", -kFarthest_m, kFarthest_m),
                             table.number("cy", -kFarthest_m, kFarthest_m)};
  object.velocity_mps = {table.number("vx", -kFastest_mps, kFastest_mps),
                         table.number("vy", -kFastest_mps, kFastest_mps)};
  const double xx = table.number("X11", std::numeric_limits<double>::min(), kLargestExtent_m2);
  const double yy = table.number("X22", std::numeric_limits<double>::min(), kLargestExtent_m2);
  const double xy = table.number("X12", -kLargestExtent_m2, kLargestExtent_m2);
  if (!(xy * xy < xx * yy)) table.refuse("X12", "a positive definite extent: X12² < X11 · X22");
  object.ellipse.extent_m2 << xx, xy, xy, yy;
  if (table.has("id")) {
    object.id = static_cast<std::uint32_t>(table.integer("id", 0, std::numeric_limits<std::uint32_t>::max()));
  }
  return object;
}

}  // namespace

ObjectsByStep read_objects(const std::filesystem::path& file) {
  score::Table table(file, {"step", "cx", "cy", "vx", "vy", "X11", "X12", "X22"});
  ObjectsByStep objects;
  while (table.next()) {
    const auto step = static_cast<std::size_t>(table.integer("step", 1, kLastStep));
    if (objects.size() < step) objects.resize(step);
    objects[step - 1].push_back(object_of(table));
  }
  return objects;
}

std::string estimates_csv(const ObjectsByStep& objects) {
  std::string text = "step,cx,cy,vx,vy,X11,X12,X22,id\n";
  for (std::size_t step = 1; step <= objects.size(); ++step) {
    for (const ExtendedObject& object : objects[step - 1]) {
      const Eigen::Matrix2d& extent = object.ellipse.extent_m2;
      run::CsvRow(text)
          .number(step)
          .number(object.ellipse.centre_m.x())
          .number(object.ellipse.centre_m.y())
          .number(object.velocity_mps.x())
          .number(object.velocity_mps.y())
          .number(extent(0, 0))
          .number(extent(0, 1))
          .number(extent(1, 1))
          .number(object.id)
          .end();
    }
  }
  return text;
}

std::vector<ExtendedObject> estimates_of(const TrackList& tracks) {
  constexpr float kLeastExistence = 0.5F;
  std::vector<ExtendedObject> estimates;
  for (std::size_t i = 0; i < tracks.number_of_tracks; ++i) {
    const Track& track = tracks.tracks[i];
    if (!(track.existence_probability > kLeastExistence)) continue;
    ExtendedObject& estimate = estimates.emplace_back();
    estimate.ellipse = judge::ellipse_in_box({track.position_vehicle_m[0], track.position_vehicle_m[1]},
                                             track.heading_rad, track.length_m, track.width_m);
    estimate.velocity_mps = {track.velocity_over_ground_mps[0], track.velocity_over_ground_mps[1]};
    estimate.id = track.tracking_id;
  }
  return estimates;
}

std::size_t number_of_objects(const ObjectsByStep& objects) {
  std::size_t sum = 0;
  for (const std::vector<ExtendedObject>& step : objects) sum += step.size();
  return sum;
}

}  // namespace boresight::track
