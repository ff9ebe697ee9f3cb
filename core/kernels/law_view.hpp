#pragma once

#include <utility>

namespace barchan {

/// The law table as a kernel sees it (law_table.hpp owns it); what a field means is the law's
/// (laws/*.hpp). Kernel files call no inline function that plain code has, too: theirs is compiled
/// for wider machines and must not be shared with the rest of the program.
struct LawView {
  static constexpr int kRow = 16;    ///< doubles per pair of materials in `rows`
  static constexpr int kColumn = 8;  ///< pairs that fit a vector register, see `columns`

  const double* rows = nullptr;     ///< pair c, field f at rows[c·kRow + f]
  const double* columns = nullptr;  ///< pair c < 8, field f at columns[f·kColumn + c]
  int size = 0;
};

/// The place of a field in a row, known when a kernel is compiled.
template <int F>
struct LawField {
  static constexpr int kPlace = F;
};

template <class Law>
using FieldsOf = std::make_integer_sequence<int, Law::kNumFields>;

/// Constants from look(LawField), field by field.
template <class Law, class S, class Look, int... F>
[[gnu::always_inline]] inline typename Law::template Constants<S> constants_from(
    const Look& look, std::integer_sequence<int, F...> /*fields*/) {
  return {look(LawField<F>{})...};
}

/// What a look-up of constants gives. By reference if it is the same for all pairs: compilers copy
/// hundreds of bytes for every batch otherwise.
template <class Law, class S, bool OneRow>
struct LookedOf {
  using Type = typename Law::template Constants<S>;
};
template <class Law, class S>
struct LookedOf<Law, S, true> {
  using Type = const typename Law::template Constants<S>&;
};
template <class Law, class S, bool OneRow>
using Looked = typename LookedOf<Law, S, OneRow>::Type;

}  // namespace barchan
