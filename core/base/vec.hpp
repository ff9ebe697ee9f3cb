#pragma once

#include <limits>

#include <Eigen/Core>

namespace barchan {

/// A point or direction in `Dim` dimensions [SI]. Unaligned, so that it may live in any container.
template <int Dim>
using Vec = Eigen::Matrix<double, Dim, 1, Eigen::DontAlign>;

/// Components of an angular velocity: one in 2D (about z), three in 3D.
template <int Dim>
inline constexpr int kSpins = Dim == 2 ? 1 : 3;

template <int Dim>
using Spin = Eigen::Matrix<double, kSpins<Dim>, 1, Eigen::DontAlign>;

/// Dimension-free vector of decks and files: 2D leaves the third component zero.
using Vec3 = Vec<3>;

inline constexpr double kInfinite = std::numeric_limits<double>::infinity();

}  // namespace barchan
