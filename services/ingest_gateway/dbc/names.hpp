// Names of signals and messages in mapping files: patterns with an index.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace boresight::ingest::dbc {

/// `pattern` with "{}" replaced by the index, or "{:03}" by the index padded with zeros to three digits (1 … 9).
/// Without braces it is the name itself. Nothing if there are other braces.
[[nodiscard]] std::optional<std::string> expand(std::string_view pattern, unsigned index);

}  // namespace boresight::ingest::dbc
