// The memory of boxes by label: what is kept, forgotten and joined.
#include "services/tracker/core/model/object_boxes.hpp"

#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "services/common/runtime/allocation_counter.hpp"
#include "tests/unit/tracker/simulated_object.hpp"

namespace boresight::tracking {
namespace {

using extended_object::RoadUserClass;

Component<double> labelled(std::uint32_t label, double x, double y = 0.0) {
  Component<double> c;
  c.label = label;
  c.position_m = {x, y};
  c.velocity_mps = {10.0, 0.0};
  c.position_covariance = {0.05, 0.0, 0.05};
  c.velocity_covariance = {0.01, 0.0, 0.01};
  c.extent_scale = {4.0, 0.0, 4.0};
  return c;
}
ObjectEstimate estimate_of(const Component<double>& c) {
  ObjectEstimate e;
  e.id = c.label;
  e.existence = 0.99;
  e.detected = true;
  e.detections = 2.0;
  e.scatter = {0.3, 0.0, 0.3};
  e.mean_m = c.position_m;
  e.component = &c;
  return e;
}
ObjectBoxes boxes_for(std::size_t max_objects) {
  return {BoxEstimator(support::class_table(), BoxParameters{}), RoadParameters{}, max_objects};
}
void show(ObjectBoxes& boxes, const std::vector<Component<double>>& objects, const Viewpoint& from = {}) {
  boxes.begin_scan(from);
  std::vector<ObjectEstimate> estimates;
  for (const auto& c : objects) {
    static_cast<void>(boxes.see(c, {0.02, 0.0, 0.05}));
    estimates.push_back(estimate_of(c));
  }
  boxes.learn(estimates, 0.05, 0.0);
}

TEST(ObjectBoxes, RemembersByLabelWhateverTheOrder) {
  ObjectBoxes boxes = boxes_for(8);
  for (int i = 0; i < 5; ++i) show(boxes, {labelled(7, 30.0), labelled(3, 60.0, 8.0)});
  const BoxMemory seven = boxes.find(7)->memory, three = boxes.find(3)->memory;
  EXPECT_TRUE(seven.has_point);
  boxes.begin_scan({});
  const std::array components = {labelled(3, 60.0, 8.0), labelled(7, 30.0)};
  const std::array estimates = {estimate_of(components[0]), estimate_of(components[1])};
  boxes.learn(estimates, 0.0, 0.0);
  EXPECT_EQ(boxes.find(7)->memory.classes[2].point_m, seven.classes[2].point_m);
  EXPECT_EQ(boxes.find(3)->memory.classes[2].point_m, three.classes[2].point_m);
  EXPECT_NE(boxes.find(3)->memory.classes[2].point_m, seven.classes[2].point_m);
}

TEST(ObjectBoxes, ForgetsWhatIsNotReported) {
  ObjectBoxes boxes = boxes_for(8);
  show(boxes, {labelled(1, 30.0), labelled(2, 60.0)});
  show(boxes, {labelled(2, 60.0)});
  EXPECT_EQ(boxes.find(1), nullptr);
  EXPECT_EQ(boxes.see(labelled(1, 30.0), {}), nullptr);
  ASSERT_NE(boxes.find(2), nullptr);
  show(boxes, {labelled(1, 30.0), labelled(2, 60.0)});
  ASSERT_NE(boxes.find(1), nullptr);
  EXPECT_FALSE(boxes.find(1)->memory.has_point) << "it begins anew";
  boxes.clear();
  EXPECT_EQ(boxes.find(2), nullptr);
}

TEST(ObjectBoxes, UnknownObjectHasTheBoxOfANewOne) {
  ObjectBoxes boxes = boxes_for(8);
  const BoxEstimator estimator(support::class_table(), BoxParameters{});
  const Component<double> c = labelled(5, 30.0);
  const Box a = boxes.box(c), b = estimator.box(estimator.begin(), c, {0.0, 0.0});
  EXPECT_EQ(a.centre_m, b.centre_m);
  EXPECT_EQ(a.length_m, b.length_m);
}

TEST(ObjectBoxes, FirstHypothesisOfAScanSetsTheViews) {
  ObjectBoxes boxes = boxes_for(8);
  for (int i = 0; i < 3; ++i) show(boxes, {labelled(1, 30.0)});
  boxes.begin_scan({});
  const ObjectBoxes::Record* first = boxes.see(labelled(1, 30.0), {0.02, 0.0, 0.05});
  EXPECT_EQ(boxes.see(labelled(1, 31.0), {9.0, 0.0, 9.0}), first);
  EXPECT_EQ(first->predicted_m.x, 30.0);
  EXPECT_EQ(first->noise_m2.xx, 0.02);
  boxes.begin_scan({});
  EXPECT_EQ(boxes.see(labelled(1, 31.0), {9.0, 0.0, 9.0})->predicted_m.x, 31.0);
}

TEST(ObjectBoxes, JoinKeepsTheMemoryOfTheWholeUnderTheOlderLabel) {
  ObjectBoxes boxes = boxes_for(8);
  constexpr std::size_t kTruck = support::index_of(RoadUserClass::kTruck);
  for (const auto& [whole, part] : {std::pair(2U, 5U), std::pair(5U, 2U)}) {
    boxes.clear();
    for (int i = 0; i < 5; ++i) show(boxes, {labelled(whole, 30.0), labelled(part, 37.0, 0.2)});
    const BoxMemory of_whole = boxes.find(whole)->memory;
    boxes.join(labelled(whole, 30.0), labelled(part, 37.0, 0.2), 2);
    ASSERT_NE(boxes.find(2), nullptr);
    const BoxMemory& joined = boxes.find(2)->memory;
    EXPECT_EQ(boxes.find(2)->label, 2U);
    EXPECT_EQ(joined.classes[kTruck].point_m, of_whole.classes[kTruck].point_m);
    EXPECT_EQ(boxes.find(2)->predicted_m.x, 30.0);
    EXPECT_GT(joined.probability[kTruck], of_whole.probability[kTruck]) << "only a truck holds both";
    const Component<double> c = labelled(2, 30.0);
    const std::array estimates = {estimate_of(c)};
    boxes.learn(estimates, 0.05, 0.0);
    EXPECT_NE(boxes.find(2), nullptr);
    EXPECT_EQ(boxes.find(5), nullptr);
  }
}

TEST(ObjectBoxes, JoinOfUnknownObjectsChangesNothing) {
  ObjectBoxes boxes = boxes_for(8);
  show(boxes, {labelled(1, 30.0)});
  boxes.join(labelled(8, 30.0), labelled(9, 31.0), 8);
  boxes.join(labelled(1, 30.0), labelled(9, 31.0), 0);
  EXPECT_NE(boxes.find(1), nullptr);
  EXPECT_EQ(boxes.find(8), nullptr);
}

TEST(ObjectBoxes, AllocatesNothingBeyondItsCapacity) {
  constexpr std::size_t kMost = 16;
  ObjectBoxes boxes = boxes_for(kMost);
  std::vector<Component<double>> components;
  components.reserve(100);
  std::vector<ObjectEstimate> estimates;
  estimates.reserve(100);
  const std::uint64_t before = runtime::counted_allocations();
  for (int scan = 0; scan < 100; ++scan) {
    components.clear();
    estimates.clear();
    // More objects than there is room for, of labels that come and go.
    for (std::uint32_t k = 0; k < 20; ++k) {
      components.push_back(labelled(1 + k + static_cast<std::uint32_t>(scan / 3), 20.0 + 5.0 * k));
    }
    for (const auto& c : components) estimates.push_back(estimate_of(c));
    const runtime::CountAllocations counting;
    boxes.begin_scan({});
    for (const auto& c : components) static_cast<void>(boxes.see(c, {0.02, 0.0, 0.05}));
    boxes.join(components[0], components[1], components[0].label);
    boxes.learn(estimates, 0.05, 0.0);
    static_cast<void>(boxes.box(components[0]));
  }
  EXPECT_EQ(runtime::counted_allocations(), before);
}

}  // namespace
}  // namespace boresight::tracking
