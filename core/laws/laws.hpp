#pragma once

#include <type_traits>

#include <barchan/core/laws/hertz_adhesive.hpp>
#include <barchan/core/laws/hertz_bridge.hpp>
#include <barchan/core/laws/hertz_mindlin.hpp>
#include <barchan/core/laws/jkr.hpp>
#include <barchan/core/laws/linear_by_radius.hpp>
#include <barchan/core/laws/linear_spring.hpp>
#include <barchan/core/laws/rolling.hpp>

namespace barchan {

template <class... Ls>
struct LawList {
  static constexpr int kSize = sizeof...(Ls);
};

/// The laws of contact, a file each. Kernels, tables, checks, walls and measures follow from this
/// list. A run has one of them.
using Laws =
    LawList<LinearSpring, HertzMindlin, WithRolling<LinearSpring>, WithRolling<HertzMindlin>,
            HertzAdhesive, WithRolling<HertzAdhesive>, Jkr, WithRolling<Jkr>, HertzBridge,
            WithRolling<HertzBridge>, LinearByRadius, WithRolling<LinearByRadius>>;

/// Whether a law is for disks, or for spheres.
template <class Law, int Dim>
inline constexpr bool kIsFor = Dim == 3 || Law::kIsForDisks;

/// Numbers of the longest history in the list.
template <int Dim, class List = Laws>
inline constexpr int kLongestHistory = 0;
template <int Dim, class First, class... Rest>
inline constexpr int kLongestHistory<Dim, LawList<First, Rest...>> =
    First::template kHistory<Dim>.length > kLongestHistory<Dim, LawList<Rest...>>
        ? First::template kHistory<Dim>.length
        : kLongestHistory<Dim, LawList<Rest...>>;

template <class First, class... Rest, class F>
[[gnu::always_inline]] inline decltype(auto) with_law_of(LawList<First, Rest...> /*list*/,
                                                         [[maybe_unused]] int index, F&& f) {
  if constexpr (sizeof...(Rest) > 0) {
    if (index > 0) return with_law_of(LawList<Rest...>{}, index - 1, f);
  }
  return f(First{});
}

/// Calls f with the law at a place of the list, an empty object of its type. @return what f returns
template <class F>
[[gnu::always_inline]] inline decltype(auto) with_law(int index, F&& f) {
  return with_law_of(Laws{}, index, f);
}

/// Of the law at a place of the list.
template <int Dim>
[[nodiscard]] History history_in(int law) {
  return with_law(law, []<class Law>(Law /*law*/) { return Law::template kHistory<Dim>; });
}

template <int Dim, class... Ls, class F>
[[gnu::always_inline]] inline void with_length_of(LawList<Ls...> /*list*/, int length, F&& f) {
  const auto is_of = [&]<class Law>(Law /*law*/) {
    if constexpr (kIsFor<Law, Dim>) {
      constexpr int kLength = Law::template kHistory<Dim>.length;
      if (length == kLength) return f(std::integral_constant<int, kLength>{}), true;
    }
    return false;
  };
  if (!(is_of(Ls{}) || ...)) f(length);
}

/// Calls f with a length of histories, as a constant where a law of the list has it, so that its
/// loops are unrolled.
template <int Dim, class F>
[[gnu::always_inline]] inline void with_length(int length, F&& f) {
  with_length_of<Dim>(Laws{}, length, f);
}

}  // namespace barchan
