#include "sky/haze_scattering.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sky/haze_constants.h"

namespace polnav::sky {

namespace {

using std::numbers::pi;

constexpr int kOrders = 12;                 // of scattering, at most
constexpr double kFaintest = 1e-6;          // light that is not followed further, over the sun's
constexpr int kHazeProfilePower = 4;        // scale height of air over that of haze
constexpr double kDepolarization = 0.0279;  // of air

// Of scattering by air, what goes by the tensor; the rest is even and unpolarized.
constexpr double kTensorShare = (1.0 - kDepolarization) / (1.0 + 0.5 * kDepolarization);

// Gauss and Legendre on (0, 1): sines of elevation on which light is followed, down and up.
constexpr int kStreams = 8;
using Streams = Eigen::Array<double, kStreams, 1>;
using Stokes = Eigen::Array<double, kStreams, 3>;  // I, Q, U along the streams
const Streams kSines = (Streams() << 0.01985507175123188, 0.10166676129318664, 0.23723379504183550,
                        0.40828267875217510, 0.59171732124782490, 0.76276620495816450,
                        0.89833323870681336, 0.98014492824876812)
                           .finished();
const Streams kWeights = (Streams() << 0.05061426814518813, 0.11119051722668724,
                          0.15685332293894364, 0.18134189168918100, 0.18134189168918100,
                          0.15685332293894364, 0.11119051722668724, 0.05061426814518813)
                             .finished();

// A Legendre moment of haze's scattering without the forward peak.
double WithoutPeak(double moment) { return (moment - haze::kForward) / (1.0 - haze::kForward); }

double Moment(int l) {
  return l == 0 ? 1.0 : WithoutPeak(l == 1 ? haze::kMoment1 : haze::kMoment2);
}

// P_l^m over m!, and what stands before the product of two of them in the addition theorem.
double Legendre(int m, int l, double sine) {
  const double cosine2 = std::max(0.0, 1.0 - sine * sine);
  if (m == 2) return cosine2;
  if (m == 1) return std::sqrt(cosine2) * (l == 1 ? 1.0 : sine);
  return l == 0 ? 1.0 : l == 1 ? sine : 1.5 * sine * sine - 0.5;
}
double LegendreWeight(int m, int l) {
  constexpr double kTable[3][3] = {{1.0, 3.0, 5.0}, {0.0, 3.0, 15.0}, {0.0, 0.0, 3.75}};
  return kTable[m][l];
}

// What a unit part of the field's tensor shows along the streams. Parts: mode 0 (xx + yy) / 2 and
// zz; mode 1 xz; mode 2 (xx - yy) / 2. The same numbers weigh the streams in the part's moment.
int Parts(int m) { return m == 0 ? 2 : 1; }
Stokes Shown(int m, int part, const Streams& sine) {
  const Streams cosine2 = 1.0 - sine.square();
  const Streams cosine = cosine2.sqrt();
  Stokes shown;
  if (m == 0 && part == 0) shown << 1.0 + sine.square(), -cosine2, Streams::Zero();
  if (m == 0 && part == 1) shown << cosine2, cosine2, Streams::Zero();
  if (m == 1) shown << -2.0 * sine * cosine, -2.0 * sine * cosine, 2.0 * cosine;
  if (m == 2) shown << -cosine2, 1.0 + sine.square(), -2.0 * sine;
  return shown;
}
double MomentNorm(int m, int part) { return m == 0 ? (part == 0 ? 0.5 * pi : pi) : 0.25 * pi; }

// The sun's own light.
HazeMoments Sunlight(int m, const LitAir& air) {
  const double c = air.cosine;
  HazeMoments sun;
  if (m == 0) sun.tensor = {(0.5 - 0.25 * c * c) * air.sun, 0.5 * c * c * air.sun};
  if (m == 1) sun.tensor[0] = -0.5 * c * air.sine * air.sun;
  if (m == 2) sun.tensor[0] = -0.25 * c * c * air.sun;
  for (int l = m; l < 3; ++l) sun.light[l] = Legendre(m, l, air.sine) * air.sun;
  return sun;
}

HazeMoments Glint(int m, const LitAir& air, const std::vector<GlintRay>& rays) {
  HazeMoments glint;
  for (const GlintRay& ray : rays) {
    const HazeProfile fade = GlintAt(ray, air);
    const Eigen::Matrix3d& e = ray.tensor;
    if (m == 0) {
      glint.tensor[0] += 0.5 * (e(0, 0) + e(1, 1)) * fade;
      glint.tensor[1] += e(2, 2) * fade;
    } else {
      glint.tensor[0] += (m == 1 ? e(0, 2) : 0.5 * (e(0, 0) - e(1, 1))) * fade;
    }
    const double flat = ray.from.head<2>().norm();
    const double azimuth =
        flat > 1e-9 ? std::acos(std::clamp(ray.from.x() / flat, -1.0, 1.0)) : 0.0;
    for (int l = m; l < 3; ++l) {
      glint.light[l] +=
          ray.intensity() * std::cos(m * azimuth) * Legendre(m, l, ray.from.z()) * fade;
    }
  }
  return glint;
}

// Scatters one mode of light once more.
class Scattering {
 public:
  Scattering(int m, const LitAir& air) : m_(m), air_(air) {
    for (int part = 0; part < Parts(m); ++part) {
      down_[part] = Shown(m, part, kSines);
      up_[part] = Shown(m, part, -kSines);
    }
    for (int l = m; l < 3; ++l) {
      down_light_[l] = kSines.unaryExpr([=](double sine) { return Legendre(m, l, sine); });
      up_light_[l] = kSines.unaryExpr([=](double sine) { return Legendre(m, l, -sine); });
    }
    for (int j = 0; j + 1 < kHazeLevels; ++j) {
      const Streams x = (air.depth[j + 1] - air.depth[j]) / kSines;
      through_[j] = (-x).exp();
      mean_[j] = (1.0 - through_[j]) / x;
    }
    const Streams raised = (kSines.square() + haze::kSlopeVariance).sqrt().min(1.0);
    for (int k = 0; k < kStreams; ++k) {
      const Fresnel r = ReflectanceOfWater(raised[k]);
      mirror_.row(k) << r.s * r.s, r.p * r.p, r.s * r.p;
    }
  }

