#include "services/simulator/world/knots.hpp"

#include <algorithm>

namespace boresight::simulator {

namespace {

/// Integral from the first knot to x; negative before it.
double from_first(const Knots& knots, double x) {
  if (x <= knots.front().at) return (x - knots.front().at) * knots.front().value;
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const Knot &a = knots[i], &b = knots[i + 1];
    const double width = b.at - a.at;
    if (width <= 0.0) continue;
    const double u = std::clamp((x - a.at) / width, 0.0, 1.0);
    const double step = u * u * u * u * (u * (u - 3.0) + 2.5);  // integral of 6u⁵ − 15u⁴ + 10u³
    sum += width * (a.value * u + (b.value - a.value) * step);
    if (x <= b.at) return sum;
  }
  return sum + (x - knots.back().at) * knots.back().value;
}

}  // namespace

Smooth smooth(const Knots& knots, double x) {
  if (knots.empty()) return {};
  if (x <= knots.front().at) return {knots.front().value};
  if (x >= knots.back().at) return {knots.back().value};
  const auto after =
      std::upper_bound(knots.begin(), knots.end(), x, [](double place, const Knot& k) { return place < k.at; });
  const Knot &a = *(after - 1), &b = *after;
  const double width = b.at - a.at, rise = b.value - a.value;
  const double u = (x - a.at) / width;
  return {a.value + rise * u * u * u * (u * (6.0 * u - 15.0) + 10.0),
          rise * 30.0 * u * u * (u - 1.0) * (u - 1.0) / width,
          rise * 60.0 * u * (u * (2.0 * u - 3.0) + 1.0) / (width * width)};
}

double integral(const Knots& knots, double x) {
  return knots.empty() ? 0.0 : from_first(knots, x) - from_first(knots, 0.0);
}

}  // namespace boresight::simulator
