// Reads logs and console captures of candump as frames.
#pragma once

#include <memory>

#include "services/common/recording/candump.hpp"
#include "services/common/recording/line_reader.hpp"
#include "services/common/recording/reader.hpp"

namespace boresight::recording {

class CandumpReader : public Reader {
 public:
  CandumpReader(std::unique_ptr<ByteSource> source, OnProblem on_problem);

  [[nodiscard]] bool next(Frame& frame) override;
  [[nodiscard]] Counts counts() const override { return counts_; }
  [[nodiscard]] Progress progress() const override { return {lines_.position(), source_->total()}; }

 private:
  void problem(std::string_view text);

  std::unique_ptr<ByteSource> source_;
  OnProblem on_problem_;
  LineReader lines_;
  CandumpLine line_;
  std::uint64_t number_ = 0;
  Counts counts_;
  std::int64_t last_stamp_ns_ = 0;
  bool relative_known_ = false;
  bool deltas_ = false;  ///< relative stamps count from the previous frame, not from the first
  std::int64_t sum_ns_ = 0;
  bool ended_ = false;
};

/// True if relative stamps at the beginning of `text` are those of `candump -td`, not -tz. Two stamps half the text
/// apart are compared: the second is always larger if stamps count from the first frame, but often not if they are
/// intervals.
[[nodiscard]] bool are_intervals(std::string_view text);

}  // namespace boresight::recording
