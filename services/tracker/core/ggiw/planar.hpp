// Closed-form algebra of the plane: vectors, symmetric and general 2 × 2 matrices.
#pragma once

#include <cmath>

namespace boresight::tracking {

template <typename Real>
struct Vector2 {
  Real x = 0, y = 0;
};

/// [xx xy; xy yy]
template <typename Real>
struct Symmetric2 {
  Real xx = 0, xy = 0, yy = 0;
};

/// [xx xy; yx yy]
template <typename Real>
struct Matrix2 {
  Real xx = 0, xy = 0, yx = 0, yy = 0;
};

template <typename Real>
constexpr Vector2<Real> operator+(const Vector2<Real>& a, const Vector2<Real>& b) {
  return {a.x + b.x, a.y + b.y};
}
template <typename Real>
constexpr Vector2<Real> operator-(const Vector2<Real>& a, const Vector2<Real>& b) {
  return {a.x - b.x, a.y - b.y};
}
template <typename Real>
constexpr Vector2<Real> operator*(Real s, const Vector2<Real>& a) {
  return {s * a.x, s * a.y};
}
template <typename Real>
constexpr Symmetric2<Real> operator+(const Symmetric2<Real>& a, const Symmetric2<Real>& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.yy + b.yy};
}
template <typename Real>
constexpr Symmetric2<Real> operator-(const Symmetric2<Real>& a, const Symmetric2<Real>& b) {
  return {a.xx - b.xx, a.xy - b.xy, a.yy - b.yy};
}
template <typename Real>
constexpr Symmetric2<Real> operator*(Real s, const Symmetric2<Real>& a) {
  return {s * a.xx, s * a.xy, s * a.yy};
}
template <typename Real>
constexpr Matrix2<Real> operator+(const Matrix2<Real>& a, const Matrix2<Real>& b) {
  return {a.xx + b.xx, a.xy + b.xy, a.yx + b.yx, a.yy + b.yy};
}
template <typename Real>
constexpr Matrix2<Real> operator-(const Matrix2<Real>& a, const Matrix2<Real>& b) {
  return {a.xx - b.xx, a.xy - b.xy, a.yx - b.yx, a.yy - b.yy};
}
template <typename Real>
constexpr Matrix2<Real> operator*(Real s, const Matrix2<Real>& a) {
  return {s * a.xx, s * a.xy, s * a.yx, s * a.yy};
}

template <typename Real>
constexpr Real dot(const Vector2<Real>& a, const Vector2<Real>& b) {
  return a.x * b.x + a.y * b.y;
}
template <typename Real>
constexpr Real squared_norm(const Vector2<Real>& a) {
  return dot(a, a);
}
template <typename Real>
constexpr Real determinant(const Symmetric2<Real>& s) {
  return s.xx * s.yy - s.xy * s.xy;
}
template <typename Real>
constexpr Real determinant(const Matrix2<Real>& m) {
  return m.xx * m.yy - m.xy * m.yx;
}
template <typename Real>
constexpr Real trace(const Symmetric2<Real>& s) {
  return s.xx + s.yy;
}
/// tr(A B)
template <typename Real>
constexpr Real product_trace(const Symmetric2<Real>& a, const Symmetric2<Real>& b) {
  return a.xx * b.xx + Real(2) * a.xy * b.xy + a.yy * b.yy;
}
/// S⁻¹ det S
template <typename Real>
constexpr Symmetric2<Real> adjugate(const Symmetric2<Real>& s) {
  return {s.yy, -s.xy, s.xx};
}
template <typename Real>
constexpr Symmetric2<Real> inverse(const Symmetric2<Real>& s) {
  return (Real(1) / determinant(s)) * adjugate(s);
}
template <typename Real>
constexpr Symmetric2<Real> outer(const Vector2<Real>& a) {
  return {a.x * a.x, a.x * a.y, a.y * a.y};
}
/// a bᵀ
template <typename Real>
constexpr Matrix2<Real> outer(const Vector2<Real>& a, const Vector2<Real>& b) {
  return {a.x * b.x, a.x * b.y, a.y * b.x, a.y * b.y};
}
template <typename Real>
constexpr Matrix2<Real> full(const Symmetric2<Real>& s) {
  return {s.xx, s.xy, s.xy, s.yy};
}
template <typename Real>
constexpr Matrix2<Real> transpose(const Matrix2<Real>& m) {
  return {m.xx, m.yx, m.xy, m.yy};
}
template <typename Real>
constexpr Vector2<Real> operator*(const Symmetric2<Real>& s, const Vector2<Real>& a) {
  return {s.xx * a.x + s.xy * a.y, s.xy * a.x + s.yy * a.y};
}
template <typename Real>
constexpr Vector2<Real> operator*(const Matrix2<Real>& m, const Vector2<Real>& a) {
  return {m.xx * a.x + m.xy * a.y, m.yx * a.x + m.yy * a.y};
}
template <typename Real>
constexpr Matrix2<Real> operator*(const Matrix2<Real>& a, const Matrix2<Real>& b) {
  return {a.xx * b.xx + a.xy * b.yx, a.xx * b.xy + a.xy * b.yy, a.yx * b.xx + a.yy * b.yx, a.yx * b.xy + a.yy * b.yy};
}
template <typename Real>
constexpr Matrix2<Real> operator*(const Symmetric2<Real>& a, const Symmetric2<Real>& b) {
  return full(a) * full(b);
}
template <typename Real>
constexpr Matrix2<Real> operator*(const Matrix2<Real>& a, const Symmetric2<Real>& b) {
  return a * full(b);
}
/// aᵀ S a
template <typename Real>
constexpr Real quadratic(const Symmetric2<Real>& s, const Vector2<Real>& a) {
  return s.xx * a.x * a.x + Real(2) * s.xy * a.x * a.y + s.yy * a.y * a.y;
}
/// M S Mᵀ
template <typename Real>
constexpr Symmetric2<Real> congruent(const Matrix2<Real>& m, const Symmetric2<Real>& s) {
  const Real x0 = m.xx * s.xx + m.xy * s.xy, x1 = m.xx * s.xy + m.xy * s.yy;
  const Real y0 = m.yx * s.xx + m.yy * s.xy, y1 = m.yx * s.xy + m.yy * s.yy;
  return {x0 * m.xx + x1 * m.xy, x0 * m.yx + x1 * m.yy, y0 * m.yx + y1 * m.yy};
}
/// Symmetric square root of a positive definite matrix: (S + √det S · I) / √(tr S + 2 √det S).
template <typename Real>
inline Symmetric2<Real> square_root(const Symmetric2<Real>& s) {
  const Real root = std::sqrt(determinant(s));
  const Real f = Real(1) / std::sqrt(trace(s) + Real(2) * root);
  return {(s.xx + root) * f, s.xy * f, (s.yy + root) * f};
}

}  // namespace boresight::tracking
