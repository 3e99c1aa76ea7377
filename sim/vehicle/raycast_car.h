// How does Bullet's raycast vehicle meet our ground and our tyres?
//
// Only chassis.cpp includes this file: Bullet's headers stay out of the rest.
#pragma once

#include <BulletDynamics/Vehicle/btRaycastVehicle.h>
#include <btBulletDynamicsCommon.h>

#include <array>

#include "sim/vehicle/tyre.h"
#include "sim/world/terrain.h"

namespace polnav::sim {

// Where does a suspension ray meet the terrain?
class TerrainRaycaster : public btVehicleRaycaster {
 public:
  explicit TerrainRaycaster(const Terrain& terrain) : terrain_(&terrain) {}
  // Not null when the ground lies between the ends, or above the first.
  void* castRay(const btVector3& from, const btVector3& to,
                btVehicleRaycasterResult& result) override;

 private:
  const Terrain* terrain_;
};

// Bullet's vehicle with its friction replaced: Bullet's own creeps on slopes and knows no slip.
class RaycastCar : public btRaycastVehicle {
 public:
  RaycastCar(const btVehicleTuning& tuning, btRigidBody* body, btVehicleRaycaster* raycaster,
             double friction);

  void updateVehicle(btScalar step) override;
  void updateFriction(btScalar step) override;

 private:
  void PushWheel(int wheel, btScalar step);

  double friction_;
  std::array<TyreState, 4> tyres_{};
  btVector3 v_before_{0.0, 0.0, 0.0};
  btVector3 w_before_{0.0, 0.0, 0.0};
};

}  // namespace polnav::sim