  // sunlit: irradiance of the sea by what lit the air before it was scattered.
  [[nodiscard]] HazeMoments Next(const HazeMoments& light, double sunlit) const {
    HazeMoments next;
    Stokes ray = Stokes::Zero();
    Stokes source = Source(light, down_, down_light_, 0);
    Collect(ray, down_, down_light_, 0, next);
    for (int j = 1; j < kHazeLevels; ++j) {
      const Stokes to = Source(light, down_, down_light_, j);
      ray = Through(ray, source, to, j - 1);
      source = to;
      Collect(ray, down_, down_light_, j, next);
    }
    ray = Mirrored(ray, sunlit);
    source = Source(light, up_, up_light_, kHazeLevels - 1);
    Collect(ray, up_, up_light_, kHazeLevels - 1, next);
    for (int j = kHazeLevels - 2; j >= 0; --j) {
      const Stokes to = Source(light, up_, up_light_, j);
      ray = Through(ray, source, to, j);
      source = to;
      Collect(ray, up_, up_light_, j, next);
    }
    return next;
  }

 private:
  using Shows = std::array<Stokes, 2>;
  using Lights = std::array<Streams, 3>;

  [[nodiscard]] Stokes Source(const HazeMoments& light, const Shows& shown, const Lights& legendre,
                              int j) const {
    const double by_air = TensorByAir() * air_.molecules[j];
    const double by_haze = TensorByHaze() * air_.haze[j];
    Stokes source = Stokes::Zero();
    for (int part = 0; part < Parts(m_); ++part) {
      source.col(0) += by_air * light.tensor[part][j] * shown[part].col(0);
      source.rightCols<2>() +=
          (by_air * light.tensor[part][j] + by_haze * light.polarized[part][j]) *
          shown[part].rightCols<2>();
    }
    for (int l = m_; l < 3; ++l) {
      double by_both = LightByHaze(m_, l) * air_.haze[j];
      if (l == 0) by_both += EvenByAir() * air_.molecules[j];
      source.col(0) += by_both * light.light[l][j] * legendre[l];
    }
    return source;
  }

  // Through layer j, whose source is linear between its ends.
  [[nodiscard]] Stokes Through(const Stokes& ray, const Stokes& from, const Stokes& to,
                               int j) const {
    return ray.colwise() * through_[j] + from.colwise() * (mean_[j] - through_[j]) +
           to.colwise() * (1.0 - mean_[j]);
  }

  void Collect(const Stokes& ray, const Shows& shown, const Lights& legendre, int j,
               HazeMoments& into) const {
    for (int part = 0; part < Parts(m_); ++part) {
      const Eigen::Array3d sums =
          ((ray * shown[part]).colwise() * kWeights).colwise().sum().transpose();
      into.tensor[part][j] += MomentNorm(m_, part) * sums.sum();
      into.polarized[part][j] += MomentNorm(m_, part) * (sums[1] + sums[2]);
    }
    for (int l = m_; l < 3; ++l) {
      into.light[l][j] += (m_ == 0 ? 2.0 : 1.0) * pi * (ray.col(0) * legendre[l] * kWeights).sum();
    }
  }

