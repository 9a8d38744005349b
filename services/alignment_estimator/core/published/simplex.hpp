// The simplex of Nelder and Mead (1965), for up to four parameters.
#pragma once

#include <array>
#include <utility>

#include <Eigen/Core>

namespace boresight::alignment::published {

/// Vertices are sorted by cost after every call, the best first. Reflection 1, expansion 2, contraction and shrinkage
/// 1/2. `cost` receives a point whose entries beyond `dimension` are those of the start. A cost that is not a number
/// counts as the worst.
class Simplex {
 public:
  /// The start, and one vertex per dimension, moved by that entry of `edge`.
  template <class Cost>
  Simplex(const Eigen::Vector4d& start, const Eigen::Vector4d& edge, int dimension, const Cost& cost)
      : dimension_(dimension) {
    for (int i = 0; i <= dimension_; ++i) {
      Vertex& v = at(i);
      v.point = start;
      if (i > 0) v.point(i - 1) += edge(i - 1);
      v.cost = cost(v.point);
    }
    sort();
  }

  template <class Cost>
  void iterate(const Cost& cost) {
    Eigen::Vector4d centre = Eigen::Vector4d::Zero();
    for (int i = 0; i < dimension_; ++i) centre += at(i).point;
    centre /= dimension_;
    Vertex& worst = at(dimension_);
    const auto along = [&](double factor) {
      const Eigen::Vector4d point = centre + factor * (worst.point - centre);
      return Vertex{point, cost(point)};
    };
    const Vertex reflected = along(-1.0);
    if (reflected.cost < at(0).cost) {
      const Vertex expanded = along(-2.0);
      worst = expanded.cost < reflected.cost ? expanded : reflected;
    } else if (reflected.cost < at(dimension_ - 1).cost) {
      worst = reflected;
    } else {
      const bool outside = reflected.cost < worst.cost;
      const Vertex contracted = along(outside ? -0.5 : 0.5);
      if (contracted.cost < (outside ? reflected.cost : worst.cost)) {
        worst = contracted;
      } else {
        for (int i = 1; i <= dimension_; ++i) {
          at(i).point = 0.5 * (at(i).point + at(0).point);
          at(i).cost = cost(at(i).point);
        }
      }
    }
    sort();
  }

  [[nodiscard]] const Eigen::Vector4d& best() const { return vertices_[0].point; }
  [[nodiscard]] double best_cost() const { return vertices_[0].cost; }

 private:
  struct Vertex {
    Eigen::Vector4d point;
    double cost;
  };
  [[nodiscard]] Vertex& at(int i) { return vertices_[static_cast<std::size_t>(i)]; }
  void sort() {
    for (int i = 1; i <= dimension_; ++i) {
      // This form moves a cost that is not a number to the end.
      for (int j = i; j > 0 && (at(j).cost < at(j - 1).cost || at(j - 1).cost != at(j - 1).cost); --j)
        std::swap(at(j), at(j - 1));
    }
  }

  int dimension_;
  std::array<Vertex, 5> vertices_;
};

}  // namespace boresight::alignment::published
