#pragma once

#include <optional>

namespace barchan {

/// One dashpot: coefficient = constant + rate·m_eff + critical·sqrt(m_eff).
/// A deck gives `cn` (constant [N·s/m]), a mass-proportional rate [1/s], or a restitution, which
/// becomes the `critical` factor 2·zeta·sqrt(kn); restitution.hpp has its zeta.
struct Dashpot {
  double constant = 0.0;  ///< [N·s/m]
  double rate = 0.0;      ///< [1/s]
  double critical = 0.0;  ///< [sqrt(N/m)]
};

/// Liquid between two that have touched.
struct Bridge {
  double surface_tension = 0.0;  ///< sigma [N/m]
  double contact_angle = 0.0;    ///< theta [rad]
  double volume = 0.0;           ///< V [m³]; 0: there is none
};

/// What a deck says of a pair of materials; a law of contact reads its part.
struct ContactConstants {
  // any law
  double mu = 0.0;                    ///< Coulomb friction
  std::optional<double> restitution;  ///< what a dashpot was solved for; kernels do not read it
  bool is_mixed = false;              ///< from the constants of two materials

  // linear
  double kn = 0.0;              ///< normal stiffness [N/m]
  double kt = 0.0;              ///< tangential stiffness [N/m]
  double kt_ratio = 2.0 / 7.0;  ///< kt/kn, where springs follow from E and the radii
  Dashpot cn;
  Dashpot ct;

  // elastic: a material's own moduli, which a pair of one material with itself keeps
  double young_modulus = 0.0;           ///< E [Pa]
  std::optional<double> poisson_ratio;  ///< nu
  bool is_rigid = false;                ///< 1/E = 0
  // and what two materials have together
  double young_star = 0.0;        ///< Hertz: E*; linear: the harmonic mean of E [Pa]
  double shear_star = 0.0;        ///< G* [Pa]
  double alpha = 0.0;             ///< of the normal dashpot alpha·sqrt(m_eff·4/3·E*·a)
  double tangential_ratio = 1.0;  ///< tangential over normal dashpot

  // rolling
  double mu_rolling = 0.0;  ///< largest moment over R·|fn|
  double kr = 0.0;          ///< rolling stiffness [N/m], beside kr_ratio times the tangential one
  double kr_ratio = 1.0;
  double cr = 0.0;  ///< rolling dashpot [N·s/m]

  // adhesion
  double surface_energy = 0.0;    ///< gamma [J/m²]
  double cohesion_density = 0.0;  ///< [J/m³]
  Bridge bridge;
};

/// How the tangential force of a Hertz contact follows a contact area that shrinks or grows.
enum class Tangential {
  Mindlin,             ///< increments of force; scaled down on unloading, never up
  MindlinDisplacement  ///< stiffness times displacement
};

/// What pulls in Hertz contacts that stick.
enum class Adhesion { None, Dmt, Sjkr, Sjkr2, Bridge };

/// When a JKR contact that is pulled apart ends.
enum class PullOff {
  Limit,  ///< where no balance is left
  Peak    ///< where the pull is largest
};

/// Rules for all contacts of a run.
struct ContactRules {
  bool no_tension = true;  ///< clamp the normal force at zero while particles part
  Tangential tangential = Tangential::Mindlin;
  bool twisting = false;  ///< resistance to twisting, by those laws that have it
  Adhesion adhesion = Adhesion::None;
  PullOff pull_off = PullOff::Limit;
};

/// Two that meet.
struct Impact {
  double mass = 0.0;    ///< reduced [kg]
  double radius = 0.0;  ///< reduced, 1/(1/r_i + 1/r_j) [m]; a wall is flat: the particle's own
  double speed = 0.0;   ///< along the normal [m/s]
};

/// Where two overlap.
struct Overlap {
  double depth = 0.0;           ///< [m]
  double inverse_radius = 0.0;  ///< 1/r_i + 1/r_j [1/m]
  double reach = 0.0;           ///< r_i + r_j, at a wall r_i [m]
};

}  // namespace barchan