  [[nodiscard]] Stokes Mirrored(const Stokes& ray, double sunlit) const {
    const Streams across = 0.5 * mirror_.col(0) * (ray.col(0) - ray.col(1));
    const Streams along = 0.5 * mirror_.col(1) * (ray.col(0) + ray.col(1));
    Stokes up;
    up << along + across, along - across, mirror_.col(2) * ray.col(2);
    if (m_ == 0) {
      const double lit = sunlit + 2.0 * pi * (ray.col(0) * kSines * kWeights).sum();
      up.col(0) += air_.water_albedo * lit / pi;
    }
    return up;
  }

  int m_;
  const LitAir& air_;
  Shows down_, up_;
  Lights down_light_, up_light_;
  std::array<Streams, kHazeLevels - 1> through_, mean_;
  Eigen::Array<double, kStreams, 3> mirror_;  // across, along, both
};

}  // namespace

double TensorByAir() { return kTensorShare * 3.0 / (8.0 * pi); }
double EvenByAir() { return (1.0 - kTensorShare) / (4.0 * pi); }
double TensorByHaze() { return WithoutPeak(haze::kPolarized) * 5.0 / (8.0 * pi); }
double LightByHaze(int m, int l) { return Moment(l) * LegendreWeight(m, l) / (4.0 * pi); }

HazeAir HazeAirOf(double aot, double wavelength_nm) {
  const double um2 = wavelength_nm * wavelength_nm * 1e-6;
  // Molecules at sea level [Hansen1974].
  const double molecules = 0.008569 / (um2 * um2) * (1.0 + 0.0113 / um2 + 0.00013 / (um2 * um2));
  return {
      .molecules = haze::kMolecules * molecules,
      .haze = aot * std::pow(wavelength_nm / 550.0, -haze::kAngstrom),
      .water_albedo = haze::kWaterAlbedo450 * std::pow(wavelength_nm / 450.0, haze::kWaterPower)};
}

LitAir Light(const HazeAir& air, double sun_elevation_rad) {
  const HazeProfile pressure = HazeProfile::LinSpaced(0.0, 1.0);  // over the ground's
  const double kept = 1.0 - haze::kAlbedo * haze::kForward;
  const HazeProfile slope =
      air.haze * kept * kHazeProfilePower * pressure.pow(kHazeProfilePower - 1);
  LitAir lit{.sine = std::sin(sun_elevation_rad),
             .cosine = std::cos(sun_elevation_rad),
             .water_albedo = air.water_albedo,
             .depth = air.molecules * pressure + air.haze * kept * pressure.pow(kHazeProfilePower),
             .molecules = air.molecules / (air.molecules + slope),
             .haze = {},
             .sun = {}};
  lit.haze = (1.0 - lit.molecules) * haze::kAlbedo * (1.0 - haze::kForward) / kept;
  lit.sun = (-lit.depth / lit.sine).exp();
  return lit;
}

// What is left of the ray at each level, on its way up.
HazeProfile GlintAt(const GlintRay& ray, const LitAir& air) {
  const double ground = air.depth[kHazeLevels - 1];
  return air.sun[kHazeLevels - 1] * ((air.depth - ground) / ray.up).exp();
}

HazeMoments& HazeMoments::operator+=(const HazeMoments& other) {
  for (std::size_t i = 0; i < tensor.size(); ++i) tensor[i] += other.tensor[i];
  for (std::size_t i = 0; i < polarized.size(); ++i) polarized[i] += other.polarized[i];
  for (std::size_t i = 0; i < light.size(); ++i) light[i] += other.light[i];
  return *this;
}

ScatteredMode Scatter(int m, const LitAir& air, const std::vector<GlintRay>& glint) {
  const Scattering scattering(m, air);
  ScatteredMode mode;
  mode.first = Sunlight(m, air);
  mode.first += Glint(m, air, glint);
  HazeMoments light = mode.first;
  for (int order = 0; order < kOrders; ++order) {
    light = scattering.Next(light, order == 0 ? air.sine * air.sun[kHazeLevels - 1] : 0.0);
    mode.orders += light;
    if (light.light[m].abs().maxCoeff() < kFaintest) break;
  }
  return mode;
}

}  // namespace polnav::sky
