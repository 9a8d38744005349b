#include "services/simulator/judge/detection_judge.hpp"

#include <cmath>
#include <cstdio>

#include "services/simulator/judge/truth_files.hpp"

namespace boresight::judge {

namespace {

constexpr std::array kTrueOrigins = {Provenance::kMoving,     Provenance::kStationary, Provenance::kGhostType1,
                                     Provenance::kGhostType2, Provenance::kClutter,    Provenance::kAmbiguity,
                                     Provenance::kUnknown};

/// "0.05": a probability without zeros at its end.
std::string short_number(double value) {
  std::array<char, 16> text{};
  std::snprintf(text.data(), text.size(), "%g", value);
  return text.data();
}

}  // namespace

void DetectionJudge::add_scan(std::span<const JudgedDetection> detections) {
  ++scans_;
  std::size_t false_moving = 0;
  for (const JudgedDetection& each : detections) {
    confusion_.add(each.truth, each.label, each.rejected);
    if (each.rejected) continue;
    const bool moving = each.truth == Provenance::kMoving;
    const bool labelled_moving = each.label == Provenance::kMoving;
    if (labelled_moving && !moving) ++false_moving;
    if (!each.cause.empty() && each.cause != "none") {
      auto place = causes_.find(each.cause);
      if (place == causes_.end()) place = causes_.emplace(std::string(each.cause), CauseCount{}).first;
      ++place->second.all;
      place->second.moving += labelled_moving ? 1 : 0;
    }
    if (std::isnan(each.p_moving)) continue;
    reliability_.add(each.p_moving, moving);
    moving_with_probability_ += moving ? 1 : 0;
  }
  if (scans_by_false_moving_.size() <= false_moving) scans_by_false_moving_.resize(false_moving + 1);
  ++scans_by_false_moving_[false_moving];
}

void DetectionJudge::write(FigureList& figures) const {
  const auto number = [](std::uint64_t value) { return static_cast<double>(value); };
  figures.add("detections.scans", number(scans_));
  const auto count = [&](std::uint64_t value) { return scans_ > 0 ? number(value) : kNaN; };
  std::uint64_t labelled_moving = 0;
  for (const Provenance truth : kTrueOrigins) {
    const std::string name = "detections.confusion." + std::string(table_word(truth)) + ".";
    for (const Provenance label : kTrueOrigins) {
      figures.add(name + std::string(table_word(label)), count(confusion_.count(truth, label)));
    }
    figures.add(name + "rejected", count(confusion_.rejected(truth)));
    labelled_moving += confusion_.count(truth, Provenance::kMoving);
  }
  for (const auto& [cause, counts] : causes_) {
    figures.add("detections.cause." + cause + ".count", number(counts.all));
    figures.add("detections.cause." + cause + ".moving", number(counts.moving));
  }
  const std::uint64_t right = confusion_.count(Provenance::kMoving, Provenance::kMoving);
  const std::uint64_t rejected = confusion_.rejected(Provenance::kMoving);
  const double moving = number(confusion_.count(Provenance::kMoving) + rejected);
  figures.add("detections.moving_that_is_moving_share", share_of(number(right), number(labelled_moving)));
  figures.add("detections.moving_lost_share", share_of(moving - number(right), moving));
  figures.add("detections.moving_rejected_share", share_of(number(rejected), moving));
  figures.add("detections.false_moving_per_scan", share_of(number(labelled_moving - right), number(scans_)));
  double p90 = kNaN;
  std::uint64_t scans = 0;
  for (std::size_t n = 0; n < scans_by_false_moving_.size() && std::isnan(p90); ++n) {
    scans += scans_by_false_moving_[n];
    if (10 * scans >= 9 * scans_) p90 = static_cast<double>(n);
  }
  figures.add("detections.false_moving_per_scan_p90", p90);
  const double with_probability = number(reliability_.count());
  const double base = share_of(number(moving_with_probability_), with_probability);
  figures.add("detections.brier", with_probability > 0.0 ? reliability_.brier_score() : kNaN);
  // Of a filter that gives every detection the share of moving ones.
  figures.add("detections.brier_of_base_rate", base * (1.0 - base));
  figures.add("detections.calibration_error", with_probability > 0.0 ? reliability_.calibration_error() : kNaN);
  for (std::size_t i = 0; i < Reliability::kBins; ++i) {
    const Reliability::Bin& bin = reliability_.bins()[i];
    const std::string name = "detections.reliability." + short_number(Reliability::kEdges[i]) + "_" +
                             short_number(Reliability::kEdges[i + 1]) + ".";
    figures.add(name + "count", count(bin.count));
    figures.add(name + "mean_probability", bin.count > 0 ? bin.mean_probability() : kNaN);
    figures.add(name + "moving_share", bin.count > 0 ? bin.share() : kNaN);
  }
}

}  // namespace boresight::judge
