#pragma once

namespace barchan {

/// What is lost through a contact in a step, by what takes it [J].
struct Losses {
  double dashpots = 0.0;  ///< along the normal and, where it sticks, across it
  double sliding = 0.0;   ///< and what the tangential spring takes up
  double rolling = 0.0;   ///< and twisting: by springs and dashpots

  [[nodiscard]] double sum() const { return dashpots + sliding + rolling; }
};

/// What losses of a step go by.
struct LossTimes {
  double stretch = 0.0;  ///< over which springs stretch: the step before [s]
  double kick = 0.0;     ///< over which forces act: half of that and half of the coming step [s]
};

/// A contact as it was when the numbers of a history were kept.
struct KeptContact {
  double kt = 0.0;    ///< tangential stiffness [N/m]
  double area = 0.0;  ///< squared radius of the contact [m²]
};

}  // namespace barchan
