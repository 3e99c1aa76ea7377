// What does a sky model say of one ray?
#pragma once

namespace polnav::sky {

// About the two axes across the ray whose components the model was given.
template <typename T>
struct SkyStokes {
  T radiance;  // relative to the zenith
  T q;         // Q / I
  T u;         // U / I
};

}  // namespace polnav::sky
