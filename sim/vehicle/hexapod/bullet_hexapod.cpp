#include "sim/vehicle/hexapod/bullet_hexapod.h"

namespace polnav::sim {
namespace {

constexpr double kKneeRadius_m = 0.012;

// A rod along x, and the servo's rotor, which turns with it about `axis`.
btVector3 RodInertia(double mass_kg, double length_m, double rotor_kg_m2, const btVector3& axis) {
  // A servo is two centimetres thick.
  constexpr double kThickness_m = 0.02;
  const double across = mass_kg * (length_m * length_m + kThickness_m * kThickness_m) / 12.0;
  const double along = mass_kg * kThickness_m * kThickness_m / 6.0;
  return btVector3(along, across, across) + rotor_kg_m2 * axis.absolute();
}

btVector3 BoxInertia(double mass_kg, const Eigen::Vector3d& size_m) {
  const Eigen::Vector3d s2 = size_m.cwiseAbs2();
  return mass_kg / 12.0 * btVector3(s2.y() + s2.z(), s2.x() + s2.z(), s2.x() + s2.y());
}

struct Link {
  double mass_kg, length_m;
  btVector3 axis;
  int parent;
  btQuaternion parent_to_this;
  btVector3 parent_center_to_joint;
};

void AddLink(btMultiBody& body, int index, const Link& link, double rotor_kg_m2) {
  body.setupRevolute(index, link.mass_kg,
                     RodInertia(link.mass_kg, link.length_m, rotor_kg_m2, link.axis), link.parent,
                     link.parent_to_this, link.axis, link.parent_center_to_joint,
                     {0.5 * link.length_m, 0.0, 0.0}, true);
}

void AddLeg(btMultiBody& body, int leg, const nav::Pose& T_BH, const HexapodOptions& options) {
  const LegOptions& size = options.leg;
  const double rotor = options.servo.rotor_inertia_kg_m2;
  const btVector3 up(0.0, 0.0, 1.0);
  // About -y a positive angle lifts what lies ahead.
  const btVector3 lifts(0.0, -1.0, 0.0);
  const int first = leg * kJointsOfLeg;
  const Eigen::Quaterniond q_HB = T_BH.q.conjugate();
  AddLink(body, first,
          {size.coxa_kg, size.coxa_m, up, -1, btQuaternion(q_HB.x(), q_HB.y(), q_HB.z(), q_HB.w()),
           ToBullet(T_BH.p)},
          rotor);
  const btQuaternion straight(0.0, 0.0, 0.0, 1.0);
  AddLink(body, first + 1,
          {size.femur_kg, size.femur_m, lifts, first, straight, {0.5 * size.coxa_m, 0.0, 0.0}},
          rotor);
  AddLink(body, first + 2,
          {size.tibia_kg, size.tibia_m, lifts, first + 1, straight, {0.5 * size.femur_m, 0.0, 0.0}},
          rotor);
}

}  // namespace

std::unique_ptr<btMultiBody> MakeHexapod(const HexapodOptions& options) {
  auto body = std::make_unique<btMultiBody>(
      kJoints, options.body_kg, BoxInertia(options.body_kg, options.body_size_m), false, false);
  const auto roots = LegRoots(options);
  for (int leg = 0; leg < kLegs; ++leg) AddLeg(*body, leg, roots[leg], options);
  body->finalizeMultiDof();
  body->setLinearDamping(0.0);
  body->setAngularDamping(0.0);
  body->setHasSelfCollision(false);
  body->useGlobalVelocities(false);
  return body;
}

HexapodContacts::HexapodContacts(const HexapodOptions& options, btMultiBody& body,
                                 btMultiBodyDynamicsWorld& world)
    : body_(&body),
      world_(&world),
      foot_(options.leg.foot_radius_m),
      knee_(kKneeRadius_m),
      box_(ToBullet(0.5 * options.body_size_m)),
      plane_({0.0, 0.0, 1.0}, 0.0) {
  btTransform end = btTransform::getIdentity();
  end.setOrigin({0.5 * options.leg.tibia_m, 0.0, 0.0});
  tibia_.addChildShape(end, &foot_);
  end.setOrigin({0.5 * options.leg.femur_m, 0.0, 0.0});
  femur_.addChildShape(end, &knee_);
  for (int group = 0; group <= kLegs; ++group) {
    auto ground = std::make_unique<btCollisionObject>();
    ground->setCollisionShape(&plane_);
    ground->setFriction(1.0);
    Rubber(options.leg, *ground);
    world.addCollisionObject(ground.get(), 1 << group, 1 << group);
    grounds_.push_back(std::move(ground));
  }
  for (int leg = 0; leg < kLegs; ++leg) {
    const int first = leg * kJointsOfLeg;
    AddCollider(first + 1, femur_, leg);
    AddCollider(first + 2, tibia_, leg);
  }
  AddCollider(-1, box_, kLegs);
  for (auto& collider : colliders_) {
    collider->setFriction(options.leg.foot_friction);
    Rubber(options.leg, *collider);
  }
}

HexapodContacts::~HexapodContacts() {
  for (auto& collider : colliders_) world_->removeCollisionObject(collider.get());
  for (auto& ground : grounds_) world_->removeCollisionObject(ground.get());
}

void HexapodContacts::Rubber(const LegOptions& leg, btCollisionObject& object) const {
  // Bullet adds both sides' compliance: each is half of the rubber's.
  object.setContactStiffnessAndDamping(2.0 * leg.foot_stiffness_n_m, 2.0 * leg.foot_damping_n_s_m);
}

void HexapodContacts::AddCollider(int link, btCollisionShape& shape, int group) {
  auto collider = std::make_unique<btMultiBodyLinkCollider>(body_, link);
  collider->setCollisionShape(&shape);
  world_->addCollisionObject(collider.get(), 1 << group, 1 << group);
  if (link < 0) {
    body_->setBaseCollider(collider.get());
  } else {
    body_->getLink(link).m_collider = collider.get();
  }
  colliders_.push_back(std::move(collider));
}

void HexapodContacts::SetGround(int group, const Eigen::Vector3d& normal_W, double distance_m) {
  // The plane's own origin stays the foot of the perpendicular from W's: contacts are remembered in
  // the plane's coordinates and must not slide when it is laid anew.
  const Eigen::Quaterniond q =
      Eigen::Quaterniond(1.0 + normal_W.z(), -normal_W.y(), normal_W.x(), 0.0).normalized();
  grounds_[group]->setWorldTransform(
      btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), ToBullet(distance_m * normal_W)));
}

}  // namespace polnav::sim
