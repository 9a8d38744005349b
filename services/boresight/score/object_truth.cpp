#include "services/boresight/score/object_truth.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "services/common/estimation/unknown.hpp"
#include "services/simulator/judge/hidden.hpp"

namespace boresight::score {

namespace {

constexpr double kLatest_s = 4e9;
constexpr double kFarthest_m = 1e6;
constexpr double kFastest_mps = 1e3;
constexpr double kLargestAngle_rad = 1e3;
constexpr double kLargestBox_m = 1e3;
constexpr std::int64_t kLargestId = std::numeric_limits<std::uint32_t>::max();

judge::TrueObject between(const judge::TrueObject& from, const judge::TrueObject& to, double share) {
  judge::TrueObject object = from;
  object.box.position_m += share * (to.box.position_m - from.box.position_m);
  object.box.velocity_mps += share * (to.box.velocity_mps - from.box.velocity_mps);
  object.box.heading_rad += share * std::remainder(to.box.heading_rad - from.box.heading_rad, 2.0 * M_PI);
  return object;
}

std::vector<std::string_view> columns_of_objects(bool is_boxes) {
  if (is_boxes) return {"t_s", "id", "class", "x", "y", "yaw", "length", "width", "vx", "vy"};
  return {"t_s",      "object", "x_vehicle_m", "y_vehicle_m", "heading_rad", "vx_over_ground_mps", "vy_over_ground_mps",
          "length_m", "width_m"};
}

}  // namespace

Visibility::Visibility(const std::filesystem::path& file) : table_(file, {"t_s", "object", "state"}) {}

void Visibility::read_until(double t_s) {
  while (true) {
    if (!has_row_) {
      if (!table_.next()) return;
      has_row_ = true;
      row_s_ = table_.number("t_s", -kLatest_s, kLatest_s);
    }
    if (row_s_ > t_s) return;
    has_row_ = false;
    const std::string_view state = table_.text("state");
    if (state == "seen") {
      last_seen_s_[static_cast<std::uint32_t>(table_.integer("object", 0, kLargestId))] = row_s_;
    } else if (state != "occluded" && state != "outside") {
      table_.refuse("state", "seen, occluded, outside");
    }
  }
}

bool Visibility::sees(std::uint32_t object, double t_s) {
  read_until(t_s);
  const auto last = last_seen_s_.find(object);
  return last != last_seen_s_.end() && t_s - last->second <= judge::kHidden_s;
}

ObjectTruth::ObjectTruth(const std::filesystem::path& file, bool is_boxes, const std::filesystem::path& visibility)
    : table_(file, columns_of_objects(is_boxes)), is_boxes_(is_boxes), first_s_(kNaN), last_s_(kNaN) {
  if (!visibility.empty()) visibility_.emplace(visibility);
  has_row_ = table_.next();
  ended_ = !has_row_;
  if (has_row_) first_s_ = last_s_ = table_.number("t_s", -kLatest_s, kLatest_s);
}

judge::TrueObject ObjectTruth::object() const {
  const auto pick = [this](const char* of_objects, const char* of_boxes) { return is_boxes_ ? of_boxes : of_objects; };
  const auto number = [&](const char* of_objects, const char* of_boxes, double most) {
    return table_.number(pick(of_objects, of_boxes), -most, most);
  };
  judge::TrueObject object{judge::Object{}, ObjectClass::kUnknown, false, true};
  object.box.id = static_cast<std::uint32_t>(table_.integer(pick("object", "id"), 0, kLargestId));
  object.box.position_m = {number("x_vehicle_m", "x", kFarthest_m), number("y_vehicle_m", "y", kFarthest_m)};
  object.box.heading_rad = number("heading_rad", "yaw", kLargestAngle_rad);
  object.box.velocity_mps = {number("vx_over_ground_mps", "vx", kFastest_mps),
                             number("vy_over_ground_mps", "vy", kFastest_mps)};
  object.box.length_m = table_.number(pick("length_m", "length"), 0.0, kLargestBox_m);
  object.box.width_m = table_.number(pick("width_m", "width"), 0.0, kLargestBox_m);
  object.object_class = judge::class_of_word(table_.text(pick("kind", "class")));
  object.parked = table_.has("parked") ? table_.integer("parked", 0, 1) == 1
                                       : is_boxes_ && object.box.velocity_mps.norm() < kSlowestMoving_mps;
  return object;
}

void ObjectTruth::read_until(double t_s) {
  while (has_row_) {
    const double row_s = table_.number("t_s", -kLatest_s, kLatest_s);
    if (instants_.empty() || row_s != instants_.back().t_s) {
      // A new instant: the ones before are complete.
      if (!instants_.empty() && instants_.back().t_s >= t_s) return;
      if (!instants_.empty() && row_s < instants_.back().t_s) table_.refuse("t_s", "a time that does not go back");
      instants_.push_back({row_s, {}});
      last_s_ = row_s;
    }
    instants_.back().objects.push_back(object());
    has_row_ = table_.next();
  }
  ended_ = true;
}

bool ObjectTruth::at(double t_s, std::vector<judge::TrueObject>& objects) {
  objects.clear();
  if (!(t_s >= first_s_ - kHold_s)) return false;
  read_until(t_s);
  while (instants_.size() > 2 && instants_[1].t_s < t_s - kBack_s) instants_.pop_front();
  const auto after = std::find_if(instants_.begin(), instants_.end(), [t_s](const Instant& i) { return i.t_s >= t_s; });
  if (after == instants_.end()) {
    if (instants_.empty() || t_s > instants_.back().t_s + kHold_s) return false;
    objects = instants_.back().objects;
  } else if (after == instants_.begin()) {
    objects = after->objects;
  } else {
    const auto before = std::prev(after);
    const double gap_s = after->t_s - before->t_s;
    // Without rows for so long there was no object.
    if (gap_s <= kLongestGap_s) {
      for (const judge::TrueObject& from : before->objects) {
        const auto to = std::find_if(after->objects.begin(), after->objects.end(),
                                     [&](const judge::TrueObject& o) { return o.box.id == from.box.id; });
        if (to != after->objects.end()) objects.push_back(between(from, *to, (t_s - before->t_s) / gap_s));
      }
    }
  }
  if (visibility_) {
    for (judge::TrueObject& object : objects) object.in_view = visibility_->sees(object.box.id, t_s);
  }
  return true;
}

}  // namespace boresight::score
