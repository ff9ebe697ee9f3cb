#include <cmath>

#include <barchan/core/kernels/row_loop.hpp>

namespace barchan::kernels {
namespace {

struct Quad {
  struct Real {
    double a[4];
    friend Real operator+(const Real& p, const Real& q) {
      return {p.a[0] + q.a[0], p.a[1] + q.a[1], p.a[2] + q.a[2], p.a[3] + q.a[3]};
    }
    friend Real operator-(const Real& p, const Real& q) {
      return {p.a[0] - q.a[0], p.a[1] - q.a[1], p.a[2] - q.a[2], p.a[3] - q.a[3]};
    }
    friend Real operator*(const Real& p, const Real& q) {
      return {p.a[0] * q.a[0], p.a[1] * q.a[1], p.a[2] * q.a[2], p.a[3] * q.a[3]};
    }
  };
  static Real of(double a, double b, double c, double d) { return {a, b, c, d}; }
  static Real set(double a) { return {a, a, a, a}; }
  static Real load(const double* p) { return {p[0], p[1], p[2], p[3]}; }
  static void store(double* p, const Real& r) {
    for (int c = 0; c < 4; ++c) p[c] = r.a[c];
  }
  static Real last(const Real& v) { return set(v.a[3]); }
  static Real where_positive(const Real& m, const Real& r) {
    return {m.a[0] > 0 ? r.a[0] : 0.0, m.a[1] > 0 ? r.a[1] : 0.0, m.a[2] > 0 ? r.a[2] : 0.0,
            m.a[3] > 0 ? r.a[3] : 0.0};
  }
  static Real max(const Real& p, const Real& q) {
    Real top;
    for (int c = 0; c < 4; ++c) top.a[c] = p.a[c] > q.a[c] ? p.a[c] : q.a[c];
    return top;
  }
  /// 1 where |r| is more than the limit or no number.
  static Real beyond(const Real& r, const Real& limit) {
    Real is{};
    for (int c = 0; c < 4; ++c) is.a[c] = std::fabs(r.a[c]) <= limit.a[c] ? 0.0 : 1.0;
    return is;
  }
  static Real either(const Real& p, const Real& q) { return p + q; }
  static bool has_any(const Real& r) { return r.a[0] + r.a[1] + r.a[2] + r.a[3] > 0.0; }
  static Real abs(const Real& r) {
    return {std::fabs(r.a[0]), std::fabs(r.a[1]), std::fabs(r.a[2]), std::fabs(r.a[3])};
  }
  static Real copysign(const Real& m, const Real& s) {
    return {std::copysign(m.a[0], s.a[0]), std::copysign(m.a[1], s.a[1]),
            std::copysign(m.a[2], s.a[2]), std::copysign(m.a[3], s.a[3])};
  }
};

}  // namespace

RowKernel pick_rows_scalar(int dim, bool damped) {
  return pick_rows<Quad>(dim, damped);
}

}  // namespace barchan::kernels
