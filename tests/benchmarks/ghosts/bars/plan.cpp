// One cycle of all radars of Le Ba Thanh's scene, seen from above, for a figure: true provenance and classification of
// each detection, true mirrors and estimated reflectors. Nothing is judged.
#include <map>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include "tests/benchmarks/ghosts/bars/bars.hpp"
#include "tests/benchmarks/ghosts/common/methods.hpp"
#include "tests/benchmarks/ghosts/common/runner.hpp"

namespace boresight::bench {

namespace {

constexpr double kEnd_s = 8.0, kCycle_s = 0.1;
constexpr double kReach_m = 75.0;  // of the radars

using Points = std::vector<std::pair<double, double>>;

/// Transforms between the vehicle frame at one time and the world.
class Frame {
 public:
  explicit Frame(const simulator::EgoState& ego) : origin_m_(ego.position_m), turn_(ego.heading_rad) {}
  [[nodiscard]] Eigen::Vector2d to_world(const Eigen::Vector2d& p) const { return origin_m_ + turn_ * p; }
  [[nodiscard]] Eigen::Vector2d from_world(const Eigen::Vector2d& p) const { return turn_.inverse() * (p - origin_m_); }
  [[nodiscard]] Eigen::Vector2d axes_to_world(const Eigen::Vector2d& v) const { return turn_ * v; }

 private:
  Eigen::Vector2d origin_m_;
  Eigen::Rotation2Dd turn_;
};

class PlanView {
 public:
  explicit PlanView(const char* kind) : kind_(kind) {}

  void add(const Observed& observed) {
    if (observed.event.t_s <= kEnd_s - kCycle_s) return;
    const Frame now(observed.drive.ego(observed.event.t_s)), end(observed.drive.ego(kEnd_s));
    const ClassifiedScan& scan = observed.scan;
    for (std::size_t i = 0; i < scan.number_of_valid_detections; ++i) {
      if ((scan.detection_flags[i] & corrected_flag::kRejected) != 0) continue;
      const simulator::DetectionTruth& truth = (*observed.event.truth)[i];
      Eigen::Vector2d world = now.to_world({scan.x_vehicle_m[i], scan.y_vehicle_m[i]});
      // Moving objects are moved on to the end of the cycle. Along a straight rail their mirror images move as far.
      for (const closed_loop::Object& o : observed.objects) {
        if (o.id == truth.object_id) world += (kEnd_s - observed.event.t_s) * now.axes_to_world(o.velocity_mps);
      }
      const Eigen::Vector2d at = end.from_world(world);
      points_[std::string(name_of(truth.provenance))][std::string(name_of(scan.provenance[i]))].emplace_back(at.x(),
                                                                                                             at.y());
    }
    reflectors_.clear();
    for (std::size_t k = 0; k < scan.number_of_reflector_segments; ++k) {
      const auto point = [&](const std::array<float, 2>& p) {
        const Eigen::Vector2d at = end.from_world(now.to_world({p[0], p[1]}));
        return std::pair<double, double>(at.x(), at.y());
      };
      const ReflectorSegment& segment = scan.reflector_segments[k];
      reflectors_.push_back({point(segment.start_vehicle_m), point(segment.end_vehicle_m)});
    }
    mirrors_.clear();
    simulator::Scene scene;
    observed.drive.world().at(kEnd_s, kReach_m, scene);
    for (const simulator::MirrorSurface& mirror : scene.surfaces) {
      const Eigen::Vector2d from = end.from_world(mirror.from_m), to = end.from_world(mirror.to_m);
      mirrors_.push_back({{from.x(), from.y()}, {to.x(), to.y()}});
    }
    boxes_.clear();
    for (const closed_loop::Object& o : closed_loop::objects_at(observed.drive, kEnd_s)) {
      const Eigen::Rotation2Dd turn(o.heading_rad);
      Points box;
      for (const auto& [x, y] : {std::pair{0.5, 0.5}, {-0.5, 0.5}, {-0.5, -0.5}, {0.5, -0.5}, {0.5, 0.5}}) {
        const Eigen::Vector2d corner = o.position_m + turn * Eigen::Vector2d(x * o.length_m, y * o.width_m);
        box.emplace_back(corner.x(), corner.y());
      }
      boxes_.push_back(std::move(box));
    }
  }

  void write(Report& report) const {
    for (const auto& [truth, by_label] : points_) {
      for (const auto& [label, points] : by_label) {
        report.add(Curve{"plan", kind_ + ("|" + truth), label, points});
      }
    }
    write(reflectors_, "reflector", report);
    write(mirrors_, "mirror", report);
    write(boxes_, "object", report);
  }

 private:
  void write(const std::vector<Points>& lines, const char* what, Report& report) const {
    for (const Points& line : lines) report.add(Curve{"plan", kind_, what, line});
  }
  std::string kind_;
  std::map<std::string, std::map<std::string, Points>> points_;  // by truth and label
  std::vector<Points> reflectors_, mirrors_, boxes_;
};

}  // namespace

void plan(const Options& options, Report& report) {
  const std::vector<NamedGhostMethod> methods = ghost_methods();
  std::vector<PlanView> views;
  for (const NamedGhostMethod& method : methods) views.emplace_back(method.name.c_str());
  static_cast<void>(run_ghost_drive({"highway_multipath", options.profile, options.first_seed, kEnd_s}, methods,
                                    [&](const Observed& observed) { views[observed.method].add(observed); }));
  for (const PlanView& view : views) view.write(report);
}

}  // namespace boresight::bench
