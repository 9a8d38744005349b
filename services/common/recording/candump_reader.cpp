#include "services/common/recording/candump_reader.hpp"

#include <cstring>
#include <vector>

namespace boresight::recording {

CandumpReader::CandumpReader(std::unique_ptr<ByteSource> source, OnProblem on_problem)
    : source_(std::move(source)), on_problem_(std::move(on_problem)), lines_(*source_, kMaxCandumpLine) {}

void CandumpReader::problem(std::string_view text) {
  ++counts_.problems;
  on_problem_(source_->name() + ":" + std::to_string(number_) + ": " + std::string(text));
}

bool CandumpReader::next(Frame& frame) {
  std::string_view text;
  while (lines_.next(text)) {
    ++number_;
    const CandumpResult result = parse_candump_line(text, line_);
    if (result == CandumpResult::kErrorFrame) ++counts_.error_frames;
    if (is_problem(result)) problem(describe(result));
    if (line_.stamp == CandumpStamp::kRelative && !relative_known_) {
      relative_known_ = true;
      deltas_ = are_intervals(std::string(text) + "\n" + std::string(lines_.peek()));
    }
    // An interval counts even if its frame cannot be decoded.
    if (line_.stamp == CandumpStamp::kRelative && deltas_) line_.frame.stamp_ns = sum_ns_ += line_.frame.stamp_ns;
    if (result != CandumpResult::kFrame) continue;
    if (line_.frame.stamp_ns < last_stamp_ns_) ++counts_.backwards;
    last_stamp_ns_ = line_.frame.stamp_ns;
    ++counts_.frames;
    frame = line_.frame;
    return true;
  }
  if (lines_.error() != 0 && !ended_) {
    ended_ = true;
    ++number_;
    problem(std::string("cannot be read further: ") + std::strerror(lines_.error()));
  }
  return false;
}

bool are_intervals(std::string_view text) {
  constexpr std::size_t kMaxStamps = 1000;
  std::vector<std::int64_t> stamps_ns;
  CandumpLine line;
  while (stamps_ns.size() < kMaxStamps) {
    const std::size_t end = text.find('\n');
    if (end == std::string_view::npos) break;
    static_cast<void>(parse_candump_line(text.substr(0, end), line));
    text.remove_prefix(end + 1);
    if (line.stamp == CandumpStamp::kRelative) stamps_ns.push_back(line.frame.stamp_ns);
  }
  const std::size_t half = stamps_ns.size() / 2;
  const std::size_t pairs = stamps_ns.size() - half;
  std::size_t later = 0;
  for (std::size_t i = 0; i < pairs && half > 0; ++i) later += stamps_ns[i + half] > stamps_ns[i] ? 1 : 0;
  return half > 0 && 4 * later < 3 * pairs;
}

}  // namespace boresight::recording
