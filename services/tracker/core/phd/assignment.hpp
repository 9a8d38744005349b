// Assignment of a group's measurements to predicted objects, and the blocks of measurements that share no cell.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "services/tracker/core/ggiw/prediction.hpp"
#include "services/tracker/core/model/model.hpp"
#include "services/tracker/core/phd/parameters.hpp"
#include "services/tracker/core/phd/partitions.hpp"

namespace boresight::tracking::phd {

/// One predicted component of a group.
struct Predicted {
  std::size_t identity = 0;  ///< components of one identity are hypotheses about one object
  double weight = 0.0, log_weight = 0.0;
  double share = 0.0;  ///< of the identity's weight
  double expected_detections = 0.0;
  bool is_object = false;  ///< the identity exists as likely as not
};

class Assignment {
 public:
  Assignment(const Parameters& parameters, const Capacity& capacity);

  void find(const Model& model, std::span<const Measurement<double>> measurements,
            std::span<const Predicted> components, std::span<const Prediction<double>> predictions);

  /// Sets of measurements, as indices.
  [[nodiscard]] std::size_t blocks() const { return starts_.size() - 1; }
  [[nodiscard]] std::span<const std::size_t> block(std::size_t i) const {
    return {order_.data() + starts_[i], starts_[i + 1] - starts_[i]};
  }
  /// Adds the prediction partitions and shared partitions of a block.
  void add_partitions(const Model& model, std::size_t block, Partitions& partitions);

 private:
  void assign(std::span<const Measurement<double>> z, std::span<const Predicted> components,
              std::span<const Prediction<double>> predictions);
  /// Whether a component may have detections in the scan.
  [[nodiscard]] bool is_seen(const Prediction<double>& p) const {
    return p.detection_probability() >= parameters_.min_detection_probability;
  }
  void find_blocks(const Model& model, std::span<const Measurement<double>> z);

  Parameters parameters_;
  std::vector<std::int16_t> assigned_;         // identity of each measurement
  std::vector<std::int16_t> assigned_object_;  // the same among objects_
  std::vector<std::size_t> objects_;           // identities that count as objects
  std::vector<double> shares_;                 // measurements × objects
  DisjointSets sets_;
  std::vector<std::size_t> order_, starts_;  // measurements block by block, start of each block
  std::vector<std::int16_t> block_labels_;   // scratch
  std::vector<double> block_shares_;         // scratch
};

}  // namespace boresight::tracking::phd
