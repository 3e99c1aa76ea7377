#include "sim/vehicle/hexapod/hexapod_body.h"

#include <algorithm>

#include "sim/sensors/imu.h"
#include "sim/vehicle/hexapod/bullet_hexapod.h"
#include "sim/vehicle/hexapod/servo.h"

namespace polnav::sim {
struct HexapodBody::Impl {
  Impl(const HexapodOptions& hexapod_options, const Terrain& ground);
  ~Impl();
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void PutDown(const JointAngles& angles);
  void LayGround();
  void LayPlane(int group, const Eigen::Vector3d& p_W);
  [[nodiscard]] Eigen::Vector3d FootAt(int leg) const;
  void RefreshColliders();

  HexapodOptions options;
  const Terrain* terrain;
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher;
  btSimpleBroadphase broadphase;
  btMultiBodyConstraintSolver solver;
  btMultiBodyDynamicsWorld world;
  std::unique_ptr<btMultiBody> body;
  std::unique_ptr<HexapodContacts> contacts;
  btAlignedObjectArray<btQuaternion> scratch_rotations;
  btAlignedObjectArray<btVector3> scratch_places;
};

HexapodBody::Impl::Impl(const HexapodOptions& hexapod_options, const Terrain& ground)
    : options(hexapod_options),
      terrain(&ground),
      configuration(SmallPools(64)),
      dispatcher(&configuration),
      broadphase(64),
      world(&dispatcher, &broadphase, &solver, &configuration),
      body(MakeHexapod(options)) {
  world.setGravity({0.0, 0.0, -kGravity_m_s2});
  world.getSolverInfo().m_numIterations = 20;
  contacts = std::make_unique<HexapodContacts>(options, *body, world);
  world.addMultiBody(body.get());
}

HexapodBody::Impl::~Impl() {
  world.removeMultiBody(body.get());
  contacts.reset();
}

Eigen::Vector3d HexapodBody::Impl::FootAt(int leg) const {
  const int tibia = leg * kJointsOfLeg + 2;
  return FromBullet(body->getLink(tibia).m_cachedWorldTransform *
                    btVector3(0.5 * options.leg.tibia_m, 0.0, 0.0));
}

// The tangent plane at the ground straight below p.
void HexapodBody::Impl::LayPlane(int group, const Eigen::Vector3d& p_W) {
  const Terrain::Surface ground = terrain->At(p_W.x(), p_W.y());
  const Eigen::Vector3d normal =
      Eigen::Vector3d(-ground.gradient.x(), -ground.gradient.y(), 1.0).normalized();
  contacts->SetGround(group, normal,
                      normal.dot(Eigen::Vector3d(p_W.x(), p_W.y(), ground.height_m)));
}

void HexapodBody::Impl::LayGround() {
  for (int leg = 0; leg < kLegs; ++leg) LayPlane(leg, FootAt(leg));
  LayPlane(kLegs, FromBullet(body->getBasePos()));
}

void HexapodBody::Impl::RefreshColliders() {
  body->forwardKinematics(scratch_rotations, scratch_places);
  body->updateCollisionObjectWorldTransforms(scratch_rotations, scratch_places);
}

// Level, so high that no foot is in the ground.
void HexapodBody::Impl::PutDown(const JointAngles& angles) {
  const Eigen::Quaterniond q =
      nav::LevelAttitude(nav::DegToRad(options.start_heading_deg)).conjugate();
  body->setWorldToBaseRot(btQuaternion(q.x(), q.y(), q.z(), q.w()));
  body->setBasePos({options.start_east_m, options.start_north_m, 0.0});
  for (int leg = 0; leg < kLegs; ++leg) {
    for (int joint = 0; joint < kJointsOfLeg; ++joint) {
      body->setJointPos(leg * kJointsOfLeg + joint, angles[leg][joint]);
    }
  }
  RefreshColliders();
  double raise_m = -1e9;
  for (int leg = 0; leg < kLegs; ++leg) {
    const Eigen::Vector3d foot = FootAt(leg);
    const double ground = terrain->Height(foot.x(), foot.y());
    raise_m = std::max(raise_m, ground + options.leg.foot_radius_m - foot.z());
  }
  body->setBasePos({options.start_east_m, options.start_north_m, raise_m});
  RefreshColliders();
}

HexapodBody::HexapodBody(const HexapodOptions& options, const Terrain& terrain,
                         const JointAngles& angles)
    : impl_(std::make_unique<Impl>(options, terrain)) {
  impl_->PutDown(angles);
}

HexapodBody::~HexapodBody() = default;
HexapodBody::HexapodBody(HexapodBody&&) noexcept = default;
HexapodBody& HexapodBody::operator=(HexapodBody&&) noexcept = default;

void HexapodBody::Step(const JointAngles& wanted, const Eigen::Vector3d& push_W_n) {
  btMultiBody& body = *impl_->body;
  for (int leg = 0; leg < kLegs; ++leg) {
    for (int joint = 0; joint < kJointsOfLeg; ++joint) {
      const int index = leg * kJointsOfLeg + joint;
      body.addJointTorque(index, ServoTorque(impl_->options.servo, wanted[leg][joint],
                                             body.getJointPos(index), body.getJointVel(index)));
    }
  }
  body.addBaseForce(ToBullet(push_W_n));
  impl_->LayGround();
  impl_->world.stepSimulation(kStep_s, 0);  // 0: exactly one step of this length
  impl_->RefreshColliders();
}

nav::Pose HexapodBody::T_WB() const {
  const btQuaternion q_BW = impl_->body->getWorldToBaseRot();
  return {Eigen::Quaterniond(q_BW.w(), -q_BW.x(), -q_BW.y(), -q_BW.z()).normalized(),
          FromBullet(impl_->body->getBasePos())};
}

Eigen::Vector3d HexapodBody::v_WB_m_s() const { return FromBullet(impl_->body->getBaseVel()); }

JointAngles HexapodBody::angles() const {
  JointAngles angles;
  for (int i = 0; i < kJoints; ++i) {
    angles[i / kJointsOfLeg][i % kJointsOfLeg] = impl_->body->getJointPos(i);
  }
  return angles;
}

double HexapodBody::mass_kg() const {
  const LegOptions& leg = impl_->options.leg;
  return impl_->options.body_kg + kLegs * (leg.coxa_kg + leg.femur_kg + leg.tibia_kg);
}

double HexapodBody::MechanicalEnergy_j() const {
  const btMultiBody& body = *impl_->body;
  // Of the base, then of the links, each in its own axes.
  std::array<btVector3, kJoints + 1> w;
  std::array<btVector3, kJoints + 1> v;
  body.compTreeLinkVelocities(w.data(), v.data());
  const auto moving = [&](int i, double mass_kg, const btVector3& inertia) {
    return 0.5 * mass_kg * v[i].length2() + 0.5 * w[i].dot(inertia * w[i]);
  };
  double energy = moving(0, body.getBaseMass(), body.getBaseInertia()) +
                  body.getBaseMass() * kGravity_m_s2 * body.getBasePos().z();
  for (int i = 0; i < kJoints; ++i) {
    const btMultibodyLink& link = body.getLink(i);
    energy += moving(i + 1, link.m_mass, link.m_inertiaLocal) +
              link.m_mass * kGravity_m_s2 * link.m_cachedWorldTransform.getOrigin().z();
  }
  return energy;
}

}  // namespace polnav::sim
