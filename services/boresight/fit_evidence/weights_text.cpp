#include "services/boresight/fit_evidence/weights_text.hpp"

#include <cstdint>
#include <span>

#include <fmt/format.h>

#include "services/common/runtime/config/reader.hpp"
#include "services/ghost_filter/weights_file.hpp"

namespace boresight::fit_evidence {

using namespace ghosts;

namespace {

std::string list(std::string_view key, std::span<const double> weights) {
  std::string text = fmt::format("{} = [", key);
  for (std::size_t i = 0; i < weights.size(); ++i) text += fmt::format("{}{:.2f}", i == 0 ? "" : ", ", weights[i]);
  return text + "]\n";
}

std::string level_weights_text(const LevelWeights& weights, std::size_t kinds) {
  std::string text = fmt::format("constant = {:.2f}\n", weights.constant);
  for (std::size_t k = 0; k < kinds; ++k) {
    text += list(kEvidenceSpecs[k].key, std::span(weights.of[k]).first(kEvidenceSpecs[k].levels));
  }
  return text;
}

/// A TOML string: quotes and backslashes escaped, control characters replaced.
std::string toml_string(std::string_view text) {
  constexpr char kDelete = 0x7F;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += (static_cast<unsigned char>(c) < ' ' || c == kDelete) ? '?' : c;
  }
  return out + "\"";
}

enum class Line : std::uint8_t { kEvidence, kOtherTable, kKey, kNoKey };

Line kind_of(std::string_view line) {
  const std::size_t first = line.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos || line[first] == '#') return Line::kNoKey;
  if (line[first] != '[') return Line::kKey;
  const std::size_t name = line.find_first_not_of("[ \t", first);
  constexpr std::string_view kTable = "evidence";
  if (name == std::string_view::npos || line.substr(name, kTable.size()) != kTable) return Line::kOtherTable;
  const std::size_t end = line.find_first_not_of(" \t", name + kTable.size());
  const bool is_table = end != std::string_view::npos && (line[end] == ']' || line[end] == '.');
  return is_table ? Line::kEvidence : Line::kOtherTable;
}

}  // namespace

std::string weights_text(const EvidenceWeights& weights, const std::string& origin) {
  return "[evidence]\n" + fmt::format("origin = {}\n", toml_string(origin)) +
         fmt::format("prior_log_odds = {:.2f}\n", weights.prior_log_odds) + "\n[evidence.alone]\n" +
         level_weights_text(weights.alone, kScanEvidences) + "\n[evidence.ratio]\n" +
         level_weights_text(weights.ratio, kEvidences) + "\n[evidence.with_tracks]\n" +
         level_weights_text(weights.with_tracks, kEvidences) + list("track_unsure", weights.track_unsure) +
         list("track_sure", weights.track_sure);
}

std::string with_weights(std::string_view profile, std::string_view weights, std::string_view name) {
  std::string text, loose;  // loose: blank lines and comments behind the last key of the old table
  bool is_old = false, is_placed = false;
  while (!profile.empty()) {
    const std::size_t length = std::min(profile.find('\n'), profile.size() - 1) + 1;
    const std::string_view line = profile.substr(0, length);
    profile.remove_prefix(length);
    const Line kind = kind_of(line);
    if (kind == Line::kEvidence) {
      if (!is_placed) text += weights;
      is_old = is_placed = true;
    } else if (kind == Line::kOtherTable && is_old) {
      // Comments directly above a table are its own.
      text += loose;
      is_old = false;
    }
    if (!is_old) {
      text += line;
    } else if (kind == Line::kNoKey) {
      loose += line;
    }
    if (kind != Line::kNoKey) loose.clear();
  }
  if (!is_placed) {
    if (!text.empty() && !text.ends_with('\n')) text += '\n';
    text += "\n# Weights of the evidence\n";
    text += weights;
  }
  const auto read = [&](std::string_view from) { return read_weights(config::Reader::parse(from, name)); };
  constexpr std::string_view kAny = "any";  // two texts of the same weights are the same
  if (weights_text(read(text), std::string(kAny)) != weights_text(read(weights), std::string(kAny))) {
    throw config::Error(std::string(name) + ": the table [evidence] cannot be replaced");
  }
  return text;
}

}  // namespace boresight::fit_evidence
