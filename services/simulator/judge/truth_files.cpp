#include "services/simulator/judge/truth_files.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <istream>
#include <span>
#include <stdexcept>
#include <string>

namespace boresight::judge {

namespace {

constexpr std::array<std::string_view, kNumberOfProvenances> kWords = {
    "unknown", "moving", "stationary", "ghost_type_1", "ghost_type_2", "clutter", "ambiguity"};

/// Calls `row(cells)` for every line below the header; a line is not valid if it returns false.
template <std::size_t N, typename Row>
void for_each_row(std::istream& table, const char* name, const Row& row) {
  std::string line;
  std::getline(table, line);
  for (std::size_t number = 2; std::getline(table, line); ++number) {
    std::array<std::string_view, N> cells;
    std::size_t count = 0;
    for (std::string_view rest = line; count < N; ++count) {
      const std::size_t end = std::min(rest.find(','), rest.size());
      cells[count] = rest.substr(0, end);
      if (end == rest.size()) {
        ++count;
        break;
      }
      rest.remove_prefix(end + 1);
    }
    if (count != N || !row(cells)) {
      throw std::runtime_error(std::string(name) + ":" + std::to_string(number) + ": cannot be understood: " + line);
    }
  }
}

template <typename T>
bool read(std::string_view cell, T& value) {
  const auto result = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return result.ec == std::errc() && result.ptr == cell.data() + cell.size();
}

}  // namespace

std::string_view table_word(Provenance provenance) {
  const auto index = static_cast<std::size_t>(provenance);
  return kWords[index < kWords.size() ? index : 0];
}

TrueScans read_true_scans(std::istream& table) {
  TrueScans scans;
  std::uint64_t current = 0;
  std::uint32_t current_radar = 0;
  for_each_row<9>(table, "truth_detections.csv", [&](const std::array<std::string_view, 9>& cells) {
    double t_s = 0.0;
    std::uint32_t radar = 0, object = 0, bounces = 0, mirror = 0;
    std::uint64_t scan = 0, index = 0;
    const auto word = std::find(kWords.begin(), kWords.end(), cells[4]);
    if (!read(cells[0], t_s) || !read(cells[1], radar) || !read(cells[2], scan) || !read(cells[3], index) ||
        word == kWords.end() || !read(cells[5], object) || !read(cells[6], bounces) || !read(cells[7], mirror)) {
      return false;
    }
    if (scan != current || radar != current_radar) scans[radar].push_back({t_s, {}});
    current = scan;
    current_radar = radar;
    std::vector<simulator::DetectionTruth>& detections = scans[radar].back().detections;
    if (index != detections.size()) return false;
    detections.push_back({.provenance = static_cast<Provenance>(word - kWords.begin()),
                          .object_id = object,
                          .origin = {},
                          .bounces = static_cast<std::uint8_t>(bounces),
                          .mirror_body = mirror});
    return true;
  });
  return scans;
}

TrueObjects::TrueObjects(std::istream& table) {
  for_each_row<12>(table, "truth_objects.csv", [&](const std::array<std::string_view, 12>& cells) {
    double t_s = 0.0;
    Object o{};
    int parked = 0;
    if (!read(cells[0], t_s) || !read(cells[1], o.id) || !read(cells[2], o.position_m.x()) ||
        !read(cells[3], o.position_m.y()) || !read(cells[4], o.heading_rad) || !read(cells[5], o.velocity_mps.x()) ||
        !read(cells[6], o.velocity_mps.y()) || !read(cells[7], o.length_m) || !read(cells[8], o.width_m) ||
        !read(cells[11], parked)) {
      return false;
    }
    std::vector<Object>& objects = instants_[t_s];
    if (parked == 0) objects.push_back(o);
    return true;
  });
}

std::vector<Object> TrueObjects::at(double t_s) const {
  const auto after = instants_.lower_bound(t_s);
  if (after == instants_.end()) return instants_.empty() ? std::vector<Object>{} : instants_.rbegin()->second;
  if (after == instants_.begin()) return after->second;
  const auto before = std::prev(after);
  const double share = (t_s - before->first) / (after->first - before->first);
  std::vector<Object> objects;
  for (const Object& from : before->second) {
    const auto to = std::find_if(after->second.begin(), after->second.end(), [&](auto& o) { return o.id == from.id; });
    if (to == after->second.end()) continue;
    Object between = from;
    between.position_m += share * (to->position_m - from.position_m);
    between.velocity_mps += share * (to->velocity_mps - from.velocity_mps);
    between.heading_rad += share * std::remainder(to->heading_rad - from.heading_rad, 2.0 * M_PI);
    objects.push_back(between);
  }
  return objects;
}

}  // namespace boresight::judge
