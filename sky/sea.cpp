#include "sky/sea.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

namespace polnav::sky {

namespace {

constexpr double kWaterIndex = 1.34;
constexpr double kGrazing = 0.03;
// Slopes over their deviation, towards the sun; across it by Gauss and Hermite, one side only.
constexpr double kSlopeStep = 0.25;
constexpr int kSlopeSteps = 12;
struct CrossSlope {
  double slope, weight;
};
const std::array<CrossSlope, 2> kCrossSlopes = {{{0.0, 2.0 / 3.0}, {std::sqrt(3.0), 1.0 / 3.0}}};

}  // namespace

Fresnel ReflectanceOfWater(double cos_incidence) {
  const double c = cos_incidence;
  const double below = std::sqrt(1.0 - (1.0 - c * c) / (kWaterIndex * kWaterIndex));
  return {(c - kWaterIndex * below) / (c + kWaterIndex * below),
          (kWaterIndex * c - below) / (kWaterIndex * c + below)};
}

Eigen::Vector3d GlintRay::Stokes() const {
  const double flat = from.head<2>().norm();
  const double x = flat > 1e-9 ? from.x() / flat : 1.0;
  const double y = flat > 1e-9 ? from.y() / flat : 0.0;
  const Eigen::Vector3d axis1(from.z() * x, from.z() * y, -flat);
  const Eigen::Vector3d axis2(-y, x, 0.0);
  const Eigen::Vector3d of_axis1 = tensor * axis1;
  return {intensity(), axis1.dot(of_axis1) - axis2.dot(tensor * axis2), 2.0 * axis2.dot(of_axis1)};
}

std::vector<GlintRay> SunGlint(double sun_elevation_rad, double slope_variance) {
  const double sigma = std::sqrt(0.5 * slope_variance);
  const Eigen::Vector3d sun(std::cos(sun_elevation_rad), 0.0, std::sin(sun_elevation_rad));
  std::vector<GlintRay> rays;
  double lit = 0.0;  // area of facets, seen from the sun
  for (int step = -kSlopeSteps; step <= kSlopeSteps; ++step) {
    const double slope = kSlopeStep * step;
    for (const CrossSlope& cross : kCrossSlopes) {
      const Eigen::Vector3d facet(-sigma * slope, -sigma * cross.slope, 1.0);
      const Eigen::Vector3d normal = facet.normalized();
      const double cosine = sun.dot(normal);
      if (cosine <= 0.0) continue;
      const double area = cross.weight * std::exp(-0.5 * slope * slope) * sun.dot(facet);
      lit += area;
      const Eigen::Vector3d ray = 2.0 * cosine * normal - sun;
      if (ray.z() <= 0.0) continue;
      const Fresnel r = ReflectanceOfWater(cosine);
      const Eigen::Vector3d across = sun.cross(normal);
      const Eigen::Vector3d s =
          across.norm() > 1e-9 ? across.normalized() : Eigen::Vector3d::UnitY();
      const Eigen::Vector3d p = s.cross(ray);
      const double up = std::hypot(ray.z(), kGrazing);
      const Eigen::Matrix3d tensor = r.s * r.s * s * s.transpose() + r.p * r.p * p * p.transpose();
      rays.push_back({0.5 * area * ray.z() / (up * up) * tensor, -ray, up});
    }
  }
  for (GlintRay& ray : rays) ray.tensor *= sun.z() / lit;
  return rays;
}

}  // namespace polnav::sky
