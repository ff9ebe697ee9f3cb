#include <barchan/core/laws/rolling.hpp>

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include <barchan/core/laws/mixing.hpp>

namespace barchan {
namespace {

using Range = LawKey::Range;

}  // namespace

const std::array<LawKey, RollingPart::kNumKeys> RollingPart::kKeys{{
    {"rolling_friction", Range::NotNegative, "", "0",
     "largest rolling moment over the normal force and the reduced radius; `contact.rolling = "
     "\"spring\"`",
     [](ContactConstants& p, double value) { p.mu_rolling = value; }, -1, false,
     LawKey::Part::Rolling},
    {"rolling_stiffness_ratio", Range::Positive, "", "1",
     "stiffness of the rolling spring over the tangential one",
     [](ContactConstants& p, double value) { p.kr_ratio = value; }, -1, false,
     LawKey::Part::Rolling},
    {"rolling_stiffness", Range::Positive, "N/m", "none",
     "of the rolling spring, instead of `rolling_stiffness_ratio`",
     [](ContactConstants& p, double value) { p.kr = value, p.kr_ratio = 0.0; }, 1, false,
     LawKey::Part::Rolling},
    {"rolling_damping", Range::NotNegative, "N·s/m", "0", "dashpot beside the rolling spring",
     [](ContactConstants& p, double value) { p.cr = value; }, -1, false, LawKey::Part::Rolling},
}};

bool RollingPart::mix(const ContactConstants& a, const ContactConstants& b,
                      ContactConstants& pair) {
  if ((a.kr > 0.0) != (b.kr > 0.0)) return false;
  pair.mu_rolling = std::min(a.mu_rolling, b.mu_rolling);
  pair.kr = in_series(a.kr, b.kr);
  pair.kr_ratio = geometric_mean(a.kr_ratio, b.kr_ratio);
  pair.cr = in_series(a.cr, b.cr);
  return true;
}

std::string RollingPart::text(const ContactConstants& p) {
  return fmt::format("{:.4g}", p.mu_rolling);
}

void RollingPart::write(const ContactConstants& p, const ContactRules& rules, double* fields) {
  const bool rolls = p.mu_rolling > 0.0;
  fields[Stiffness] = rolls ? p.kr : 0.0;
  fields[StiffnessRatio] = rolls ? p.kr_ratio : 0.0;
  fields[Damping] = rolls ? p.cr : 0.0;
  fields[Friction] = p.mu_rolling;
  fields[Twisting] = rules.twisting && p.mu > 0.0 ? 1.0 : 0.0;
}

}  // namespace barchan
