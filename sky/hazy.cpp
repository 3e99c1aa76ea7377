#include "sky/hazy.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "sky/haze_field.h"

namespace polnav::sky {

namespace {

using std::numbers::pi;
using K = HazyCoefficients;

constexpr int kPowers = K::kDegree + 1;
constexpr int kElevations = 12;  // at which the field is asked, at Chebyshev's nodes of z
constexpr int kAzimuths = 9;     // at each, over half a turn
constexpr int kRays = kElevations * kAzimuths;
constexpr int kTermsOfI = K::kA0;
constexpr int kTermsOfQu = K::kOnce - K::kA0;

double NodeOf(int elevation) { return std::cos(pi * (elevation + 0.5) / kElevations); }

double SineAt(double z, const K& k) {
  const double y = (1.0 + z) / k.stretch;
  return std::min(1.0, k.bend * y / (1.0 - y));
}

// Chebyshev polynomials at z.
Eigen::RowVector<double, kPowers> Chebyshev(double z) {
  Eigen::RowVector<double, kPowers> t;
  t[0] = 1.0;
  t[1] = z;
  for (int n = 2; n < kPowers; ++n) t[n] = 2.0 * z * t[n - 1] - t[n - 2];
  return t;
}

// Least squares of sums over terms times polynomials of z; rows: rays. Near the zenith terms are
// not known apart, only their sum is: the small ridge then takes small coefficients. The result has
// a term's Chebyshev coefficients in each row.
template <int Terms>
Eigen::Matrix<double, Terms, kPowers, Eigen::RowMajor> Fit(const Eigen::MatrixXd& terms,
                                                           const Eigen::VectorXd& values) {
  constexpr double kRidge = 1e-7;
  constexpr int kUnknowns = Terms * kPowers;
  Eigen::Matrix<double, Eigen::Dynamic, kUnknowns> rows(terms.rows(), kUnknowns);
  for (Eigen::Index ray = 0; ray < terms.rows(); ++ray) {
    const auto at_z = Chebyshev(NodeOf(static_cast<int>(ray % kRays / kAzimuths)));
    for (int n = 0; n < Terms; ++n) {
      rows.row(ray).template segment<kPowers>(n * kPowers) = terms(ray, n) * at_z;
    }
  }
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(kUnknowns, kUnknowns);
  normal.selfadjointView<Eigen::Lower>().rankUpdate(rows.transpose());
  normal.diagonal().array() += kRidge * normal.trace();
  const Eigen::VectorXd right = rows.transpose() * values;
  const Eigen::VectorXd solved = normal.selfadjointView<Eigen::Lower>().llt().solve(right);
  return Eigen::Map<const Eigen::Matrix<double, Terms, kPowers, Eigen::RowMajor>>(solved.data());
}

// What HazyStokes needs of the field, by all rays in units of their radiance: relative errors
// count.
struct Sampled {
  Eigen::MatrixXd of_i{kRays, kTermsOfI}, of_qu{2 * kRays, kTermsOfQu};
  Eigen::VectorXd i{kRays}, qu{2 * kRays};
  Eigen::Vector<double, kElevations> once;
};

void Sample(const HazeRay& ray, double mu, double sun_rad, int elevation, Sampled& to) {
  const double flat = std::sqrt(1.0 - mu * mu);
  for (int n = 0; n < kAzimuths; ++n) {
    const double azimuth = pi * (n + 0.5) / kAzimuths;
    double i = 0.0, q = 0.0, u = 0.0;
    for (std::size_t m = 0; m < kHazeModes; ++m) {
      const double turn = static_cast<double>(m) * azimuth;
      i += ray.i[m] * std::cos(turn);
      q += ray.q[m] * std::cos(turn);
      u += ray.u[m] * std::sin(turn);
    }
    const double flat_sun = std::cos(sun_rad) * std::cos(azimuth);
    const double c = flat_sun * flat + std::sin(sun_rad) * mu;
    const std::complex<double> s(flat_sun * mu - std::sin(sun_rad) * flat,
                                 -std::cos(sun_rad) * std::sin(azimuth));
    const std::complex<double> ss = s * s / i;
    const std::complex<double> sz = -flat * s / i;
    const double zz = flat * flat / i;
    const int row = elevation * kAzimuths + n;
    to.i[row] = 1.0;
    to.of_i.row(row) << 1.0 / i, c / i, c * c / i, c * c * c / i, c * c * c * c / i;
    to.qu[row] = q / i;
    to.of_qu.row(row) << ss.real(), c * ss.real(), c * c * ss.real(), sz.real(), c * sz.real(), zz,
        c * zz;
    to.qu[row + kRays] = u / i;
    to.of_qu.row(row + kRays) << ss.imag(), c * ss.imag(), c * c * ss.imag(), sz.imag(),
        c * sz.imag(), 0.0, 0.0;
  }
  to.once[elevation] = ray.sun;
}

// From Chebyshev's polynomials to powers, highest first.
std::array<double, kPowers> PowersOf(const Eigen::RowVector<double, kPowers>& chebyshev) {
  std::array<std::array<double, kPowers>, kPowers> t{};  // polynomial, power
  t[0][0] = 1.0;
  t[1][1] = 1.0;
  std::array<double, kPowers> sum{};
  for (std::size_t n = 0; n < kPowers; ++n) {
    for (std::size_t power = 0; power <= n; ++power) {
      if (n > 1) t[n][power] = (power > 0 ? 2.0 * t[n - 1][power - 1] : 0.0) - t[n - 2][power];
      sum[kPowers - 1 - power] += chebyshev[static_cast<Eigen::Index>(n)] * t[n][power];
    }
  }
  return sum;
}

void Prepare(const HazeField& field, K& k) {
  Sampled sampled;
  Eigen::Matrix<double, kElevations, kPowers> at_nodes;
  for (int elevation = 0; elevation < kElevations; ++elevation) {
    const double mu = SineAt(NodeOf(elevation), k);
    Sample(field.Along(mu), mu, field.sun_elevation_rad(), elevation, sampled);
    at_nodes.row(elevation) = Chebyshev(NodeOf(elevation));
  }
  const auto i = Fit<kTermsOfI>(sampled.of_i, sampled.i);
  const auto qu = Fit<kTermsOfQu>(sampled.of_qu, sampled.qu);
  for (int n = 0; n < kTermsOfI; ++n) k.of_z[K::kI0 + n] = PowersOf(i.row(n));
  for (int n = 0; n < kTermsOfQu; ++n) k.of_z[K::kA0 + n] = PowersOf(qu.row(n));
  // At Chebyshev's nodes the polynomials are orthogonal.
  Eigen::RowVector<double, kPowers> once = 2.0 / kElevations * sampled.once.transpose() * at_nodes;
  once[0] *= 0.5;
  k.of_z[K::kOnce] = PowersOf(once);
}

}  // namespace

HazyCoefficients HazyCoefficientsOf(double aot, double wavelength_nm, double sun_elevation_rad) {
  const HazeAir air = HazeAirOf(aot, wavelength_nm);
  const HazeField field(air, sun_elevation_rad);

  K k;
  k.bend = 0.05 + 0.5 * (air.molecules + air.haze);
  k.stretch = 2.0 * (1.0 + k.bend);
  Prepare(field, k);
  k.phase = air.optics.phase;
  k.polarized = air.optics.polarized;
  const double answered_rad = field.sun_elevation_rad();
  k.of_sun = std::cos(answered_rad) / std::max(std::cos(sun_elevation_rad), 1e-3);
  k.of_up = std::sin(answered_rad) - k.of_sun * std::sin(sun_elevation_rad);

  HazyTerms<double> up{};
  up.cos_sun = std::sin(answered_rad);
  up.sine = 1.0;
  double q = 0.0;
  double u = 0.0;
  HazyStokes(k, up, k.zenith, q, u);
  return k;
}

}  // namespace polnav::sky
