#include "services/boresight/score/truth_source.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string_view>

#include <fmt/format.h>

#include "services/boresight/score/table.hpp"
#include "services/simulator/drive.hpp"

namespace boresight::score {

namespace fs = std::filesystem;

namespace {

constexpr double kMaxTime_s = 4e9;

fs::path if_there(const fs::path& folder, const char* name) {
  return fs::exists(folder / name) ? folder / name : fs::path{};
}

}  // namespace

TruthSource find_truth(const fs::path& where) {
  TruthSource truth;
  if (!fs::is_directory(where)) {
    const std::vector<std::string> columns = header_of(where);
    const auto has = [&](std::string_view name) {
      return std::find(columns.begin(), columns.end(), name) != columns.end();
    };
    truth.objects = where;
    truth.objects_are_boxes = has("id") && has("x") && has("yaw");
    if (!truth.objects_are_boxes && !(has("object") && has("x_vehicle_m"))) {
      throw InputError(
          fmt::format("{}: is no table of objects; its header must name the columns "
                      "t_s,id,class,x,y,yaw,length,width,vx,vy or those "
                      "of truth_objects.csv",
                      where.string()));
    }
    return truth;
  }
  truth.objects = if_there(where, "truth_objects.csv");
  if (truth.objects.empty()) {
    truth.objects = if_there(where, "boxes.csv");
    truth.objects_are_boxes = !truth.objects.empty();
  }
  truth.detections = if_there(where, "truth_detections.csv");
  if (truth.detections.empty()) {
    truth.detections = if_there(where, "labels.csv");
    truth.detections_are_labels = !truth.detections.empty();
  }
  truth.sensors = if_there(where, "truth_sensors.csv");
  truth.visibility = if_there(where, "truth_visibility.csv");
  truth.drive = if_there(where, "truth.csv");
  if (truth.objects.empty() && truth.detections.empty() && truth.sensors.empty() && truth.drive.empty()) {
    throw InputError(
        fmt::format("{}: holds no truth; it needs truth.csv, truth_objects.csv, truth_detections.csv, "
                    "truth_sensors.csv, boxes.csv or "
                    "labels.csv",
                    where.string()));
  }
  return truth;
}

std::optional<double> first_time_s(const TruthSource& truth) {
  std::optional<double> first_s;
  for (const fs::path* const file : {&truth.objects, &truth.detections, &truth.sensors}) {
    if (file->empty()) continue;
    Table table(*file, {"t_s"});
    if (!table.next()) continue;
    const double t_s = table.number("t_s", -kMaxTime_s, kMaxTime_s);
    first_s = first_s ? std::min(*first_s, t_s) : t_s;
  }
  return first_s;
}

std::int64_t truth_origin_ns(double truth_first_s, std::int64_t run_first_ns, double run_first_s) {
  const std::int64_t recording_begin_ns = run_first_ns - std::llround(run_first_s * 1e9);
  const std::array<std::int64_t, 3> origins_ns = {0, recording_begin_ns, simulator::Drive::kStart_ns};
  const auto distance_ns = [&](std::int64_t origin_ns) {
    return std::abs(static_cast<double>(run_first_ns - origin_ns) - 1e9 * truth_first_s);
  };
  return *std::min_element(origins_ns.begin(), origins_ns.end(),
                           [&](std::int64_t a, std::int64_t b) { return distance_ns(a) < distance_ns(b); });
}

}  // namespace boresight::score
