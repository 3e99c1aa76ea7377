// How is the hexapod put together in Bullet?
//
// Only hexapod_body.cpp and bullet_hexapod.cpp include this file: Bullet's headers stay out of the
// rest.
#pragma once

#include <BulletCollision/CollisionShapes/btStaticPlaneShape.h>
#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>
#include <btBulletDynamicsCommon.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "sim/vehicle/bullet.h"
#include "sim/vehicle/hexapod/hexapod_options.h"
#include "sim/vehicle/hexapod/leg_kinematics.h"

namespace polnav::sim {

// Links leg by leg: coxa, femur, tibia. Angles as in leg_kinematics.h.
inline constexpr int kJoints = kLegs * kJointsOfLeg;

// Masses, joints and their axes, at rest at the origin.
[[nodiscard]] std::unique_ptr<btMultiBody> MakeHexapod(const HexapodOptions& options);

// What touches the ground, and the ground: of each leg the foot and the knee and one plane, of the
// body its box and one plane. Things meet the plane of their own group and nothing else.
class HexapodContacts {
 public:
  HexapodContacts(const HexapodOptions& options, btMultiBody& body,
                  btMultiBodyDynamicsWorld& world);
  ~HexapodContacts();
  HexapodContacts(const HexapodContacts&) = delete;
  HexapodContacts& operator=(const HexapodContacts&) = delete;

  // group: a leg's number, or kLegs for the body.
  void SetGround(int group, const Eigen::Vector3d& normal_W, double distance_m);

 private:
  void AddCollider(int link, btCollisionShape& shape, int group);
  void Rubber(const LegOptions& leg, btCollisionObject& object) const;

  btMultiBody* body_;
  btMultiBodyDynamicsWorld* world_;
  btSphereShape foot_;
  btSphereShape knee_;
  btBoxShape box_;
  btStaticPlaneShape plane_;
  std::vector<std::unique_ptr<btCollisionObject>> grounds_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
  // The foot's sphere sits at the tibia's far end, the link's own origin at its middle.
  btCompoundShape tibia_;
  btCompoundShape femur_;
};

}  // namespace polnav::sim
