// What do our vehicles share of Bullet?
//
// Only the vehicles' own sources include this file: Bullet's headers stay out of the rest.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <Eigen/Core>

namespace polnav::sim {

inline btVector3 ToBullet(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }
inline Eigen::Vector3d FromBullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

// For a world in which hardly anything touches: saves megabytes a world.
inline btDefaultCollisionConstructionInfo SmallPools(int contacts) {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = contacts;
  info.m_defaultMaxCollisionAlgorithmPoolSize = contacts;
  return info;
}

}  // namespace polnav::sim
