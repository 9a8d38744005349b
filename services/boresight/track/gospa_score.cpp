#include "services/boresight/track/gospa_score.hpp"

#include <fmt/format.h>

#include "services/common/text/columns.hpp"

namespace boresight::track {

namespace {

constexpr std::size_t kBaseWidth = 14;

std::string name_of(judge::GospaBase base) {
  return base == judge::GospaBase::kSquared ? "squared (m²)" : "true (m)";
}

std::string row(std::string_view first, std::string_view base, const judge::GospaParts& parts) {
  return fmt::format("{}{}{:>9.3f}{:>15.3f}{:>9.3f}{:>9.3f}\n", text::padded(first, 6), text::padded(base, kBaseWidth),
                     parts.total(), parts.localisation, parts.missed, parts.false_tracks);
}

std::vector<judge::Ellipse> ellipses_of(const std::vector<ExtendedObject>& objects) {
  std::vector<judge::Ellipse> ellipses;
  for (const ExtendedObject& object : objects) ellipses.push_back(object.ellipse);
  return ellipses;
}

}  // namespace

judge::GospaParts GospaScore::mean() const {
  judge::GospaParts sum;
  for (const judge::GospaParts& scan : scans) sum += scan;
  if (scans.empty()) return sum;
  const auto n = static_cast<double>(scans.size());
  return {sum.localisation / n, sum.missed / n, sum.false_tracks / n};
}

GospaScore score_gospa(const ObjectsByStep& truth, const ObjectsByStep& estimates, judge::GospaBase base) {
  GospaScore score{base, {}, 0};
  judge::Gospa gospa;
  const std::vector<ExtendedObject> none;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const std::vector<ExtendedObject>& estimated = i < estimates.size() ? estimates[i] : none;
    score.scans.push_back(gospa.evaluate(ellipses_of(truth[i]), ellipses_of(estimated), base));
  }
  score.not_considered = gospa.not_considered();
  return score;
}

std::string gospa_text(std::span<const GospaScore> scores, bool per_step) {
  std::string text = fmt::format("{}{}{:>9}{:>15}{:>9}{:>9}\n", text::padded("step", 6),
                                 text::padded("base distance", kBaseWidth), "GOSPA", "localisation", "missed", "false");
  const std::size_t steps = scores.empty() ? 0 : scores.front().scans.size();
  for (std::size_t i = 0; per_step && i < steps; ++i) {
    for (const GospaScore& score : scores) text += row(std::to_string(i + 1), name_of(score.base), score.scans[i]);
  }
  for (const GospaScore& score : scores) text += row("mean", name_of(score.base), score.mean());
  return text;
}

}  // namespace boresight::track
