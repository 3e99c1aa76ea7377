#include "sky/haze_scattering.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sky/haze_constants.h"

namespace polnav::sky {

namespace {

using std::numbers::pi;

constexpr int kMostOrders = 15;             // of scattering
constexpr double kFaintest = 1e-6;          // light that is not followed further, over the sun's
constexpr int kHazeProfilePower = 4;        // scale height of air over that of haze
constexpr double kDepolarization = 0.0279;  // of air

// Gauss and Legendre on (0, 1): sines of elevation on which light is followed, down and up.
constexpr int kStreams = 8;
using Streams = Eigen::Array<double, kStreams, 1>;
const Streams kSines = (Streams() << 0.01985507175123188, 0.10166676129318664, 0.23723379504183550,
                        0.40828267875217510, 0.59171732124782490, 0.76276620495816450,
                        0.89833323870681336, 0.98014492824876812)
                           .finished();
const Streams kWeights = (Streams() << 0.05061426814518813, 0.11119051722668724,
                          0.15685332293894364, 0.18134189168918100, 0.18134189168918100,
                          0.15685332293894364, 0.11119051722668724, 0.05061426814518813)
                             .finished();

// What each order's moment at each level is multiplied by, for the four kinds of HazeOptics.
struct Kernel {
  Eigen::ArrayXXd ii, iq, qq, uu;

  [[nodiscard]] HazeLight operator()(const HazeLight& moments) const {
    const auto i = moments.i.array();
    const auto q = moments.q.array();
    return {ii * i + iq * q, iq * i + qq * q, uu * moments.u.array()};
  }
};

// Half the moments of scattering: fields are sums over m of cosines, of which each is half.
Kernel ByHaze(int m, const LitAir& air) {
  const auto half = [&](const HazeMoments& moments) -> Eigen::ArrayXXd {
    const Eigen::Map<const Eigen::VectorXd> all(moments.data(), kHazeOrders + 1);
    return 0.5 * all.tail(kHazeOrders + 1 - m) * air.haze.matrix().transpose();
  };
  return {half(air.optics.ii), half(air.optics.iq), half(air.optics.qq), half(air.optics.uu)};
}

// Rayleigh's scattering: p11 = 1 + share / 2 P2, and what goes with it.
Kernel ByAir(int m, const LitAir& air) {
  const double share = (1.0 - kDepolarization) / (1.0 + 0.5 * kDepolarization);
  HazeMoments ii{1.0, 0.0, 0.5 * share};
  HazeMoments iq{0.0, 0.0, -0.5 * std::sqrt(6.0) * share};
  HazeMoments qq{0.0, 0.0, 3.0 * share};
  const auto half = [&](const HazeMoments& moments) -> Eigen::ArrayXXd {
    const Eigen::Map<const Eigen::VectorXd> all(moments.data(), kHazeOrders + 1);
    return 0.5 * all.tail(kHazeOrders + 1 - m) * air.molecules.matrix().transpose();
  };
  return {half(ii), half(iq), half(qq), half({})};
}

// A ray's share in one mode, over its intensity.
double ModeOfRay(int m) { return (m == 0 ? 0.5 : 1.0) / pi; }

HazeLight Sunlight(int m, const LitAir& air) {
  const HazeBasis basis(m, Eigen::ArrayXd::Constant(1, air.sine));
  const Eigen::RowVectorXd light = ModeOfRay(m) * air.sun.matrix().transpose();
  const Eigen::RowVectorXd none = Eigen::RowVectorXd::Zero(kHazeLevels);
  return basis.Moments({light, none, none});
}

HazeLight Glint(int m, const LitAir& air, const std::vector<GlintRay>& rays) {
  const auto count = static_cast<Eigen::Index>(rays.size());
  Eigen::ArrayXd sines(count);
  HazeLight light{Eigen::MatrixXd(count, kHazeLevels), Eigen::MatrixXd(count, kHazeLevels),
                  Eigen::MatrixXd(count, kHazeLevels)};
  for (Eigen::Index k = 0; k < count; ++k) {
    const GlintRay& ray = rays[static_cast<std::size_t>(k)];
    sines[k] = ray.from.z();
    const double azimuth = std::atan2(ray.from.y(), ray.from.x());
    const Eigen::Vector3d stokes = ray.Stokes();
    const HazeProfile fade = ModeOfRay(m) * air.sun[kHazeLevels - 1] *
                             ((air.depth - air.depth[kHazeLevels - 1]) / ray.up).exp();
    light.i.row(k) = stokes[0] * std::cos(m * azimuth) * fade;
    light.q.row(k) = stokes[1] * std::cos(m * azimuth) * fade;
    light.u.row(k) = stokes[2] * std::sin(m * azimuth) * fade;
  }
  return HazeBasis(m, sines).Moments(light);
}

// Follows one mode of light from scattering to scattering.
class Transfer {
 public:
  Transfer(int m, const LitAir& air) : m_(m), air_(air), down_(m, kSines), up_(m, -kSines) {
    for (int j = 0; j + 1 < kHazeLevels; ++j) {
      const Streams x = ((air.depth[j + 1] - air.depth[j]) / kSines).max(1e-12);
      through_.col(j) = (-x).exp();
      mean_.col(j) = (1.0 - through_.col(j).array()) / x;
    }
    const Streams raised = (kSines.square() + haze::kSlopeVariance).sqrt().min(1.0);
    for (int k = 0; k < kStreams; ++k) {
      const Fresnel r = ReflectanceOfWater(raised[k]);
      mirror_.row(k) << r.s * r.s, r.p * r.p, r.s * r.p;
    }
  }

