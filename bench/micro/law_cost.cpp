#include "law_cost.hpp"

#include <cmath>

#include <barchan/core/laws/linear_spring.hpp>

namespace barchan::micro {
namespace {

/// A number that counts what is done to it. Comparisons, selections and signs are free here.
struct Counted {
  double value = 0.0;
  static inline int count = 0;
  friend Counted operator+(Counted a, Counted b) { return ++count, Counted{a.value + b.value}; }
  friend Counted operator-(Counted a, Counted b) { return ++count, Counted{a.value - b.value}; }
  friend Counted operator*(Counted a, Counted b) { return ++count, Counted{a.value * b.value}; }
  friend Counted operator/(Counted a, Counted b) { return ++count, Counted{a.value / b.value}; }
  friend Counted operator-(Counted a) { return {-a.value}; }
  Counted& operator+=(Counted b) { return *this = *this + b; }
  Counted& operator-=(Counted b) { return *this = *this - b; }
  Counted& operator*=(Counted b) { return *this = *this * b; }
};

struct Counting {
  using Real = Counted;
  using Mask = bool;
  static constexpr int kWidth = 1;
  static Real set(double a) { return {a}; }
  static Real sqrt(Real a) { return ++Counted::count, Real{std::sqrt(a.value)}; }
  static Real abs(Real a) { return {std::fabs(a.value)}; }
  static Real copysign(Real a, Real b) { return {std::copysign(a.value, b.value)}; }
  static Real round(Real a) { return ++Counted::count, Real{std::rint(a.value)}; }
  static Mask less(Real a, Real b) { return a.value < b.value; }
  static Real select(Mask m, Real a, Real b) { return m ? a : b; }
  static Real where(Mask m, Real a) { return m ? a : Real{0.0}; }
  static bool any(Mask m) { return m; }
  static unsigned bits(Mask m) { return m ? 1U : 0U; }
};

LinearSpring::Constants<Counting> constants() {
  LinearSpring::Constants<Counting> c;
  c.kn = {1e5}, c.kt = {1e4}, c.inverse_kt = {1e-4}, c.mu = {0.1}, c.cap = {1e300};
  c.cn_rate = {10.0}, c.ct_rate = {10.0};
  return c;
}

// Differences and sums over the pair are made when records are gathered; scattering adds each force
// twice.
constexpr int kGathered2 = 7, kGathered3 = 11, kScattered2 = 6, kScattered3 = 12;

}  // namespace

double law_flops(int dim) {
  const Counted dt{1e-4};
  Counted::count = 0;
  if (dim == 2) {
    Counted spring[1] = {{1e-3}};
    PairForce<Counting, 2> force;
    const PairState<Counting, 2> pair{{0.9}, {0.1}, {1.0}, {0.1}, {2.0}, {0.3}, {2.0}, {2.0}};
    (void)LinearSpring::respond<Counting, LinearSpring::Rate>(constants(), pair, dt, spring, force);
    return Counted::count + kGathered2 + kScattered2;
  }
  Counted spring[3] = {{1e-3}, {0.0}, {0.0}};
  PairForce<Counting, 3> force;
  const PairState<Counting, 3> pair{{0.9}, {0.1}, {0.1}, {1.0}, {0.1}, {2.0},
                                    {0.3}, {2.0}, {0.1}, {0.2}, {0.3}, {2.0}};
  (void)LinearSpring::respond<Counting, LinearSpring::Rate>(constants(), pair, dt, spring, force);
  return Counted::count + kGathered3 + kScattered3;
}

}  // namespace barchan::micro
