// Tracks of radar drives: age, confirmation, box and covariance in vehicle axes.
#pragma once

#include <cstdint>
#include <vector>

#include "services/tracker/core/fixed_table.hpp"
#include "services/tracker/core/model/radar_model.hpp"
#include "services/tracker/core/output/detectability.hpp"
#include "services/tracker/core/output/reporter.hpp"

namespace boresight::tracking {

struct ReportParameters {
  double confirmed_existence = 0.9;   ///< from here on a track's status is confirmed
  double hold_log_odds_per_s = 25.0;  ///< the log odds that decide the status fall no faster
  double least_existence = 0.02;      ///< tracks below it are not published
  double stopped_speed_mps = 0.5;     ///< below it a track is reported as stopped
  DetectabilityParameters flags;
};

class TrackReporter final : public Reporter {
 public:
  TrackReporter(const RadarModel& model, const ReportParameters& parameters, std::size_t max_objects);

  void clear() override;
  void take(std::span<const ObjectEstimate> objects, double elapsed_s) override;
  void write(TrackList& out) const override;

 private:
  /// What is known of a track beside its state.
  struct Record {
    std::uint32_t id = 0;
    double age_s = 0.0, since_detection_s = 0.0;
    double held_log_odds = 0.0;
    Detectability detectability{};
  };
  void write_track(const ObjectEstimate& object, const Record& record, Track& out) const;

  const RadarModel* model_;
  ReportParameters parameters_;
  std::vector<Record> records_, before_;
  FixedTable index_;  // of before_ by id
  RecentScans scans_;
  std::vector<Track> tracks_;
  std::uint32_t dropped_ = 0, confirmed_ = 0;
};

}  // namespace boresight::tracking