  // Moments of light that was scattered once more, from those of what the levels send out.
  // sunlit: irradiance of the sea by what lit the air before.
  [[nodiscard]] HazeLight Next(const HazeLight& source, double sunlit) const {
    const HazeLight falling = Gather(down_.Shown(source), nullptr, true);
    const HazeLight start = Mirrored(falling, sunlit);
    const HazeLight rising = Gather(up_.Shown(source), &start, false);
    HazeLight moments = down_.Moments(Weighted(falling));
    moments += up_.Moments(Weighted(rising));
    return moments;
  }

 private:
  // Along the streams through layers whose sources are linear between their ends.
  [[nodiscard]] HazeLight Gather(const HazeLight& source, const HazeLight* start,
                                 bool falling) const {
    const auto gather = [&](const Eigen::MatrixXd& from, const Eigen::MatrixXd* first) {
      Eigen::MatrixXd light(kStreams, kHazeLevels);
      Streams ray = first != nullptr ? Streams(first->col(0).array()) : Streams::Zero();
      const int begin = falling ? 0 : kHazeLevels - 1;
      const int step = falling ? 1 : -1;
      light.col(begin) = ray;
      for (int j = begin + step; j >= 0 && j < kHazeLevels; j += step) {
        const auto through = through_.col(falling ? j - 1 : j).array();
        const auto mean = mean_.col(falling ? j - 1 : j).array();
        ray = ray * through + from.col(j - step).array() * (mean - through) +
              from.col(j).array() * (1.0 - mean);
        light.col(j) = ray;
      }
      return light;
    };
    return {gather(source.i, start != nullptr ? &start->i : nullptr),
            gather(source.q, start != nullptr ? &start->q : nullptr),
            gather(source.u, start != nullptr ? &start->u : nullptr)};
  }

  [[nodiscard]] static HazeLight Weighted(const HazeLight& light) {
    const auto weights = kWeights.matrix().asDiagonal();
    return {weights * light.i, weights * light.q, weights * light.u};
  }

  // What the sea sends up of what falls on it.
  [[nodiscard]] HazeLight Mirrored(const HazeLight& falling, double sunlit) const {
    const Streams i = falling.i.rightCols<1>();
    const Streams q = falling.q.rightCols<1>();
    const Streams u = falling.u.rightCols<1>();
    const Streams across = 0.5 * mirror_.col(0) * (i - q);
    const Streams along = 0.5 * mirror_.col(1) * (i + q);
    Streams up = along + across;
    if (m_ == 0) {
      const double lit = sunlit + 2.0 * pi * (i * kSines * kWeights).sum();
      up += air_.water_albedo * lit / pi;
    }
    return {up, along - across, mirror_.col(2) * u};
  }

  int m_;
  const LitAir& air_;
  HazeBasis down_, up_;
  Eigen::Matrix<double, kStreams, kHazeLevels - 1> through_, mean_;
  Eigen::Array<double, kStreams, 3> mirror_;  // across, along, both
};

}  // namespace

HazeAir HazeAirOf(double aot, double wavelength_nm) {
  const double um2 = wavelength_nm * wavelength_nm * 1e-6;
  // Molecules at sea level [Hansen1974].
  const double molecules = 0.008569 / (um2 * um2) * (1.0 + 0.0113 / um2 + 0.00013 / (um2 * um2));
  const HazeOptics optics = HazeOpticsAt(wavelength_nm);
  return {
      .molecules = haze::kMolecules * molecules,
      .haze = aot * optics.extinction,
      .water_albedo = haze::kWaterAlbedo450 * std::pow(wavelength_nm / 450.0, haze::kWaterPower),
      .optics = optics};
}

LitAir Light(const HazeAir& air, double sun_elevation_rad) {
  const HazeProfile pressure = HazeProfile::LinSpaced(0.0, 1.0);  // over the ground's
  const HazeOptics& optics = air.optics;
  const double kept = 1.0 - optics.albedo * optics.forward;
  const HazeProfile slope =
      air.haze * kept * kHazeProfilePower * pressure.pow(kHazeProfilePower - 1);
  LitAir lit{.sine = std::sin(sun_elevation_rad),
             .cosine = std::cos(sun_elevation_rad),
             .water_albedo = air.water_albedo,
             .optics = optics,
             .depth = air.molecules * pressure + air.haze * kept * pressure.pow(kHazeProfilePower),
             .molecules = air.molecules / (air.molecules + slope),
             .haze = {},
             .sun = {}};
  lit.haze = (1.0 - lit.molecules) * optics.albedo * (1.0 - optics.forward) / kept;
  lit.sun = (-lit.depth / lit.sine).exp();
  return lit;
}

HazeLight Scatter(int m, const LitAir& air, const std::vector<GlintRay>& glint) {
  const Transfer transfer(m, air);
  const Kernel by_air = ByAir(m, air);
  const Kernel by_haze = ByHaze(m, air);
  const HazeLight sunlight = Sunlight(m, air);
  HazeLight light = Glint(m, air, glint);
  HazeLight sent = by_air(sunlight);
  HazeLight source = by_haze(sunlight);
  source += sent;
  const HazeLight of_glint = by_air(light);
  sent += of_glint;
  source += of_glint;
  const HazeLight of_glint_by_haze = by_haze(light);
  sent += of_glint_by_haze;
  source += of_glint_by_haze;
  for (int order = 0; order < kMostOrders; ++order) {
    light = transfer.Next(source, order == 0 ? air.sine * air.sun[kHazeLevels - 1] : 0.0);
    source = by_air(light);
    source += by_haze(light);
    sent += source;
    if (light.i.cwiseAbs().maxCoeff() < kFaintest) break;
  }
  return sent;
}

}  // namespace polnav::sky
