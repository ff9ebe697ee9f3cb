#pragma once

namespace barchan {

// What a linear spring and dashpot give back of the speed of a free head-on collision, by the
// damping ratio zeta = cn/(2·sqrt(kn·m_eff)). With c = arccos(zeta) and s = sqrt(1 − zeta²),
// beyond zeta = 1 arcosh(zeta) and sqrt(zeta² − 1):
//
//   without the clamp   the contact ends at overlap zero   e = exp(−pi·zeta/s), 0 from zeta = 1 on
//   with the clamp      it ends at force zero              e = exp(−2·zeta·c/s)
//
// Source: Schwager & Pöschel 2007, doi:10.1007/s10035-007-0065-z.

/// Restitution at a damping ratio >= 0. Pure.
[[nodiscard]] double restitution_at(double damping_ratio, bool no_tension);

/// The damping ratio that rebounds with `restitution`, to the last digits; 0 for 1. Pure.
/// @pre 0 < restitution <= 1
[[nodiscard]] double damping_ratio_for(double restitution, bool no_tension);

}  // namespace barchan
