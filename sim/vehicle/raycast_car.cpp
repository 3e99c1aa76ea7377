#include "sim/vehicle/raycast_car.h"

#include <algorithm>
#include <cmath>

namespace polnav::sim {

// Newton on the height above ground along the ray. The ray is within some 20 degrees of the
// vertical and the ground's slope changes little over a strut: three steps leave rounding only.
void* TerrainRaycaster::castRay(const btVector3& from, const btVector3& to,
                                btVehicleRaycasterResult& result) {
  const btVector3 ray = to - from;
  double t = 0.5;
  Terrain::Surface ground;
  for (int iteration = 0; iteration < 5; ++iteration) {
    const btVector3 p = from + t * ray;
    ground = terrain_->At(p.x(), p.y());
    const double height = p.z() - ground.height_m;
    const double rate = ray.z() - ground.gradient.x() * ray.x() - ground.gradient.y() * ray.y();
    if (rate >= 0.0) return nullptr;  // the car lies on its side
    const double step = height / rate;
    t -= step;
    if (std::abs(step) < 1e-7) break;  // converges quadratically: the rest is below 1e-13
  }
  if (t > 1.0) return nullptr;
  t = std::max(t, 0.0);
  result.m_distFraction = t;
  result.m_hitPointInWorld = from + t * ray;
  result.m_hitNormalInWorld =
      btVector3(-ground.gradient.x(), -ground.gradient.y(), 1.0).normalized();
  return this;
}

RaycastCar::RaycastCar(const btVehicleTuning& tuning, btRigidBody* body,
                       btVehicleRaycaster* raycaster, double friction)
    : btRaycastVehicle(tuning, body, raycaster), friction_(friction) {
  setCoordinateSystem(1, 2, 0);
}

// The suspension's impulses of this step are to gravity's of the next one as action to reaction:
// tyres must see the velocity that moved the car, not the one between the two.
void RaycastCar::updateVehicle(btScalar step) {
  v_before_ = getRigidBody()->getLinearVelocity();
  w_before_ = getRigidBody()->getAngularVelocity();
  btRaycastVehicle::updateVehicle(step);
}

void RaycastCar::updateFriction(btScalar step) {
  for (int wheel = 0; wheel < getNumWheels(); ++wheel) PushWheel(wheel, step);
}

void RaycastCar::PushWheel(int wheel, btScalar step) {
  const btWheelInfo& info = getWheelInfo(wheel);
  const btWheelInfo::RaycastInfo& contact = info.m_raycastInfo;
  const btTransform& T_WB = getChassisWorldTransform();
  const btVector3 arm = contact.m_contactPointWS - T_WB.getOrigin();
  const btVector3& normal = contact.m_contactNormalWS;

  const btVector3 left_B(-std::sin(info.m_steering), std::cos(info.m_steering), 0.0);
  const btVector3 forward = (T_WB.getBasis() * left_B).cross(normal).normalized();
  const btVector3 left = normal.cross(forward);
  const btVector3 v = v_before_ + w_before_.cross(arm);
  const TyreForce force =
      AdvanceTyre({.load_n = contact.m_isInContact
                                 ? std::min(info.m_wheelsSuspensionForce, info.m_maxSuspensionForce)
                                 : 0.0,
                   .v_forward_m_s = v.dot(forward),
                   .v_left_m_s = v.dot(left),
                   .drive_n = info.m_engineForce,
                   .brake_n = info.m_brake,
                   .friction = friction_},
                  step, tyres_[wheel]);
  getRigidBody()->applyImpulse(step * (force.forward_n * forward + force.left_n * left), arm);
}

}  // namespace polnav::sim
