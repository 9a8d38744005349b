// Names in mapping files: patterns with an index, and what may have been meant by a name that is not there.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boresight::ingest::dbc {

/// `pattern` with "{}" replaced by the index, or "{:03}" by the index padded with zeros to three digits (1 … 9).
/// Without braces it is the name itself. Nothing if there are other braces.
[[nodiscard]] std::optional<std::string> expand(std::string_view pattern, unsigned index);

/// Up to three of the candidates that differ least from the name, the nearest first; none that differs in over half.
/// Case does not count.
[[nodiscard]] std::vector<std::string> near_names(std::string_view name, const std::vector<std::string>& candidates);

}  // namespace boresight::ingest::dbc
