#include <barchan/core/kernels/row_loop.hpp>

namespace barchan::kernels {
namespace {

// Pairs of doubles, which every compiler has. Number by number compilers read back in pairs what
// they have just written singly, and the core waits for it.
using Pair = double __attribute__((vector_size(16)));
using Bits = long long __attribute__((vector_size(16)));

constexpr Bits kSign{static_cast<long long>(1ULL << 63), static_cast<long long>(1ULL << 63)};

struct Quad {
  struct Real {
    Pair lo, hi;
    friend Real operator+(Real p, Real q) { return {p.lo + q.lo, p.hi + q.hi}; }
    friend Real operator-(Real p, Real q) { return {p.lo - q.lo, p.hi - q.hi}; }
    friend Real operator*(Real p, Real q) { return {p.lo * q.lo, p.hi * q.hi}; }
  };
  static Real of(double a, double b, double c, double d) { return {Pair{a, b}, Pair{c, d}}; }
  static Real set(double a) { return of(a, a, a, a); }
  static Real load(const double* p) { return of(p[0], p[1], p[2], p[3]); }
  static void store(double* p, Real r) { __builtin_memcpy(p, &r, sizeof r); }
  static Real last(Real v) { return set(v.hi[1]); }
  static Real where_positive(Real m, Real r) {
    return {Pair((m.lo > 0.0) & Bits(r.lo)), Pair((m.hi > 0.0) & Bits(r.hi))};
  }
  static Pair max(Pair p, Pair q) { return p > q ? p : q; }
  static Real max(Real p, Real q) { return {max(p.lo, q.lo), max(p.hi, q.hi)}; }
  static Pair abs(Pair r) { return Pair(Bits(r) & ~kSign); }
  static Real abs(Real r) { return {abs(r.lo), abs(r.hi)}; }
  /// All bits where |r| is more than the limit or no number.
  static Real beyond(Real r, Real limit) {
    return {Pair(~(abs(r.lo) <= limit.lo)), Pair(~(abs(r.hi) <= limit.hi))};
  }
  static Real either(Real p, Real q) {
    return {Pair(Bits(p.lo) | Bits(q.lo)), Pair(Bits(p.hi) | Bits(q.hi))};
  }
  static bool has_any(Real r) {
    const Bits any = Bits(r.lo) | Bits(r.hi);
    return (any[0] | any[1]) != 0;
  }
  static Pair copysign(Pair m, Pair s) { return Pair((Bits(m) & ~kSign) | (Bits(s) & kSign)); }
  static Real copysign(Real m, Real s) { return {copysign(m.lo, s.lo), copysign(m.hi, s.hi)}; }
};

}  // namespace

RowKernel pick_rows_scalar(int dim, bool damped) {
  return pick_rows<Quad>(dim, damped);
}

}  // namespace barchan::kernels
