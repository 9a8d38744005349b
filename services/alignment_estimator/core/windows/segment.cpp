#include "services/alignment_estimator/core/windows/segment.hpp"

#include "services/alignment_estimator/core/windows/reduced.hpp"

namespace boresight::alignment::windows {

namespace {

/// Segments of a level before the two oldest of them become one.
constexpr int kOfLevel = 8;
/// The time of a load step is not known better.
constexpr double kUnsure_s = 1.0;

}  // namespace

void add_to(Share& sum, const Point& point, const LocalVector& score, const LocalMatrix& information, double seconds) {
  if (sum.seconds <= 0.0) {
    sum.point = point;
    sum.score = score;
    sum.information = information;
  } else {
    // s·d at `point` is s + L·(point − sum.point) at the other.
    sum.score.noalias() += information * difference(sum.point, point);
    sum.score += score;
    sum.information += information;
  }
  sum.seconds += seconds;
  sum.positive = false;
}

void Segments::begin(int load, const MergeNoise& noise) {
  if (size_ == kMaxSegments) merge(noise);
  segments_[static_cast<std::size_t>(size_)] = Segment{0.0, 0.0, 0, load};
  for (std::size_t r = 0; r < radars_; ++r) share(size_, r) = Share();
  ++size_;
}

void Segments::add(std::size_t radar, const Block& block, double length_s, const MergeNoise& noise) {
  // The block's deviation from the mean of the segment. All radars share it; eliminated from each on its own, it counts
  // as often as there are radars.
  const auto radars = static_cast<double>(radars_);
  std::array<double, kFluctuations> deviation;
  for (std::size_t k = 0; k < kFluctuations; ++k) {
    const double tau_s = noise.correlation_s[k];
    deviation[k] = radars * noise.common.variance[k] *
                   std::max(share_of_mean(std::max(block.seconds, 0.1), tau_s) - share_of_mean(length_s, tau_s), 0.0);
  }
  Share part;
  part.point = block.point;
  part.score = block.score;
  part.information = block.information;
  const Reduced reduced = reduce(part, block.point, deviation);
  add_to(share(size_ - 1, radar), block.point, reduced.score, reduced.information, block.seconds);
}

void forget(Share& share, int first_column, int columns) {
  if (share.seconds <= 0.0) return;
  for (int c = first_column; c < first_column + columns; ++c) {
    const double pivot = share.information(c, c);
    if (!(pivot > 0.0)) continue;
    const LocalVector column = share.information.col(c);
    share.information.noalias() -= column * column.transpose() / pivot;
    share.score -= column * (share.score(c) / pivot);
    share.information.col(c).setZero();
    share.information.row(c).setZero();
    share.score(c) = 0.0;
  }
}

void Segments::forget(std::size_t radar, int first_column, int columns) {
  for (int i = 0; i < size_; ++i) windows::forget(share(i, radar), first_column, columns);
}

void Segments::forget_before(double time_s, int first_column, int columns) {
  for (int i = 0; i < size_; ++i) {
    if (segment(i).middle_s - 0.5 * segment(i).seconds >= time_s) break;
    for (std::size_t r = 0; r < radars_; ++r) windows::forget(share(i, r), first_column, columns);
  }
}

void Segments::add_load(double time_s) {
  for (int i = 0; i < size_; ++i) {
    Segment& of = segment(i);
    const double begin_s = of.middle_s - 0.5 * of.seconds, end_s = of.middle_s + 0.5 * of.seconds;
    if (of.middle_s > time_s) ++of.load;
    if (begin_s >= time_s + kUnsure_s || end_s <= time_s - kUnsure_s) continue;
    for (std::size_t r = 0; r < radars_; ++r) windows::forget(share(i, r), local::kRotation + 1, 1);
  }
}

void Segments::forget_first_load() {
  for (int i = 0; i < size_; ++i) {
    if (segment(i).load > 0) {
      --segment(i).load;
      continue;
    }
    for (std::size_t r = 0; r < radars_; ++r) windows::forget(share(i, r), local::kRotation + 1, 1);
  }
}

void Segments::remove_load(int load) {
  for (int i = 0; i < size_; ++i) {
    if (segment(i).load >= load) --segment(i).load;
  }
}

void Segments::drop_latest(std::size_t radar, double seconds) {
  double since = 0.0;
  for (int i = size_ - 1; i >= 0 && since < seconds; --i) {
    since += segment(i).seconds;
    share(i, radar) = Share();
  }
}

void Segments::merge(const MergeNoise& noise) {
  // The lowest level with enough segments; else the two oldest of all.
  for (int level = 0; level < 16; ++level) {
    int first = -1, count = 0;
    for (int i = 0; i + 1 < size_; ++i) {
      if (segment(i).level != level) continue;
      if (first < 0) first = i;
      ++count;
    }
    if (count > kOfLevel && segment(first + 1).level == level && segment(first + 1).load == segment(first).load) {
      join(first, noise);
      return;
    }
  }
  join(0, noise);
}

void Segments::join(int first, const MergeNoise& noise) {
  const auto radars = static_cast<double>(radars_);
  const double a_s = segment(first).seconds, b_s = segment(first + 1).seconds;
  for (const int part : {first, first + 1}) {
    const Segment& of = segment(part);
    for (std::size_t r = 0; r < radars_; ++r) {
      Share& s = share(part, r);
      if (s.seconds <= 0.0) continue;
      std::array<double, kFluctuations> deviation = own_variances(noise.own[r], of, s);
      const double roll = 0.5 * noise.roll_per_pitch * noise.roll_per_pitch * deviation[1];
      for (std::size_t k = 0; k < kFluctuations; ++k) {
        const double tau_s = noise.correlation_s[k];
        const double common = std::max(
            share_of_mean(std::max(of.seconds, 0.1), tau_s) - share_of_mean(std::max(a_s + b_s, 0.1), tau_s), 0.0);
        deviation[k] = 0.5 * deviation[k] + radars * common * noise.common.variance[k];
      }
      const Reduced reduced = reduce(s, s.point, deviation, roll);
      s.information = reduced.information;
      s.score = reduced.score;
      s.weight = 1.0;
    }
  }
  // Pitch of the body before and after a load change.
  if (segment(first).load != segment(first + 1).load) {
    for (std::size_t r = 0; r < radars_; ++r) windows::forget(share(first, r), local::kRotation + 1, 1);
  }
  Segment& into = segment(first);
  into.middle_s = (into.middle_s * a_s + segment(first + 1).middle_s * b_s) / std::max(a_s + b_s, 1e-3);
  into.seconds += segment(first + 1).seconds;
  into.level = std::max(into.level, segment(first + 1).level) + 1;
  into.load = segment(first + 1).load;
  for (std::size_t r = 0; r < radars_; ++r) {
    const Share& b = share(first + 1, r);
    if (b.seconds > 0.0) add_to(share(first, r), b.point, b.score, b.information, b.seconds);
  }
  for (int i = first + 1; i + 1 < size_; ++i) {
    segment(i) = segment(i + 1);
    for (std::size_t r = 0; r < radars_; ++r) share(i, r) = share(i + 1, r);
  }
  --size_;
}

}  // namespace boresight::alignment::windows
