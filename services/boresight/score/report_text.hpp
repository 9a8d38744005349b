// A score as text, JSON and JUnit XML.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "services/boresight/score/score.hpp"

namespace boresight::score {

/// A score with the run it belongs to.
struct NamedScore {
  std::string run;
  Score score;
};

/// The largest allowed value of a figure.
struct Limit {
  std::string figure;
  double most = 0.0;
};

/// Reads "NAME=MAX"; throws std::invalid_argument.
[[nodiscard]] Limit limit_of(const std::string& text);

/// All tables of one run.
[[nodiscard]] std::string to_text(const NamedScore& score);
/// The main figures of several runs side by side.
[[nodiscard]] std::string to_comparison(const std::vector<NamedScore>& scores);
/// Every figure; null where there is no data.
[[nodiscard]] std::string to_json(const std::vector<NamedScore>& scores, const std::string& truth,
                                  const std::string& version);
/// One test case for each limit and run. A figure without data fails its limit.
[[nodiscard]] std::string to_junit(const std::vector<NamedScore>& scores, const std::vector<Limit>& limits);

/// Whether a figure is at most its limit; false without data.
[[nodiscard]] bool is_kept(const Limit& limit, const Score& score);

}  // namespace boresight::score
