#include "sky/haze_optics.h"

#include <algorithm>
#include <cmath>

namespace polnav::sky {

extern const std::array<HazeOptics, kHazeWavelengths> kHazeTable;

namespace {

// Lagrange's weights of the three wavelengths next to the one in question.
struct Neighbours {
  int first;
  std::array<double, 3> weights;
};

Neighbours NeighboursOf(double wavelength_nm) {
  const double place =
      std::clamp((wavelength_nm - kFirstHazeWavelength_nm) / kHazeWavelengthStep_nm, 0.0,
                 kHazeWavelengths - 1.0);
  const int middle = std::clamp(static_cast<int>(std::lround(place)), 1, kHazeWavelengths - 2);
  const double x = place - middle;
  return {middle - 1, {0.5 * x * (x - 1.0), 1.0 - x * x, 0.5 * x * (x + 1.0)}};
}

template <std::size_t N>
void Mix(const Neighbours& at, std::array<double, N> HazeOptics::*member, HazeOptics& mixed) {
  for (std::size_t i = 0; i < N; ++i) {
    double& sum = (mixed.*member)[i];
    sum = 0.0;
    for (std::size_t n = 0; n < 3; ++n) {
      sum += at.weights[n] * (kHazeTable[static_cast<std::size_t>(at.first) + n].*member)[i];
    }
  }
}

void Mix(const Neighbours& at, double HazeOptics::*member, HazeOptics& mixed) {
  mixed.*member = 0.0;
  for (std::size_t n = 0; n < 3; ++n) {
    mixed.*member += at.weights[n] * kHazeTable[static_cast<std::size_t>(at.first) + n].*member;
  }
}

}  // namespace

HazeOptics HazeOpticsAt(double wavelength_nm) {
  const Neighbours at = NeighboursOf(wavelength_nm);
  HazeOptics mixed{};
  for (const auto member : {&HazeOptics::extinction, &HazeOptics::albedo, &HazeOptics::forward}) {
    Mix(at, member, mixed);
  }
  for (const auto member : {&HazeOptics::ii, &HazeOptics::iq, &HazeOptics::qq, &HazeOptics::uu}) {
    Mix(at, member, mixed);
  }
  Mix(at, &HazeOptics::phase, mixed);
  Mix(at, &HazeOptics::polarized, mixed);
  return mixed;
}

}  // namespace polnav::sky
