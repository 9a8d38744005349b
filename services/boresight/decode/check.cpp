#include "services/boresight/decode/check.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>

#include "services/boresight/decode/csv.hpp"

namespace boresight::decode {

namespace {

constexpr double kFirstEdge_s = 1e-5;
constexpr double kBinRatio = 1.05;
constexpr double kGapFactor = 2.5;
constexpr std::size_t kMaxReasons = 32;

/// Reasons that differ only in their numbers count as one reason.
std::string without_numbers(std::string_view text) {
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  std::string plain;
  for (std::size_t i = 0; i < text.size(); ++i) {
    // A digit within a word, as in ARS548, belongs to the word.
    const bool in_word = i > 0 && std::isalnum(static_cast<unsigned char>(text[i - 1])) != 0;
    if (!is_digit(text[i]) || in_word) {
      plain += text[i];
      continue;
    }
    plain += '#';
    while (i + 1 < text.size() &&
           (is_digit(text[i + 1]) || (text[i + 1] == '.' && i + 2 < text.size() && is_digit(text[i + 2])))) {
      ++i;
    }
  }
  return plain;
}

std::string_view name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kSound:
      return "SOUND";
    case Verdict::kDamaged:
      return "DAMAGED";
    case Verdict::kAbsent:
      return "ABSENT";
  }
  return "DAMAGED";
}

}  // namespace

double Intervals::lower_edge_s(std::size_t bin) {
  return bin == 0 ? 0.0 : kFirstEdge_s * std::pow(kBinRatio, static_cast<double>(bin - 1));
}

void Intervals::add(std::int64_t interval_ns) {
  const double interval_s = static_cast<double>(std::max<std::int64_t>(interval_ns, 0)) * 1e-9;
  const double bin = interval_s < kFirstEdge_s ? 0.0 : 1.0 + std::log(interval_s / kFirstEdge_s) / std::log(kBinRatio);
  ++bins_[std::min(static_cast<std::size_t>(bin), kBins - 1)];
  ++count_;
}

double Intervals::median_s() const {
  std::uint64_t below = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) {
    below += bins_[bin];
    if (2 * below >= count_ && below > 0) return lower_edge_s(bin) * std::sqrt(kBinRatio);
  }
  return 0.0;
}

std::uint64_t Intervals::longer_than(double seconds) const {
  std::uint64_t longer = 0;
  for (std::size_t bin = 0; bin < kBins; ++bin) longer += lower_edge_s(bin) > seconds ? bins_[bin] : 0;
  return longer;
}

void Check::add_source(std::uint32_t id, std::string name) {
  sources_[id].name = std::move(name);
}

void Check::take_scan(std::uint32_t id, const RadarScan& scan, const ingest::MeasurementTime& time) {
  SourceFindings& f = sources_[id];
  const bool incomplete = (scan.integrity & scan_integrity::kIncomplete) != 0;
  if (f.scans == 0) {
    f.first_ns = time.time_ns;
    f.first_is_incomplete = incomplete;
  } else {
    f.intervals.add(time.time_ns - f.last_ns);
    f.backwards += time.time_ns < f.last_ns ? 1 : 0;
  }
  f.last_is_incomplete = incomplete;
  f.last_ns = time.time_ns;
  ++f.scans;
  f.detections += scan.number_of_valid_detections;
  f.dropped_detections += scan.dropped_detections;
  for (std::size_t bit = 0; bit < f.integrity.size(); ++bit) f.integrity[bit] += scan.integrity >> bit & 1u;
}

void Check::take_ego(const ingest::MeasurementTime& time) {
  SourceFindings& f = sources_[0];
  if (f.scans == 0) {
    f.first_ns = time.time_ns;
  } else {
    f.intervals.add(time.time_ns - f.last_ns);
    f.backwards += time.time_ns < f.last_ns ? 1 : 0;
  }
  f.last_ns = time.time_ns;
  ++f.scans;
}

void Check::take_fault(std::uint32_t id, Fault fault, std::string_view what) {
  SourceFindings& f = sources_[id];
  const bool is_note = fault == Fault::kTimeJump;
  f.rejected += is_note ? 0 : 1;
  auto& reasons = is_note ? f.noted_by_reason : f.rejected_by_reason;
  std::string reason = without_numbers(what);
  if (reasons.size() >= kMaxReasons && !reasons.contains(reason)) reason = "other reasons";
  ++reasons[reason];
}

