#pragma once

namespace barchan {

// What laws of contact see and give, for one, four or eight pairs (S: simd/*.hpp). Lengths [m],
// velocities [m/s], forces [N]. All differences are second minus first, so that swapping the two
// negates the force exactly: both sides of a cut agree to the bit.

template <class S, int Dim>
struct PairState;

/// Differences (second − first) and sums over a pair of disks.
template <class S>
struct PairState<S, 2> {
  using Real = typename S::Real;
  Real dx, dy, reach;    ///< reach = r_i + r_j
  Real vx, vy, surface;  ///< surface = u_i + u_j
  Real inverse_mass;     ///< 1/m_i + 1/m_j
  Real inverse_radius;   ///< 1/r_i + 1/r_j; a wall is flat, 1/r = 0
};

template <class S>
struct PairState<S, 3> {
  using Real = typename S::Real;
  Real dx, dy, dz, reach;
  Real vx, vy, vz, inverse_mass;
  Real ux, uy, uz, inverse_radius;
};

/// The same for laws that feel how the two turn against each other. Angular velocities [rad/s],
/// second minus first.
template <class S, int Dim>
struct TurningPair;

template <class S>
struct TurningPair<S, 2> : PairState<S, 2> {
  typename S::Real turn;                           ///< omega_j − omega_i
  typename S::Real inverse_first, inverse_second;  ///< 1/r_i, 1/r_j
};

template <class S>
struct TurningPair<S, 3> : PairState<S, 3> {
  typename S::Real turn_x, turn_y, turn_z;
  typename S::Real inverse_first, inverse_second;
};

/// What a law tells of a contact beside its force, for what is built on it.
template <class S, int Dim>
struct Touch;

template <class S>
struct Touch<S, 2> {
  typename S::Real pressed;  ///< |fn| [N]
  typename S::Real kt, ct;   ///< tangential stiffness and dashpot, now [N/m, N·s/m]
};

template <class S>
struct Touch<S, 3> {
  typename S::Real pressed, kt, ct;
  typename S::Real limit;       ///< of the tangential force [N]
  typename S::Real area;        ///< squared radius of the contact [m²]
  typename S::Real nx, ny, nz;  ///< from the first to the second
  typename S::Mask touching;    ///< others hold from afar
};

/// Force on the first particle [N], and torque / radius on both; the second one gets the negative
/// force. `size` is at least the largest component of either.
template <class S, int Dim>
struct PairForce;

template <class S>
struct PairForce<S, 2> {
  typename S::Real fx, fy, ft, size;
};

template <class S>
struct PairForce<S, 3> {
  typename S::Real fx, fy, fz, tx, ty, tz, size;
};

/// Of laws whose torques / radius differ: that on the first particle in `first`, that on the second
/// in `second`, which has the force and the size of `first` once more.
template <class S, int Dim>
struct PairForces {
  PairForce<S, Dim> first, second;
};

template <class Force>
inline constexpr bool kHasTwoTorques = requires(Force f) {
  f.second;
};

/// `respond` of a law that tells of its contacts by `touch`, so that others can be built on it.
template <class Law>
struct RespondsByTouch {
  /// @param s  history, replaced by its value after the step; zero where the pair does not touch
  /// @param out  of lanes that touch; of others any number
  /// @return which lanes touch, or are held from afar
  template <class S, int Level, class Constants, int Dim, int Length>
  [[gnu::always_inline]] static inline typename S::Mask respond(const Constants& c,
                                                                const PairState<S, Dim>& p,
                                                                typename S::Real dt,
                                                                typename S::Real (&s)[Length],
                                                                PairForce<S, Dim>& out) {
    Touch<S, Dim> t;
    return Law::template touch<S, Level>(c, p, dt, s, out, t);
  }
};

/// What acts on each end of a pair, but for the sign of the second one's force.
template <class Force>
[[gnu::always_inline]] inline auto& first_of(Force& f) {
  if constexpr (kHasTwoTorques<Force>)
    return f.first;
  else
    return f;
}
template <class Force>
[[gnu::always_inline]] inline auto& second_of(Force& f) {
  if constexpr (kHasTwoTorques<Force>)
    return f.second;
  else
    return f;
}

/// 1/d and the reduced mass, by one division where both are wanted.
template <class S, bool WantsMass>
[[gnu::always_inline]] inline typename S::Real inverse_of(typename S::Real d,
                                                          typename S::Real inverse_mass,
                                                          typename S::Real& reduced_mass) {
  if constexpr (!WantsMass) {
    return S::set(1.0) / d;
  } else {
    const auto q = S::set(1.0) / (d * inverse_mass);
    reduced_mass = q * d;
    return q * inverse_mass;
  }
}

}  // namespace barchan
