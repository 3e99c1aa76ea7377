// What kind of haze and sea does the sky `hazy` have?
//
// Fitted to a grid of the vector radiative transfer code OSOAA [Chami2015] by tools/sky_fit: sun 10
// to 75 degrees high, aerosol optical thickness 0 to 0.3, 450 and 550 nm, Shettle and Fenn's
// maritime haze over a sea under 5 m/s of wind. docs/hazy_sky.md has the residuals.
#pragma once

namespace polnav::sky::haze {

// Air and sea.
inline constexpr double kMolecules = 0.9805;       // of the molecules' optical thickness
inline constexpr double kSlopeVariance = 0.0225;   // of the waves, both directions together
inline constexpr double kWaterAlbedo450 = 0.0085;  // at 450 nm
inline constexpr double kWaterPower = -8.84;       // of the wavelength

// Haze.
inline constexpr double kAlbedo = 0.99;       // what is scattered, not absorbed
inline constexpr double kAngstrom = 0.1249;   // thickness goes as wavelength to the minus this
inline constexpr double kForward = 0.3482;    // share of the forward peak
inline constexpr double kMoment1 = 0.6198;    // mean cosine of scattering, peak included
inline constexpr double kMoment2 = 0.5744;    // mean second Legendre polynomial
inline constexpr double kPolarized = 0.6943;  // the same for polarization that is kept

// Phase function peak(cos) + even0 + even1 cos + even2 cos^2 of the scattering angle, with
// peak(cos) = (peak / (peak_at - cos))^2, and its polarization across the plane of scattering over
// sin^2: across0 + across1 cos + across_peak peak(cos).
inline constexpr double kPeak = 0.5041;
inline constexpr double kPeakAt = 1.1512;
inline constexpr double kEven0 = 0.0283;
inline constexpr double kEven1 = -0.1063;
inline constexpr double kEven2 = 0.2688;
inline constexpr double kAcross0 = 0.0717;
inline constexpr double kAcross1 = -0.0887;
inline constexpr double kAcrossPeak = -0.0191;  // with the phase function's peak
inline constexpr double kAcrossPower = 1.4194;  // it goes as wavelength to the minus this

}  // namespace polnav::sky::haze
