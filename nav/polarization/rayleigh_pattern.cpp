#include "nav/polarization/rayleigh_pattern.h"

#include <Eigen/Dense>
#include <cmath>

namespace polnav::nav {

RayleighPattern::RayleighPattern(const SkyBlocks& sky, double sun_elevation_rad)
    : sky_(&sky),
      sine_(static_cast<float>(std::sin(sun_elevation_rad))),
      cosine_(static_cast<float>(std::cos(sun_elevation_rad))) {}

void RayleighPattern::At(double angle_rad, Values& values) const {
  const float east = cosine_ * static_cast<float>(std::cos(angle_rad));
  const float north = cosine_ * static_cast<float>(std::sin(angle_rad));
  const Array3Xf& x = sky_->x;
  const Array3Xf& y = sky_->y;
  const Eigen::Index size = sky_->size();
  for (Eigen::ArrayXf* const array :
       {&values.along, &values.across, &values.fraction, &values.turn, &values.mx, &values.my}) {
    array->resize(size);
  }
  const float* const x0 = x.col(0).data();
  const float* const x1 = x.col(1).data();
  const float* const x2 = x.col(2).data();
  const float* const y0 = y.col(0).data();
  const float* const y1 = y.col(1).data();
  const float* const y2 = y.col(2).data();
  for (Eigen::Index i = 0; i < size; ++i) {
    const float sx = x0[i] * east + x1[i] * north + x2[i] * sine_;
    const float sy = y0[i] * east + y1[i] * north + y2[i] * sine_;
    const float dx = x1[i] * east - x0[i] * north;
    const float dy = y1[i] * east - y0[i] * north;
    const float across2 = sx * sx + sy * sy + 1e-9F;  // square of the sine of the angle to the sun
    const float inverse = 1.0F / across2;
    const float mx = (sy * sy - sx * sx) * inverse;
    const float my = -2.0F * sx * sy * inverse;
    values.mx[i] = mx;
    values.my[i] = my;
    values.along[i] = sky_->q[i] * mx + sky_->u[i] * my;
    values.across[i] = sky_->u[i] * mx - sky_->q[i] * my;
    values.fraction[i] = across2 / (2.0F - across2);
    values.turn[i] = 2.0F * (sx * dy - sy * dx) * inverse;
  }
}

// The vertical, by its components along a ray's axes, is as long as the elevation's cosine.
Eigen::ArrayXf RayleighPattern::VerticalAcross(const Values& values) const {
  const auto vx = sky_->x.col(2);
  const auto vy = sky_->y.col(2);
  return 2.0F * vx * vy * values.mx - (vx.square() - vy.square()) * values.my;
}

// A turn w moves the sun by w x s, and s . (w x a) = w . (a x s).
Array3Xf RayleighPattern::TurnBySun(double angle_rad) const {
  const Eigen::Vector3f sun(cosine_ * static_cast<float>(std::cos(angle_rad)),
                            cosine_ * static_cast<float>(std::sin(angle_rad)), sine_);
  Array3Xf turn(sky_->size(), 3);
  for (Eigen::Index i = 0; i < sky_->size(); ++i) {
    const Eigen::Vector3f x = sky_->x.row(i).matrix();
    const Eigen::Vector3f y = sky_->y.row(i).matrix();
    const float sx = x.dot(sun);
    const float sy = y.dot(sun);
    const float scale = 2.0F / (sx * sx + sy * sy + 1e-9F);
    turn.row(i) = scale * sun.cross(sx * y - sy * x).array().transpose();
  }
  return turn;
}

}  // namespace polnav::nav
