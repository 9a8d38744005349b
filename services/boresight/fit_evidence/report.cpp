#include "services/boresight/fit_evidence/report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "services/boresight/json/text.hpp"
#include "services/common/text/columns.hpp"
#include "services/common/text/measured.hpp"

namespace boresight::fit_evidence {

namespace {

constexpr std::array<const char*, kLanes> kLaneKeys = {"without_tracks", "perfect_tracks", "chain"};

double share_of(std::size_t part, std::size_t all) {
  return all == 0 ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(part) / static_cast<double>(all);
}

std::string percent(std::size_t part, std::size_t all) {
  return text::fixed(100.0 * share_of(part, all), 1, " % real");
}

std::string score(double value) {
  constexpr std::size_t kWidth = 11;
  const std::string cell = text::fixed(value, 3);
  const std::size_t used = text::columns(cell);
  return std::string(used < kWidth ? kWidth - used : 1, ' ') + cell;
}

json::Value to_json(const Scores& scores) {
  return {{"brier", scores.brier()}, {"log_loss", scores.log_loss()}};
}

}  // namespace

std::string origin_of(const Fit& fit, const std::vector<FittedDrive>& drives) {
  std::string names;
  for (const FittedDrive& drive : drives) {
    names += (names.empty() ? "" : ", ") + drive.name;
    if (!drive.seed.empty()) names += fmt::format(" (seed {})", drive.seed);
  }
  return fmt::format("boresight fit-evidence: {}; {} moving detections", names, fit.detections);
}

std::string to_text(const Fit& fit, const std::vector<FittedDrive>& drives) {
  std::string text =
      fmt::format("{} {}: {} moving detections, {}\n", drives.size(), drives.size() == 1 ? "drive" : "drives",
                  text::grouped(fit.detections), percent(fit.real_detections, fit.detections));
  std::size_t width = 0;
  for (const FittedDrive& drive : drives) width = std::max(width, text::columns(drive.name) + 2);
  for (const FittedDrive& drive : drives) {
    text += fmt::format("  {}{:>9} moving detections, {}", text::padded(drive.name, width),
                        text::grouped(drive.detections), percent(drive.real_detections, drive.detections));
    if (!drive.has_objects) text += ", no true objects";
    if (drive.scans_without_truth > 0) {
      text += fmt::format(", {} of {} scans without truth", drive.scans_without_truth, drive.moving_scans);
    }
    text += "\n";
  }
  text += fmt::format("\n{:16}{:>33}{:>36}\n{:16}", "", "Brier score", "log loss", "");
  for (int i = 0; i < 2; ++i)
    text += fmt::format("{}{:>11}{:>11}{:>11}", i == 0 ? "" : "   ", "base rate", "start", "fitted");
  text += "\n";
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const LaneScores& s = fit.scores[lane];
    text += text::padded(kLaneNames[lane], 16);
    for (const Scores* each : {&s.base_rate, &s.start, &s.fitted}) text += score(each->brier());
    text += "   ";
    for (const Scores* each : {&s.base_rate, &s.start, &s.fitted}) text += score(each->log_loss());
    text += "\n";
  }
  text += fit.judges_other_drives
              ? "fitted: each drive is judged by weights fitted on the other drives\n"
              : "fitted: judged on the fitted drive itself; give two or more drives for a score of other drives\n";
  return text;
}

std::string to_json(const Fit& fit, const std::vector<FittedDrive>& drives, const std::string& profile,
                    const std::string& version) {
  json::Value of_drives = json::Value::array();
  for (const FittedDrive& drive : drives) {
    of_drives.push_back({{"folder", drive.folder},
                         {"scans_with_moving_detections", drive.moving_scans},
                         {"scans_without_truth", drive.scans_without_truth},
                         {"moving_detections", drive.detections},
                         {"real_share", share_of(drive.real_detections, drive.detections)},
                         {"has_objects", drive.has_objects}});
  }
  json::Value lanes = json::Value::object();
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    const LaneScores& s = fit.scores[lane];
    lanes[kLaneKeys[lane]] = {{"base_rate", to_json(s.base_rate)},
                              {"start", to_json(s.start)},
                              {"fitted", to_json(s.fitted)},
                              {"detections", s.fitted.detections()}};
  }
  const json::Value document = {{"tool", "boresight fit-evidence"},
                                {"version", version},
                                {"format", 1},
                                {"start", profile},
                                {"origin", origin_of(fit, drives)},
                                {"moving_detections", fit.detections},
                                {"real_share", share_of(fit.real_detections, fit.detections)},
                                {"judges_other_drives", fit.judges_other_drives},
                                {"drives", std::move(of_drives)},
                                {"lanes", std::move(lanes)}};
  return json::document(document);
}

}  // namespace boresight::fit_evidence
