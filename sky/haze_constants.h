// What kind of air and sea does the sky `hazy` have?
//
// Fitted to the haze-free cases alone of a grid of the vector radiative transfer code OSOAA
// [Chami2015] by tools/sky_fit/fit_haze.py: sun 10 to 75 degrees high, 450 and 550 nm, a sea under
// 5 m/s of wind. Haze has no fitted constants (haze_optics.h). docs/hazy_sky.md has the residuals.
#pragma once

namespace polnav::sky::haze {

// Air and sea.
inline constexpr double kMolecules = 0.9805;       // of the molecules' optical thickness
inline constexpr double kSlopeVariance = 0.0225;   // of the waves, both directions together
inline constexpr double kWaterAlbedo450 = 0.0085;  // at 450 nm
inline constexpr double kWaterPower = -8.84;       // of the wavelength

}  // namespace polnav::sky::haze
