#include "services/boresight/monitor/render.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace boresight::monitor {

namespace {

constexpr double kDegrees = 180.0 / 3.14159265358979323846;

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

Ink ink_of(ServiceCondition condition) {
  if (condition == ServiceCondition::kAlive) return Ink::kGood;
  if (condition == ServiceCondition::kSilent) return Ink::kBad;
  return condition == ServiceCondition::kUnknown ? Ink::kDim : Ink::kWarning;
}

bool has_estimate(const RadarSnapshot& radar) {
  return radar.state == AlignmentState::kConverging || radar.state == AlignmentState::kConverged;
}

/// "-" where nothing is estimated yet, "not observable" where the drive does not tell.
std::string angle_text(const AngleEstimate& angle, bool known) {
  if (!known) return "-";
  if (!angle.observable) return "not observable";
  return fmt::format("{:+.2f}° ± {:.2f}°", angle.value_rad * kDegrees, angle.std_rad * kDegrees);
}

std::string seconds_text(double seconds) {
  return std::isfinite(seconds) ? fmt::format("{:.1f} s", seconds) : "-";
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

/// What the sensor says of itself, and what was wrong with its scans; empty if nothing.
std::string complaint(const RadarSnapshot& radar) {
  std::string text = words_of_conditions(radar.conditions);
  const auto add = [&text](std::uint64_t count, std::string_view what) {
    if (count != 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, what);
  };
  add(radar.details.step_changes, "step_changes");
  add(radar.missed, "scans missed on the wire");
  add(radar.suspect, "suspect scans");
  return text;
}

void put_radars(Page& page, const Snapshot& snapshot) {
  // What matters most comes first: a narrow terminal cuts the end.
  page.put(fmt::format("{:<13}{:<32}{:<18}{:<17}{:>8}{:>5}{:>7}{:>6}  {:<12}{:<18}{:<18}{:>8}{:>12}", "RADAR", "HEALTH",
                       "YAW ± σ", "SPEED SCALE ± σ", "SCANS/S", "DET", "MOVING", "GHOST", "ALIGNMENT", "PITCH ± σ",
                       "ROLL ± σ", "95 %", "DRIFT/MIN"),
           Ink::kDim);
  page.line();
  for (const RadarSnapshot& r : snapshot.radars) {
    const bool known = has_estimate(r);
    page.put(fmt::format("{:<13}", r.name), Ink::kBold);
    page.put(fmt::format("{:<32}", verdict(r)), ink_of(r));
    const bool beyond = r.extended_qualifier == ExtendedQualifier::kMisaligned;
    const AlignmentDetails& d = r.details;
    page.put(fmt::format("{:<18}", angle_text(d.yaw, known)), beyond ? Ink::kBad : Ink::kPlain);
    page.put(fmt::format("{:<17}", known ? fmt::format("{:.4f} ± {:.4f}", r.speed_scale, r.speed_scale_std) : "-"));
    page.put(fmt::format("{:>8.1f}{:>5}{:>7}{:>6}  ", r.rate_hz, r.detections, r.moving, r.ghosts));
    page.put(fmt::format("{:<12}", name_of(r.state)));
    page.put(fmt::format("{:<18}{:<18}", angle_text(d.pitch, known), angle_text(d.roll, known)));
    page.put(fmt::format(
        "{:>8}{:>12}", seconds_text(d.yaw_seconds_to_95_percent),
        std::isfinite(d.yaw_drift_radpmin) ? fmt::format("{:+.3f}°", d.yaw_drift_radpmin * kDegrees) : "-"));
    page.line();
    if (const std::string text = complaint(r); !text.empty()) {
      page.put(fmt::format("{:<13}{}", "", text), Ink::kWarning);
      page.line();
    }
  }
}

/// What all radars together say of the ego signals.
void put_ego(Page& page, const Snapshot& snapshot) {
  const auto found = std::find_if(snapshot.radars.begin(), snapshot.radars.end(), has_estimate);
  page.put("EGO      ", Ink::kDim);
  if (found != snapshot.radars.end()) {
    const AngleEstimate& bias = found->details.yaw_rate_bias;
    const AngleEstimate& slip = found->details.slip;
    page.put("yaw-rate bias " +
             (bias.observable ? fmt::format("{:+.3f} ± {:.3f} °/s", bias.value_rad * kDegrees, bias.std_rad * kDegrees)
                              : "not observable"));
    page.put("   slip coefficient " + (slip.observable
                                           ? fmt::format("{:.4f} ± {:.4f} rad per m/s²", slip.value_rad, slip.std_rad)
                                           : "not observable"));
  }
  page.line();
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
  constexpr std::size_t kInALine = 3;
  std::size_t put = 0;
  for (const ServiceSnapshot& s : snapshot.services) {
    if (put++ == kInALine) {
      page.line();
      page.put("         ");
    }
    page.put(fmt::format("{} ", catalogue::name_of(s.service)));
    page.put(std::string(name_of(s.condition)), ink_of(s.condition));
    if (s.restarts > 0) page.put(fmt::format(" ({} restarts)", s.restarts), Ink::kWarning);
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
                       snapshot.ego_speed_mps, snapshot.ego_yaw_rate_radps * kDegrees));
  page.line();
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
  std::string text = fmt::format("{:5.0f} s  {:4.1f} m/s ", elapsed_s, snapshot.ego_speed_mps);
  for (const RadarSnapshot& r : snapshot.radars) {
    text += fmt::format(" | {} {:.0f}/s yaw {} {}", r.name, r.rate_hz, angle_text(r.details.yaw, has_estimate(r)),
                        verdict(r));
  }
  return text + fmt::format(" | {} tracks | latency p50 {}", number_of_confirmed(snapshot),
                            duration_text(snapshot.latencies.back().percentile_us(0.5)));
}

}  // namespace boresight::monitor
