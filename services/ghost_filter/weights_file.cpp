#include "services/ghost_filter/weights_file.hpp"

#include <algorithm>
#include <span>
#include <string_view>
#include <vector>

namespace boresight::ghosts {

namespace {

constexpr config::Range kLogOdds{-50.0, 50.0};

void read_list(config::Reader& reader, std::string_view key, std::span<double> weights) {
  reader.require(key);
  const std::vector<double> read = reader.numbers(key, weights.size(), kLogOdds, {weights.begin(), weights.end()});
  std::copy(read.begin(), read.end(), weights.begin());
}

void read_level_weights(config::Reader& reader, std::size_t kinds, LevelWeights& weights) {
  reader.require("constant");
  weights.constant = reader.number("constant", kLogOdds, 0.0);
  for (std::size_t k = 0; k < kinds; ++k) {
    read_list(reader, kEvidenceSpecs[k].key, std::span(weights.of[k]).first(kEvidenceSpecs[k].levels));
  }
}

}  // namespace

EvidenceWeights read_weights(config::Reader profile) {
  EvidenceWeights w;
  profile.require("evidence");
  if (profile.has("evidence")) {
    config::Reader table = profile.table("evidence");
    table.require("origin");
    static_cast<void>(table.text("origin", ""));
    table.require("prior_log_odds");
    w.prior_log_odds = table.number("prior_log_odds", kLogOdds, 0.0);
    config::Reader alone = table.table("alone");
    read_level_weights(alone, kScanEvidences, w.alone);
    config::Reader ratio = table.table("ratio");
    read_level_weights(ratio, kEvidences, w.ratio);
    config::Reader with_tracks = table.table("with_tracks");
    read_level_weights(with_tracks, kEvidences, w.with_tracks);
    read_list(with_tracks, "track_unsure", w.track_unsure);
    read_list(with_tracks, "track_sure", w.track_sure);
  }
  profile.skip_others();
  profile.finish();
  return w;
}

EvidenceWeights read_weights(const std::filesystem::path& profile) {
  return read_weights(config::Reader::open(profile));
}

}  // namespace boresight::ghosts
