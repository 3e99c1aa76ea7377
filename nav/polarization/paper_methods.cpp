#include "nav/polarization/paper_methods.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "nav/api/geometry.h"

namespace polnav::nav {
namespace {

constexpr std::size_t kFewest = 8;

// N x 3: unit E-vectors in L.
using EVectors = Eigen::MatrixX3d;

EVectors EVectorsOf(const SkyBlocks& sky) {
  EVectors vectors(sky.size(), 3);
  for (Eigen::Index i = 0; i < sky.size(); ++i) {
    const double phi = 0.5 * std::atan2(sky.u[i], sky.q[i]);
    vectors.row(i) = std::cos(phi) * sky.x.row(i).matrix().cast<double>() +
                     std::sin(phi) * sky.y.row(i).matrix().cast<double>();
  }
  return vectors;
}

Eigen::Vector3d SunAt(double angle_rad, double elevation_rad) {
  return {std::cos(elevation_rad) * std::cos(angle_rad),
          std::cos(elevation_rad) * std::sin(angle_rad), std::sin(elevation_rad)};
}

// [h, -b] of one E-vector: h x = b.
Eigen::Vector3d RowOf(const Eigen::Vector3d& e, double elevation_rad) {
  return {std::cos(elevation_rad) * e.x(), std::cos(elevation_rad) * e.y(),
          std::sin(elevation_rad) * e.z()};
}

// Sum of rows' outer products over the blocks that are used.
Eigen::Matrix3d Moments(const EVectors& vectors, const std::vector<bool>& used,
                        double elevation_rad) {
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < vectors.rows(); ++i) {
    if (!used[static_cast<std::size_t>(i)]) continue;
    const Eigen::Vector3d row = RowOf(vectors.row(i).transpose(), elevation_rad);
    moments += row * row.transpose();
  }
  return moments;
}

// Without an elevation the rows are e itself, and the unknown is the sun's direction.
double AxisOf(const EVectors& vectors, const std::vector<bool>& used, Eigen::Vector3d& sun) {
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < vectors.rows(); ++i) {
    if (used[static_cast<std::size_t>(i)]) {
      moments += vectors.row(i).transpose() * vectors.row(i);
    }
  }
  sun = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors().col(0);
  return std::atan2(sun.y(), sun.x());
}

// [Fan2020, eqs 15-18, mended]: z = (1, x) up to scale is the smallest right singular vector of
// [-b h], that is the eigenvector of the smallest eigenvalue of its moments.
double TotalLeastSquares(const Eigen::Matrix3d& moments) {
  const Eigen::Vector3d v =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors().col(0);
  const double first = v.z();
  const Eigen::Vector2d x = v.head<2>() * (first < 0.0 ? -1.0 : 1.0);
  return std::atan2(x.y(), x.x());
}

double LeastSquares(const Eigen::Matrix3d& moments) {
  const Eigen::Matrix2d normal = moments.topLeftCorner<2, 2>();
  const Eigen::Vector2d x = normal.ldlt().solve(-moments.topRightCorner<2, 1>());
  // A sun at the horizon has b = 0, and the least of |h x| over unit x is left.
  if (!(x.norm() > 1e-6)) {
    const Eigen::Vector2d least =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(normal).eigenvectors().col(0);
    return std::atan2(least.y(), least.x());
  }
  return std::atan2(x.y(), x.x());
}

// Angle between each E-vector and the one that a sun there would give, and how fast it turns with
// the sun's azimuth.
void Residuals(const SkyBlocks& sky, const EVectors& vectors, const Eigen::Vector3d& sun,
               Eigen::ArrayXd& residual, Eigen::ArrayXd& turn) {
  const Eigen::Index size = sky.size();
  residual.resize(size);
  turn.resize(size);
  const Eigen::Vector3d moved(-sun.y(), sun.x(), 0.0);
  for (Eigen::Index i = 0; i < size; ++i) {
    const Eigen::Vector3d ray = sky.z.row(i).matrix().transpose().cast<double>();
    const Eigen::Vector3d e = vectors.row(i).transpose();
    const double across = std::max(ray.cross(sun).norm(), 1e-6);
    residual[i] = std::asin(std::clamp(e.dot(sun) / across, -1.0, 1.0));
    turn[i] = e.dot(moved) / across;
  }
}

// Scatter of the tiles' own answers, over the number of tiles.
double SigmaOf(const SkyBlocks& sky, const EVectors& vectors, const Eigen::Vector3d& sun,
               const std::vector<bool>& used) {
  Eigen::ArrayXd residual;
  Eigen::ArrayXd turn;
  Residuals(sky, vectors, sun, residual, turn);
  std::vector<std::array<double, 2>> tiles;  // of turn * residual and turn^2
  double information = 0.0;
  for (Eigen::Index i = 0; i < sky.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    if (!used[k]) continue;
    const auto tile = static_cast<std::size_t>(sky.tile[k]);
    if (tiles.size() <= tile) tiles.resize(tile + 1, {0.0, 0.0});
    tiles[tile][0] += turn[i] * residual[i];
    tiles[tile][1] += turn[i] * turn[i];
    information += turn[i] * turn[i];
  }
  double spread = 0.0;
  for (const auto& tile : tiles) spread += tile[0] * tile[0];
  return information > 0.0 ? std::sqrt(spread) / information : 1e3;
}

// Angle and sigma from the blocks that fit.used names. solve: moments to the sun's angle.
void SolveUsed(const SkyBlocks& sky, const EVectors& vectors,
               std::optional<double> sun_elevation_rad, double (*solve)(const Eigen::Matrix3d&),
               PaperFit& fit) {
  Eigen::Vector3d sun;
  if (sun_elevation_rad) {
    fit.angle_rad = solve(Moments(vectors, fit.used, *sun_elevation_rad));
    sun = SunAt(fit.angle_rad, *sun_elevation_rad);
  } else {
    fit.angle_rad = AxisOf(vectors, fit.used, sun);
  }
  fit.sigma_rad = SigmaOf(sky, vectors, sun, fit.used);
}

