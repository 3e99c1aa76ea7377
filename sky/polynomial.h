// What is a polynomial at x?
//
// Horner's scheme written out, since compilers turn loops over rays into vector code only where no
// loop is left inside. T: double or ceres::Jet.
#pragma once

#include <array>
#include <cstddef>
#include <utility>

namespace polnav::sky {

template <typename T, std::size_t N, std::size_t... I>
[[gnu::always_inline]] inline T Polynomial(const std::array<double, N>& highest_first, const T& x,
                                           std::index_sequence<I...>) {
  T sum(highest_first[0]);
  ((sum = sum * x + highest_first[I + 1]), ...);
  return sum;
}
template <typename T, std::size_t N>
[[gnu::always_inline]] inline T Polynomial(const std::array<double, N>& highest_first, const T& x) {
  return Polynomial(highest_first, x, std::make_index_sequence<N - 1>());
}

}  // namespace polnav::sky
