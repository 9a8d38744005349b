// Track lists received by DDS, as lines for people or for programs.
#pragma once

#include <string>

#include "generated/track_list.h"

namespace boresight::diagnostics_text {

/// "12:34:56.7 demo: 12 tracks, 9 confirmed, after a scan of radar 2" and a line for each track. No line feed at the
/// end.
[[nodiscard]] std::string to_lines(const perception::TrackList& list);
/// A line with line feed: config/schema/json.md.
[[nodiscard]] std::string to_json(const perception::TrackList& list);

}  // namespace boresight::diagnostics_text
