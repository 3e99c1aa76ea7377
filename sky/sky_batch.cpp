#include "sky/sky_batch.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>

#include "sky/polynomial.h"

// One version with vectors of 256 bits and one without; without FMA both give the same bytes.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define POLNAV_VECTORIZED __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define POLNAV_VECTORIZED
#endif
#define POLNAV_INLINE [[gnu::always_inline]] inline

namespace polnav::sky {

namespace {

POLNAV_INLINE double Larger(double a, double b) { return a > b ? a : b; }

constexpr std::array<double, 11> kTaylor = {1.0 / 3628800, 1.0 / 362880, 1.0 / 40320, 1.0 / 5040,
                                            1.0 / 720,     1.0 / 120,    1.0 / 24,    1.0 / 6,
                                            0.5,           1.0,          1.0};
// Of numbers in [-700, 0], within 1e-11 of the result.
POLNAV_INLINE double Exponential(double x) {
  constexpr double kMagic = 6755399441055744.0;  // 1.5 2^52: what is added to it gets rounded
  const double shifted = x * std::numbers::log2e + kMagic;
  const double r = x - (shifted - kMagic) * std::numbers::ln2;
  const double sum = Polynomial(kTaylor, r);
  const std::uint64_t power =
      (std::bit_cast<std::uint64_t>(shifted) << 52) + std::bit_cast<std::uint64_t>(1.0);
  return sum * std::bit_cast<double>(power);
}

constexpr std::array<double, 8> kArcCosine = {-0.0012624911, 0.0066700901,  -0.0170881256,
                                              0.0308918810,  -0.0501743046, 0.0889789874,
                                              -0.2145988016, 1.5707963050};
// Within 2e-8 rad [Abramowitz1964, eq. 4.4.46].
POLNAV_INLINE double ArcCosine(double x) {
  const double size = Larger(x, -x);
  const double positive = std::sqrt(Larger(1.0 - size, 0.0)) * Polynomial(kArcCosine, size);
  return x < 0.0 ? std::numbers::pi - positive : positive;
}

// cie_sky.h, but for the constant of the zenith.
POLNAV_INLINE double Brightness(double cos_sun, double sine) {
  const double aureole =
      Exponential(cie12::kAureoleDecay * ArcCosine(cos_sun)) - cie12::kAureoleAcross;
  const double gradation =
      1.0 - Exponential(Larger(cie12::kGradient / Larger(sine, cie12::kHorizonCosine), -700.0));
  return gradation * (1.0 + cie12::kAureole * aureole + cie12::kBackscatter * cos_sun * cos_sun);
}
double BrightnessOfZenith(double sun_sine) {
  return cie12::Indicatrix(std::acos(std::clamp(sun_sine, -1.0, 1.0))) * cie12::Gradation(1.0);
}

// The sun's components along RayAxes; the zenith's are (-flat, 0, up).
struct Ray {
  double s1, s2, cos_sun, flat, up;
};
POLNAV_INLINE Ray RayOf(double east, double north, double up, const Eigen::Vector3d& sun) {
  const double flat2 = east * east + north * north;
  const double inverse = 1.0 / std::sqrt(Larger(flat2, 1e-24));
  const double along_x = flat2 > 1e-24 ? east * inverse : 0.0;
  const double along_y = flat2 > 1e-24 ? north * inverse : 1.0;
  const double flat = flat2 * inverse;
  return {.s1 = up * (sun.x() * along_x + sun.y() * along_y) - sun.z() * flat,
          .s2 = sun.x() * along_y - sun.y() * along_x,
          .cos_sun = sun.x() * east + sun.y() * north + sun.z() * up,
          .flat = flat,
          .up = up};
}

struct Stokes {
  double radiance, q, u;
};

struct RayleighRay {
  double max_dop, over_zenith;
  POLNAV_INLINE Stokes operator()(const Ray& ray) const {
    const double s11 = ray.s1 * ray.s1;
    const double s22 = ray.s2 * ray.s2;
    const double scale = max_dop / (s11 + s22 + 2.0 * (ray.cos_sun * ray.cos_sun));
    return {over_zenith * Brightness(ray.cos_sun, ray.up), (s22 - s11) * scale,
            -2.0 * (ray.s1 * ray.s2) * scale};
  }
};

struct BerryRay {
  double max_dop, over_zenith, sun2, sun_up, up2;
  POLNAV_INLINE Stokes operator()(const Ray& ray) const {
    const double re = sun2 * (ray.s1 * ray.s1 - ray.s2 * ray.s2) - sun_up * (ray.s1 * ray.flat) +
                      up2 * (ray.flat * ray.flat);
    const double im = (2.0 * sun2) * (ray.s1 * ray.s2) - sun_up * (ray.s2 * ray.flat);
    const double scale = max_dop / (2.0 - std::sqrt(re * re + im * im));
    return {over_zenith * Brightness(ray.cos_sun, ray.up), re * scale, im * scale};
  }
};

struct HazyRay {
  HazyCoefficients k;
  double over_zenith;
  POLNAV_INLINE Stokes operator()(const Ray& ray) const {
    const HazyTerms<double> terms{.cos_sun = ray.cos_sun,
                                  .sine = Larger(ray.up, 0.0),
                                  .ss_re = ray.s1 * ray.s1 - ray.s2 * ray.s2,
                                  .ss_im = 2.0 * (ray.s1 * ray.s2),
                                  .su_re = -(ray.s1 * ray.flat),
                                  .su_im = -(ray.s2 * ray.flat),
                                  .uu_re = ray.flat * ray.flat,
                                  .uu_im = 0.0};
    double intensity, q, u;
    HazyStokes(k, terms, intensity, q, u);
    const double inverse = 1.0 / intensity;
    return {over_zenith * intensity, q * inverse, u * inverse};
  }
};

template <typename Model>
POLNAV_INLINE void Fill(const Model& model, const Eigen::Vector3d& sun_W, const RayArrays& rays,
                        const StokesArrays& out) {
  const Model mine = model;  // copies, which nothing that is written can alias
  const Eigen::Vector3d sun = sun_W;
  const double* const east = rays.east.data();
  const double* const north = rays.north.data();
  const double* const up = rays.up.data();
  double* const radiance = out.radiance.data();
  double* const q = out.q.data();
  double* const u = out.u.data();
  const std::size_t count = rays.up.size();
#pragma GCC ivdep
  for (std::size_t i = 0; i < count; ++i) {
    const Stokes stokes = mine(RayOf(east[i], north[i], up[i], sun));
    radiance[i] = stokes.radiance;
    q[i] = stokes.q;
    u[i] = stokes.u;
  }
}

POLNAV_VECTORIZED void FillRayleigh(const RayleighRay& model, const Eigen::Vector3d& sun_W,
                                    const RayArrays& rays, const StokesArrays& out) {
  Fill(model, sun_W, rays, out);
}
POLNAV_VECTORIZED void FillBerry(const BerryRay& model, const Eigen::Vector3d& sun_W,
                                 const RayArrays& rays, const StokesArrays& out) {
  Fill(model, sun_W, rays, out);
}
POLNAV_VECTORIZED void FillHazy(const HazyRay& model, const Eigen::Vector3d& sun_W,
                                const RayArrays& rays, const StokesArrays& out) {
  Fill(model, sun_W, rays, out);
}

}  // namespace

void LookAlong(const ClearSky& sky, const RayArrays& rays_W, const StokesArrays& stokes) {
  const std::size_t count = rays_W.up.size();
  for (const std::size_t size : {rays_W.east.size(), rays_W.north.size(), stokes.radiance.size(),
                                 stokes.q.size(), stokes.u.size()}) {
    if (size != count) throw std::logic_error("LookAlong: arrays of different lengths");
  }
  const Eigen::Vector3d& sun_W = sky.sun_W();
  const double over_zenith = 1.0 / BrightnessOfZenith(sun_W.z());
  if (const auto* rayleigh = std::get_if<RayleighSky>(&sky.model())) {
    FillRayleigh({rayleigh->max_dop, over_zenith}, sun_W, rays_W, stokes);
  } else if (const auto* berry = std::get_if<BerrySky>(&sky.model())) {
    const Eigen::Vector3d w = berry->coefficients();
    FillBerry({berry->max_dop(), over_zenith, w[0], w[1], w[2]}, sun_W, rays_W, stokes);
  } else {
    const HazyCoefficients& k = std::get<HazySky>(sky.model()).coefficients();
    FillHazy({k, 1.0 / k.zenith}, k.of_sun * sun_W + k.of_up * Eigen::Vector3d::UnitZ(), rays_W,
             stokes);
  }
}

}  // namespace polnav::sky
