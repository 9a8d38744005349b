#include "services/boresight/score/detection_truth.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "interfaces/messages/header.hpp"
#include "services/simulator/judge/truth_files.hpp"

namespace boresight::score {

namespace {

constexpr double kLatestScan_s = 4e9;

std::optional<Provenance> provenance_of(std::string_view word) {
  for (std::size_t i = 0; i < kNumberOfProvenances; ++i) {
    if (judge::table_word(static_cast<Provenance>(i)) == word) return static_cast<Provenance>(i);
  }
  return std::nullopt;
}

std::vector<std::string_view> columns_of_origins(bool is_labels) {
  if (is_labels) return {"t_s", "radar", "index", "object", "class"};
  return {"t_s", "radar", "scan", "index", "provenance"};
}

}  // namespace

DetectionTruth::DetectionTruth(const std::filesystem::path& file, bool is_labels)
    : table_(file, columns_of_origins(is_labels)), is_labels_(is_labels) {
  has_row_ = table_.next();
}

void DetectionTruth::take_row(double t_s) {
  const auto radar = static_cast<std::uint32_t>(table_.integer("radar", 1, kMaxRadars));
  const auto index = static_cast<std::size_t>(table_.integer("index", 0, kMaxDetections - 1));
  TrueOrigin origin;
  if (has_objects()) {
    origin.object = static_cast<std::uint32_t>(table_.integer("object", 0, std::numeric_limits<std::uint32_t>::max()));
  }
  std::uint64_t scan = 0;
  if (is_labels_) {
    origin.provenance = provenance_of(table_.text("class")).value_or(Provenance::kUnknown);
    if (origin.object != 0 && origin.provenance == Provenance::kUnknown) origin.provenance = Provenance::kMoving;
  } else {
    scan = static_cast<std::uint64_t>(table_.integer("scan", 1, std::numeric_limits<std::int64_t>::max()));
    const std::optional<Provenance> provenance = provenance_of(table_.text("provenance"));
    if (!provenance) table_.refuse("provenance", "moving, stationary, ghost_type_1, ghost_type_2, clutter, ambiguity");
    origin.provenance = *provenance;
    const std::string_view cause = table_.text("cause");
    if (!cause.empty()) origin.cause = *causes_.emplace(cause).first;
  }
  std::deque<TrueScan>& scans = scans_[radar];
  if (scans.empty() || scans.back().t_s != t_s || scans.back().scan != scan) scans.push_back({t_s, scan, {}});
  std::vector<TrueOrigin>& origins = scans.back().origins;
  if (is_labels_) {
    if (origins.size() <= index) origins.resize(index + 1);
    origins[index] = origin;
  } else {
    if (index != origins.size()) table_.refuse("index", "the next one of the scan");
    origins.push_back(origin);
  }
}

void DetectionTruth::read_until(double t_s) {
  while (has_row_) {
    const double row_s = table_.number("t_s", -kLatestScan_s, kLatestScan_s);
    if (row_s > t_s) return;
    take_row(row_s);
    has_row_ = table_.next();
  }
}

const std::vector<TrueOrigin>* DetectionTruth::find(std::uint32_t radar, double t_s, std::uint64_t scan,
                                                    std::size_t detections) {
  read_until(t_s + kAhead_s);
  for (auto& [id, scans] : scans_) {
    while (!scans.empty() && scans.front().t_s < t_s - kBack_s) scans.pop_front();
  }
  const std::deque<TrueScan>& scans = scans_[radar];
  const auto fits = [&](const TrueScan& each) {
    return is_labels_ ? each.origins.size() <= detections : each.origins.size() == detections;
  };
  const TrueScan* best = nullptr;
  for (const TrueScan& each : scans) {
    if (std::abs(each.t_s - t_s) > kSameTime_s || !fits(each)) continue;
    if (best == nullptr || std::abs(each.t_s - t_s) < std::abs(best->t_s - t_s)) best = &each;
  }
  if (best == nullptr && !is_labels_) {
    const auto same = std::find_if(scans.begin(), scans.end(), [&](const TrueScan& s) { return s.scan == scan; });
    if (same != scans.end() && fits(*same)) best = &*same;
  }
  return best == nullptr ? nullptr : &best->origins;
}

}  // namespace boresight::score