std::uint64_t Check::gaps(const SourceFindings& findings) {
  constexpr std::uint64_t kEnough = 5;  // for a median to mean something
  return findings.intervals.count() < kEnough
             ? 0
             : findings.intervals.longer_than(kGapFactor * findings.intervals.median_s());
}

Verdict Check::judge(const SourceFindings& f, const SourceStatistics& statistics) {
  if (f.scans == 0) return f.rejected == 0 ? Verdict::kAbsent : Verdict::kDamaged;
  const auto count = [&](std::uint16_t bit) {
    for (std::size_t i = 0; i < f.integrity.size(); ++i) {
      if (bit >> i == 1) return f.integrity[i];
    }
    return std::uint64_t{0};
  };
  const std::uint64_t at_the_ends = (f.first_is_incomplete ? 1u : 0u) + (f.last_is_incomplete && f.scans > 1 ? 1u : 0u);
  const std::uint64_t allowed = f.scans / 100;
  const bool damaged = f.rejected > 0 || f.dropped_detections > 0 || f.backwards > 0 || statistics.lost > 0 ||
                       gaps(f) > 0 || count(scan_integrity::kIncomplete) > at_the_ends ||
                       count(scan_integrity::kCounterGap) > 0 || count(scan_integrity::kRepeated) > 0 ||
                       count(scan_integrity::kFrozen) > 0 || count(scan_integrity::kStale) > 0 ||
                       count(scan_integrity::kImpossibleCopies) > 0 || count(scan_integrity::kImplausible) > allowed ||
                       count(scan_integrity::kContradictsEgo) > allowed;
  return damaged ? Verdict::kDamaged : Verdict::kSound;
}

std::string Check::report(const std::array<SourceStatistics, kMaxRadars + 1>& statistics,
                          const recording::Counts& counts, bool& damaged) const {
  damaged = counts.problems > 0;
  bool anything = false;
  std::string text = fmt::format(
      "recording: {} frames, {} unreadable, {} with a stamp before the previous one, {} CAN error "
      "frames, {} packets of other protocols\n",
      counts.frames, counts.problems, counts.backwards, counts.error_frames, counts.ignored);
  for (const auto& [id, f] : sources_) {
    const SourceStatistics& s = statistics[std::min<std::size_t>(id, kMaxRadars)];
    const Verdict verdict = judge(f, s);
    damaged = damaged || verdict == Verdict::kDamaged;
    anything = anything || (verdict != Verdict::kAbsent);
    if (id == 0) {
      text += fmt::format("ego: {}, {} motions", name_of(verdict), f.scans);
    } else {
      text +=
          fmt::format("radar {} {}: {}, {} scans, {} detections", id, f.name, name_of(verdict), f.scans, f.detections);
    }
    if (f.scans > 1) {
      text += fmt::format(", {:.3f} s, about every {:.0f} ms", static_cast<double>(f.last_ns - f.first_ns) * 1e-9,
                          f.intervals.median_s() * 1e3);
    }
    text += '\n';
    const auto line = [&](std::uint64_t count, std::string_view what) {
      if (count > 0) text += fmt::format("  {} {}\n", count, what);
    };
    line(gaps(f), id == 0 ? "gaps in time" : "gaps in time: scans are missing");
    line(s.lost, "scans lost by the sensor's counter");
    line(f.backwards, "measured before the previous one");
    line(f.dropped_detections, "detections beyond the capacity of a scan");
    for (std::size_t bit = 0; bit < f.integrity.size(); ++bit) {
      line(f.integrity[bit], "scans: " + integrity_names(static_cast<std::uint16_t>(1u << bit)));
    }
    for (const auto& [reason, count] : f.rejected_by_reason) line(count, "rejected: " + reason);
    for (const auto& [reason, count] : f.noted_by_reason) line(count, "noted: " + reason);
  }
  damaged = damaged || !anything;
  text += damaged ? (anything ? "DAMAGED\n" : "DAMAGED: no message of any source\n") : "SOUND\n";
  return text;
}

}  // namespace boresight::decode
