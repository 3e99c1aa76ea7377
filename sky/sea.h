// What does a wavy sea give back of the light that falls on it?
//
// Facets whose slopes are Gaussian [Cox1954] mirror the sun by Fresnel's equations, each in its own
// direction; sky light is mirrored as by a level sea whose steepest rays are raised by the slopes.
// Elements of an electric field's tensor E (the second moment, trace = intensity) are about x below
// the sun, y across and z up. A direction is where light comes from.
// Where it fails: no foam, no wind direction; light that a facet throws downwards is lost, and of
// the rays that graze the sea, those below 2 degrees are thinned out for waves that shade each
// other.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace polnav::sky {

// Amplitude reflectances of water: across the plane of incidence, and in it.
struct Fresnel {
  double s, p;
};
[[nodiscard]] Fresnel ReflectanceOfWater(double cos_incidence);

// The ray of a facet, for sunlight of unit irradiance across its way. It stands for the ray of the
// facet at the other side of the sun's vertical plane too: half of the light comes from there.
struct GlintRay {
  Eigen::Matrix3d tensor;  // of its field, in the air above [-]
  Eigen::Vector3d from;    // unit vector to where it comes from, below the horizon
  double up;               // sine of its elevation as the air attenuates it
  [[nodiscard]] double intensity() const { return tensor.trace(); }
  // I, Q, U about axis 1 away from the zenith and axis 2 towards increasing azimuth (x to y).
  [[nodiscard]] Eigen::Vector3d Stokes() const;
};

[[nodiscard]] std::vector<GlintRay> SunGlint(double sun_elevation_rad, double slope_variance);

}  // namespace polnav::sky
