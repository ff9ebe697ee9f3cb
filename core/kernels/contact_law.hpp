#pragma once

#include <algorithm>

#include <barchan/core/kernels/contact_losses.hpp>
#include <barchan/core/kernels/law_view.hpp>
#include <barchan/core/kernels/pair_job.hpp>
#include <barchan/core/laws/contact.hpp>
#include <barchan/core/laws/contact_constants.hpp>
#include <barchan/core/laws/history.hpp>
#include <barchan/core/particles/layout.hpp>
#include <barchan/core/simd/scalar.hpp>

namespace barchan {

/// A law for disks, or for spheres; no functions where it is not for them.
template <int Dim>
struct ContactLawIn {
  using State = TurningPair<simd::Scalar, Dim>;
  using Force = PairForce<simd::Scalar, Dim>;

  History history{};
  /// What acts on the first of a pair; zero where they do not touch.
  /// @param row  constants; `history` is replaced by its value after the step
  Force (*respond)(int level, const double* row, const State& pair, double dt,
                   double* history) = nullptr;
  /// Elastic [J].
  double (*energy)(const double* row, const Overlap& overlap, const double* history) = nullptr;
  /// Of two that overlap so, of a reduced mass [s]; null where it is the same at any overlap.
  double (*stable_step)(const double* row, const Overlap& overlap, double mass) = nullptr;
  /// Squared radius of the contact, through which heat flows [m²]; not above zero: none does.
  double (*area)(const double* row, const Overlap& overlap) = nullptr;
  /// What a contact loses in the step that `respond` is about to make, which has this history; null
  /// where the law does not say.
  Losses (*losses)(int level, const double* row, const State& pair, const LossTimes& times,
                   const double* history) = nullptr;
  /// Of the elastic energy of a contact the parts that sliding and rolling have stored [J]; null as
  /// above.
  Losses (*stored)(const double* row, const Overlap& overlap, const double* history) = nullptr;
};

/// A law of contact as the program sees it, whichever it is. Made from the law's file alone.
struct ContactLaw {
  using Kernel = PairKernel (*)(VectorWidth width, int dim, int variant);

  const char* name;
  int num_fields;
  bool (*is_common)(int field);  ///< the same in every row
  ContactLawIn<2> disks;
  ContactLawIn<3> spheres;
  Kernel kernel;

  template <int Dim>
  [[nodiscard]] const ContactLawIn<Dim>& in() const {
    if constexpr (Dim == 2)
      return disks;
    else
      return spheres;
  }
};

namespace detail {

/// The compile-time level is looked for.
template <class Law, int Dim, int Level>
PairForce<simd::Scalar, Dim> respond_at(int level, const double* row,
                                        const TurningPair<simd::Scalar, Dim>& pair, double dt,
                                        double* history) {
  if constexpr (Level + 1 < Law::kNumLevels) {
    if (level > Level) return respond_at<Law, Dim, Level + 1>(level, row, pair, dt, history);
  }
  constexpr int kLength = Law::template kHistory<Dim>.length;
  static_assert(kLength <= kMostHistory);
  const auto constants = constants_from<Law, simd::Scalar>(
      [row](auto field) { return row[decltype(field)::kPlace]; }, FieldsOf<Law>{});
  double numbers[kLength];
  std::copy_n(history, kLength, numbers);
  typename Law::template Force<simd::Scalar, Dim> force{};
  Law::template respond<simd::Scalar, Level>(constants, pair, dt, numbers, force);
  std::copy_n(numbers, kLength, history);
  return first_of(force);
}

template <class Law, int Dim>
ContactLawIn<Dim> law_in() {
  if constexpr (Dim == 2 && !Law::kIsForDisks) {
    return {};
  } else {
    ContactLawIn<Dim> law{Law::template kHistory<Dim>, &respond_at<Law, Dim, 0>,
                          [](const double* row, const Overlap& overlap, const double* history) {
                            return Law::energy(row, Law::template kHistory<Dim>, overlap, history);
                          }};
    if constexpr (requires(const double* row) { Law::stable_step(row, Overlap{}, 1.0, 1.0); }) {
      law.stable_step = [](const double* row, const Overlap& overlap, double mass) {
        return Law::stable_step(row, overlap, mass, Layout<Dim>::kSpinGain);
      };
    }
    if constexpr (requires { Law::kKeepsForce; }) {
      law.losses = &losses_at<Law, Dim>;
      law.stored = &stored_in<Law, Dim>;
    }
    law.area = [](const double* row, const Overlap& overlap) {
      if constexpr (requires { Law::area(row, overlap); })
        return Law::area(row, overlap);
      else
        return overlap.depth / overlap.inverse_radius;
    };
    return law;
  }
}

}  // namespace detail

/// @param kernel  gives the pair loops that are made for this law
template <class Law>
[[nodiscard]] ContactLaw contact_law(ContactLaw::Kernel kernel) {
  static_assert(Law::kNumFields <= LawView::kRow);
  return {Law::kName,
          Law::kNumFields,
          [](int field) { return Law::is_common(field); },
          detail::law_in<Law, 2>(),
          detail::law_in<Law, 3>(),
          kernel};
}

}  // namespace barchan