// A hash with full avalanche: the same draw for the same number, everywhere.
std::uint32_t Draw(std::uint32_t number) {
  std::uint32_t x = number * 0x9E3779B9U + 0x7F4A7C15U;
  x = (x ^ (x >> 16)) * 0x7FEB352DU;
  x = (x ^ (x >> 15)) * 0x846CA68BU;
  return x ^ (x >> 16);
}

// The two azimuths at which one E-vector fits, or the sun that two E-vectors give.
std::vector<Eigen::Vector3d> Proposals(const EVectors& vectors, std::uint32_t sample,
                                       std::optional<double> elevation_rad) {
  const auto count = static_cast<std::uint64_t>(vectors.rows());
  const auto pick = [&](std::uint32_t number) {
    return static_cast<Eigen::Index>((Draw(number) * count) >> 32U);
  };
  const Eigen::Vector3d e = vectors.row(pick(2 * sample)).transpose();
  if (!elevation_rad) {
    const Eigen::Vector3d other = vectors.row(pick(2 * sample + 1)).transpose();
    const Eigen::Vector3d sun = e.cross(other);
    if (sun.norm() < 1e-3) return {};
    return {sun.normalized()};
  }
  const Eigen::Vector3d row = RowOf(e, *elevation_rad);
  const double cosine = -row.z() / row.head<2>().norm();
  if (!(std::abs(cosine) <= 1.0)) return {};
  const double middle = std::atan2(row.y(), row.x());
  return {SunAt(middle + std::acos(cosine), *elevation_rad),
          SunAt(middle - std::acos(cosine), *elevation_rad)};
}

}  // namespace

std::optional<PaperFit> FitLeastSquares(const SkyBlocks& sky,
                                        std::optional<double> sun_elevation_rad) {
  if (static_cast<std::size_t>(sky.size()) < kFewest) return std::nullopt;
  const EVectors vectors = EVectorsOf(sky);
  PaperFit fit;
  fit.used.assign(static_cast<std::size_t>(sky.size()), true);
  SolveUsed(sky, vectors, sun_elevation_rad, LeastSquares, fit);
  return fit;
}

std::optional<PaperFit> FitRansacTls(const CompassOptions& options, const SkyBlocks& sky,
                                     std::optional<double> sun_elevation_rad) {
  if (static_cast<std::size_t>(sky.size()) < kFewest) return std::nullopt;
  const EVectors vectors = EVectorsOf(sky);
  const double threshold_rad = DegToRad(options.ransac_threshold_deg);
  PaperFit fit;
  Eigen::Index most = 0;
  Eigen::ArrayXd residual;
  Eigen::ArrayXd turn;
  for (int sample = 0; sample < options.ransac_samples; ++sample) {
    for (const Eigen::Vector3d& sun :
         Proposals(vectors, static_cast<std::uint32_t>(sample), sun_elevation_rad)) {
      Residuals(sky, vectors, sun, residual, turn);
      const Eigen::Index agree = (residual.abs() < threshold_rad).count();
      if (agree <= most) continue;
      most = agree;
      fit.used.assign(static_cast<std::size_t>(sky.size()), false);
      for (Eigen::Index i = 0; i < sky.size(); ++i) {
        fit.used[static_cast<std::size_t>(i)] = std::abs(residual[i]) < threshold_rad;
      }
    }
  }
  if (static_cast<std::size_t>(most) < kFewest) return std::nullopt;
  SolveUsed(sky, vectors, sun_elevation_rad, TotalLeastSquares, fit);
  return fit;
}

std::optional<PaperFit> ReadZenith(const CompassOptions& options, const SkyBlocks& sky,
                                   std::optional<double> sun_elevation_rad) {
  const auto least_up = static_cast<float>(std::cos(DegToRad(options.zenith_patch_deg)));
  // The E-vector of the sum: as axes of L's horizontal plane, (q, u) turned to L's x.
  double q = 0.0;
  double u = 0.0;
  PaperFit fit;
  fit.used.assign(static_cast<std::size_t>(sky.size()), false);
  int blocks = 0;
  for (Eigen::Index i = 0; i < sky.size(); ++i) {
    if (sky.z(i, 2) < least_up) continue;
    fit.used[static_cast<std::size_t>(i)] = true;
    ++blocks;
    const double double_turn = 2.0 * std::atan2(sky.x(i, 1), sky.x(i, 0));
    q += sky.q[i] * std::cos(double_turn) - sky.u[i] * std::sin(double_turn);
    u += sky.q[i] * std::sin(double_turn) + sky.u[i] * std::cos(double_turn);
  }
  if (blocks == 0 || !(std::hypot(q, u) > 0.0)) return std::nullopt;
  fit.angle_rad = WrapHalfPi(0.5 * std::atan2(u, q) + 0.5 * std::numbers::pi);
  const EVectors vectors = EVectorsOf(sky);
  // Blocks of the patch are one tile or four: their scatter says little, so each counts alike.
  Eigen::ArrayXd residual;
  Eigen::ArrayXd turn;
  Residuals(sky, vectors, SunAt(fit.angle_rad, sun_elevation_rad.value_or(0.0)), residual, turn);
  double square = 0.0;
  for (Eigen::Index i = 0; i < sky.size(); ++i) {
    if (fit.used[static_cast<std::size_t>(i)]) square += residual[i] * residual[i];
  }
  fit.sigma_rad = std::sqrt(square / blocks);
  return fit;
}

}  // namespace polnav::nav
