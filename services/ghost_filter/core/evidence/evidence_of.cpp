#include "services/ghost_filter/core/evidence/evidence_of.hpp"

#include <array>
#include <cmath>

namespace boresight::ghosts {

namespace {

/// Number of edges that the value reaches.
template <std::size_t N>
std::uint8_t level(double value, const std::array<double, N>& edges) {
  std::uint8_t n = 0;
  for (const double edge : edges) n = static_cast<std::uint8_t>(n + (value >= edge ? 1 : 0));
  return n;
}

std::uint8_t ring_level(const Counts& counts, const LevelConfig& config) {
  if (counts.ring == 0) return 0;
  const double share = static_cast<double>(counts.company) / static_cast<double>(counts.company + counts.ring);
  std::uint8_t n = 1;
  for (const double edge : config.ring_share) n = static_cast<std::uint8_t>(n + (share < edge ? 1 : 0));
  return n;
}

}  // namespace

Levels levels_of(const Counts& counts, const SensorVerdict& verdict, const Expected& expected, bool has_tracks,
                 const EvidenceConfig& config) {
  const LevelConfig& c = config.levels;
  Levels out;
  const auto set = [&out](EvidenceKind kind, std::uint8_t level) { out.of[static_cast<std::size_t>(kind)] = level; };
  set(EvidenceKind::kPast, level(counts.past_scans, c.past_scans));
  set(EvidenceKind::kCompany, level(counts.company, c.company));
  set(EvidenceKind::kRing, ring_level(counts, c));
  set(EvidenceKind::kRange, level(static_cast<double>(counts.range_m), c.range_m));
  set(EvidenceKind::kWideRing, level(counts.wide_ring, c.wide_ring));
  set(EvidenceKind::kBurst, level(counts.moving, c.burst));
  set(EvidenceKind::kVerdict, static_cast<std::uint8_t>((verdict.is_doubted ? 2 : 0) + (verdict.is_ambiguous ? 1 : 0)));
  if (verdict.existence) {
    set(EvidenceKind::kExistence, static_cast<std::uint8_t>(1 + level(*verdict.existence, c.existence)));
  }
  const double all =
      expected.objects + expected.images_type1 + expected.images_type2 + config.intensity.other_intensity;
  set(EvidenceKind::kImageType1, level(expected.images_type1 / all, c.image_share));
  set(EvidenceKind::kImageType2, level(expected.images_type2 / all, c.image_share));
  out.has_tracks = has_tracks;
  constexpr double kNone = 1e-12;  // below all edges
  out.track = level(std::log10(expected.strongest + kNone), c.track_log10_intensity);
  out.sure = static_cast<float>(std::pow(expected.existence, config.intensity.certainty_power));
  return out;
}

}  // namespace boresight::ghosts
