#include "services/boresight/monitor/render.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "services/common/geometry/angles.hpp"
#include "services/common/text/columns.hpp"
#include "services/common/text/measured.hpp"
#include "services/common/text/printable.hpp"

namespace boresight::monitor {

namespace {

enum class Ink { kPlain, kBold, kDim, kGood, kWarning, kBad };

/// Collects lines of limited width; colour codes take no room.
class Page {
 public:
  explicit Page(const RenderOptions& options) : options_(options) {}

  void put(const std::string& text, Ink ink = Ink::kPlain) {
    const std::size_t room = options_.width > column_ ? options_.width - column_ : 0;
    // By characters, not bytes: the texts contain ± and °.
    std::size_t bytes = 0;
    std::size_t characters = 0;
    while (bytes < text.size() && characters < room) {
      ++bytes;
      while (bytes < text.size() && (static_cast<unsigned char>(text[bytes]) & 0xC0U) == 0x80U) ++bytes;
      ++characters;
    }
    column_ += characters;
    if (options_.colour && ink != Ink::kPlain) text_ += code(ink);
    text_.append(text, 0, bytes);
    if (options_.colour && ink != Ink::kPlain) text_ += "\x1b[0m";
  }
  void line() {
    text_ += '\n';
    column_ = 0;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  static const char* code(Ink ink) {
    switch (ink) {
      case Ink::kBold:
        return "\x1b[1m";
      case Ink::kDim:
        return "\x1b[2m";
      case Ink::kGood:
        return "\x1b[32m";
      case Ink::kWarning:
        return "\x1b[33m";
      case Ink::kBad:
        return "\x1b[1;31m";
      case Ink::kPlain:
        break;
    }
    return "";
  }
  const RenderOptions& options_;
  std::string text_;
  std::size_t column_ = 0;
};

Ink ink_of(const RadarSnapshot& radar) {
  if (radar.data_qualifier == DataQualifier::kAvailable) return Ink::kGood;
  if (radar.extended_qualifier == ExtendedQualifier::kInitialising) return Ink::kDim;
  return Ink::kBad;
}

Ink ink_of(DataQualifier qualifier) {
  if (qualifier == DataQualifier::kAvailable) return Ink::kGood;
  return qualifier == DataQualifier::kAvailableReduced ? Ink::kWarning : Ink::kBad;
}

Ink ink_of(ServiceCondition condition) {
  if (condition == ServiceCondition::kAlive) return Ink::kGood;
  if (condition == ServiceCondition::kSilent) return Ink::kBad;
  return condition == ServiceCondition::kUnknown ? Ink::kDim : Ink::kWarning;
}

bool is_estimated(const RadarSnapshot& radar) {
  return radar.state == AlignmentState::kConverging || radar.state == AlignmentState::kConverged;
}

/// A dash where nothing is estimated yet, "not observable" where the drive does not determine the angle.
std::string angle_text(const AngleEstimate& angle, bool known) {
  if (!known) return std::string(text::kUnknown);
  if (!angle.observable) return "not observable";
  return text::with_std(angle.value_rad * kDegreesPerRadian, angle.std_rad * kDegreesPerRadian, "°",
                        text::Sign::kAlways);
}

std::string direction(const TrackSnapshot& track) {
  return fmt::format("{:5.1f} m {}, {:4.1f} m {}", std::abs(track.x_m), track.x_m >= 0 ? "ahead" : "behind",
                     std::abs(track.y_m), track.y_m >= 0 ? "left" : "right");
}

std::string duration_text(double us) {
  return us >= 10'000.0 ? fmt::format("{:.0f} ms", us * 1e-3)
                        : (us >= 1000.0 ? fmt::format("{:.1f} ms", us * 1e-3) : fmt::format("{:.0f} µs", us));
}

std::size_t number_of_confirmed(const Snapshot& snapshot) {
  return static_cast<std::size_t>(
      std::count_if(snapshot.tracks.begin(), snapshot.tracks.end(), [](const auto& t) { return t.confirmed; }));
}

/// Conditions that the sensor reports, and problems of its scans; empty if there are none.
std::string complaint(const RadarSnapshot& radar) {
  std::string text = words_of_conditions(radar.conditions);
  const auto add = [&text](std::uint64_t count, std::string_view one, std::string_view several) {
    if (count != 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, count == 1 ? one : several);
  };
  add(radar.details.step_changes, "sudden misalignment", "sudden misalignments");
  add(radar.missed, "scan lost or incomplete at the gateway", "scans lost or incomplete at the gateway");
  add(radar.suspect, "scan of doubtful integrity", "scans of doubtful integrity");
  return text;
}

/// Of the column with the names of the radars; longer names widen it.
std::size_t name_columns(const Snapshot& snapshot) {
  constexpr std::size_t kLeastNameColumns = 13;
  std::size_t width = kLeastNameColumns;
  for (const RadarSnapshot& radar : snapshot.radars) width = std::max(width, text::columns(radar.name) + 1);
  return width;
}

void put_radars(Page& page, const Snapshot& snapshot) {
  const std::size_t name_width = name_columns(snapshot);
  // The most important columns come first: a narrow terminal cuts the end.
  page.put(text::padded("RADAR", name_width), Ink::kDim);
  page.put(fmt::format("{:<32}{:<19}{:<21}{:>8}{:>5}{:>7}{:>6}  {:<12}{:<19}{:<19}{:>8}{:>12}", "HEALTH", "YAW ± σ",
                       "SPEED SCALE ± σ", "SCANS/S", "DET", "MOVING", "GHOST", "ALIGNMENT", "PITCH ± σ", "ROLL ± σ",
                       "SETTLED", "DRIFT/MIN"),
           Ink::kDim);
  page.line();
  for (const RadarSnapshot& r : snapshot.radars) {
    const bool known = is_estimated(r);
    page.put(text::padded(r.name, name_width), Ink::kBold);
    page.put(fmt::format("{:<32}", verdict(r)), ink_of(r));
    const auto ink = [&r](std::size_t axis) { return r.beyond_tolerance[axis] ? Ink::kBad : Ink::kPlain; };
    const AlignmentDetails& d = r.details;
    page.put(fmt::format("{:<19}", angle_text(d.yaw, known)), ink(0));
    page.put(
        fmt::format("{:<21}", known ? text::with_std(r.speed_scale, r.speed_scale_std) : std::string(text::kUnknown)));
    page.put(fmt::format("{:>8.1f}{:>5}{:>7}{:>6}  ", r.rate_hz, r.detections, r.moving, r.ghosts));
    page.put(fmt::format("{:<12}", name_of(r.state)));
    page.put(fmt::format("{:<19}", angle_text(d.pitch, known)), ink(1));
    page.put(fmt::format("{:<19}", angle_text(d.roll, known)), ink(2));
    page.put(fmt::format("{:>8}{:>12}", text::fixed(d.yaw_seconds_to_95_percent, 1, " s"),
                         text::fixed(d.yaw_drift_radpmin * kDegreesPerRadian, 3, "°", text::Sign::kAlways)));
    page.line();
    if (const std::string text = complaint(r); !text.empty()) {
      page.put(std::string(name_width, ' ') + text, Ink::kWarning);
      page.line();
    }
    if (!r.explanation.empty()) {
      page.put(std::string(name_width, ' ') + text::printable(r.explanation),
               r.extended_qualifier == ExtendedQualifier::kNormal ? Ink::kDim : Ink::kWarning);
      page.line();
    }
  }
}

/// The verdict on the system as a whole, and on the way of the scans with its figures.
void put_health(Page& page, const Snapshot& snapshot) {
  const PipelineSnapshot& p = snapshot.pipeline;
  page.put("HEALTH   ", Ink::kDim);
  page.put(std::string(name_of(snapshot.overall)), ink_of(snapshot.overall));
  page.put("   pipeline ");
  page.put(std::string(name_of(p.data_qualifier)), ink_of(p.data_qualifier));
  const auto count = [&page](std::uint32_t number, const char* text) {
    page.put(fmt::format("   {} {}", number, text), number > 0 ? Ink::kWarning : Ink::kPlain);
  };
  count(p.lost_scans, p.lost_scans == 1 ? "scan lost" : "scans lost");
  count(p.budget_hits, "at the work budget");
  page.put(fmt::format("   queueing max {:.1f} ms   latency p99 {:.1f} ms", p.queueing_max_ms, p.latency_p99_ms));
  page.line();
  for (const FailedEvent& event : failed_events_of(p)) {
    page.put(fmt::format("         {} {}", event.code, event.meaning), Ink::kWarning);
    page.line();
  }
}

/// Errors of the ego signals, estimated with all radars.
void put_ego(Page& page, const Snapshot& snapshot) {
  const auto found = std::find_if(snapshot.radars.begin(), snapshot.radars.end(), is_estimated);
  page.put("EGO      ", Ink::kDim);
  if (found != snapshot.radars.end()) {
    const AngleEstimate& bias = found->details.yaw_rate_bias;
    const AngleEstimate& slip = found->details.slip;
    page.put("yaw-rate bias ");
    page.put(bias.observable ? text::with_std(bias.value_rad * kDegreesPerRadian, bias.std_rad * kDegreesPerRadian,
                                              " °/s", text::Sign::kAlways)
                             : "not observable");
    page.put("   slip coefficient of the rear axle ");
    page.put(slip.observable ? text::with_std(slip.value_rad, slip.std_rad, " rad per m/s²") : "not observable");
  }
  page.line();
  for (const std::string& event : {snapshot.load_change, snapshot.speed_change}) {
    if (event.empty()) continue;
    page.put("         " + text::printable(event));
    page.line();
  }
}

void put_tracks(Page& page, const Snapshot& snapshot, std::size_t limit) {
  const std::size_t confirmed = number_of_confirmed(snapshot);
  page.put("TRACKS   ", Ink::kDim);
  page.put(fmt::format("{} confirmed, {} tentative", confirmed, snapshot.tracks.size() - confirmed));
  page.line();
  std::size_t listed = 0;
  for (const TrackSnapshot& t : snapshot.tracks) {
    if (!t.confirmed || listed == limit) continue;
    ++listed;
    page.put(fmt::format("  #{:<5} {}  {:5.1f} m/s  {:<10} {:5.1f} s old", t.id, direction(t),
                         std::hypot(t.vx_mps, t.vy_mps), name_of(t.movement), t.age_s));
    page.line();
  }
  // Always as many lines, so that the picture does not jump.
  for (; listed < limit; ++listed) page.line();
}

void put_latencies(Page& page, const Snapshot& snapshot) {
  page.put("LATENCY  ", Ink::kDim);
  page.put("p50/max  ", Ink::kDim);
  for (std::size_t n = 0; n < kNumberOfLatencies; ++n) {
    const std::size_t i = (n + kNumberOfLatencies - 1) % kNumberOfLatencies;  // the total first
    const LatencyHistogram& h = snapshot.latencies[i];
    page.put(fmt::format("{} ", kLatencyNames[i]));
    page.put(duration_text(h.percentile_us(0.5)), Ink::kBold);
    page.put(fmt::format("/{}   ", duration_text(h.max_us())));
  }
  page.line();
}

void put_services(Page& page, const Snapshot& snapshot) {
  page.put("SERVICES ", Ink::kDim);
  constexpr std::size_t kInALine = 2;
  std::size_t put = 0;
  for (const ServiceSnapshot& s : snapshot.services) {
    if (put > 0 && put % kInALine == 0) {
      page.line();
      page.put("         ");
    }
    ++put;
    page.put(fmt::format("{} ", catalogue::name_of(s.service)));
    page.put(std::string(name_of(s.condition)), ink_of(s.condition));
    if (s.latency_max_us > 0.0) {
      page.put(fmt::format(" {}/{}", duration_text(s.latency_mean_us), duration_text(s.latency_max_us)), Ink::kDim);
    }
    const std::uint64_t dropped = s.count(Fault::kInputDropped), lost = s.count(Fault::kInputLost);
    if (dropped > 0) page.put(fmt::format(" ({} dropped)", dropped), Ink::kWarning);
    if (lost > 0) page.put(fmt::format(" ({} lost)", lost), Ink::kWarning);
    if (s.restarts > 0) page.put(fmt::format(" ({} restart{})", s.restarts, s.restarts == 1 ? "" : "s"), Ink::kWarning);
    page.put("  ");
  }
  page.line();
}

}  // namespace

std::string verdict(const RadarSnapshot& radar) {
  std::string text(name_of(radar.data_qualifier));
  if (radar.extended_qualifier != ExtendedQualifier::kNormal) {
    text += " (" + std::string(name_of(radar.extended_qualifier)) + ")";
  }
  return text;
}

std::string render_screen(const Snapshot& snapshot, const RenderOptions& options) {
  Page page(options);
  const auto seconds = static_cast<int>(options.elapsed_s);
  page.put("Boresight", Ink::kBold);
  page.put(fmt::format("   {:02}:{:02}   ego {:5.1f} m/s  {:+5.1f} °/s", seconds / 60, seconds % 60,
                       snapshot.ego_speed_mps, snapshot.ego_yaw_rate_radps * kDegreesPerRadian));
  page.line();
  put_health(page, snapshot);
  page.line();
  put_radars(page, snapshot);
  put_ego(page, snapshot);
  page.line();
  put_tracks(page, snapshot, options.tracks);
  page.line();
  put_latencies(page, snapshot);
  put_services(page, snapshot);
  return page.text();
}

std::string render_line(const Snapshot& snapshot, double elapsed_s) {
  std::string text = fmt::format("{:5.0f} s  {:4.1f} m/s  overall {}, pipeline {}", elapsed_s, snapshot.ego_speed_mps,
                                 name_of(snapshot.overall), name_of(snapshot.pipeline.data_qualifier));
  for (const FailedEvent& event : failed_events_of(snapshot.pipeline)) text += " " + event.code;
  for (const RadarSnapshot& r : snapshot.radars) {
    text += fmt::format(" | {} {:.0f}/s yaw {} {}", r.name, r.rate_hz, angle_text(r.details.yaw, is_estimated(r)),
                        verdict(r));
  }
  return text + fmt::format(" | {} tracks | latency p50 {}", number_of_confirmed(snapshot),
                            duration_text(snapshot.latencies.back().percentile_us(0.5)));
}

}  // namespace boresight::monitor
