#include "sim/vehicle/chassis.h"

#include <cmath>
#include <numbers>

#include "sim/vehicle/bullet.h"
#include "sim/vehicle/raycast_car.h"

namespace polnav::sim {
namespace {

constexpr double kWheelRadius_m = 0.30;
constexpr double kBumpTravel_m = 0.25;  // from rest until the strut bottoms out

// Radii of gyration of a passenger car over its track width (roll) and wheelbase (pitch, yaw).
btVector3 Inertia(const CarOptions& options) {
  const double roll = 0.38 * options.track_width_m;
  const double pitch = 0.42 * options.wheelbase_m;
  const double yaw = 0.43 * options.wheelbase_m;
  return options.mass_kg * btVector3(roll * roll, pitch * pitch, yaw * yaw);
}

// Bullet's springs are per unit of the whole mass: four of them give the heave frequency.
btRaycastVehicle::btVehicleTuning Tuning(const CarOptions& options) {
  const double w = 2.0 * std::numbers::pi * options.suspension_frequency_hz;
  btRaycastVehicle::btVehicleTuning tuning;
  tuning.m_suspensionStiffness = 0.25 * w * w;
  tuning.m_suspensionDamping = 0.25 * 2.0 * options.suspension_damping_ratio * w;
  tuning.m_suspensionCompression = tuning.m_suspensionDamping;
  const double sag = Chassis::kGravity_m_s2 / (w * w);
  tuning.m_maxSuspensionTravelCm = 100.0 * (sag + kBumpTravel_m);
  tuning.m_maxSuspensionForce = 10.0 * options.mass_kg * Chassis::kGravity_m_s2;
  return tuning;
}

btTransform StartPose(const CarOptions& options, const Terrain& terrain,
                      const Eigen::Vector2d& start_m, double heading_rad) {
  const Eigen::Vector3d up = terrain.Normal(start_m.x(), start_m.y());
  // Shortest turn of the vertical onto the ground's normal, by the half vector.
  const Eigen::Quaterniond lean =
      Eigen::Quaterniond(1.0 + up.z(), -up.y(), up.x(), 0.0).normalized();
  const Eigen::Quaterniond q = (lean * nav::LevelAttitude(heading_rad)).normalized();
  // The centre of mass goes above the start, whichever way the ground leans.
  const Eigen::Vector2d foot = start_m - options.cg_height_m * up.head<2>();
  const double height = terrain.Height(foot.x(), foot.y()) + options.cg_height_m * up.z();
  return btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), {start_m.x(), start_m.y(), height});
}

}  // namespace

struct Chassis::Impl {
  Impl(const CarOptions& car_options, const Terrain& terrain, const Eigen::Vector2d& start_m,
       double heading_rad);
  ~Impl();
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  void AddWheel(double x_sign, double y_sign);
  void Apply(const Controls& controls);

  CarOptions options;
  btRaycastVehicle::btVehicleTuning tuning;
  btDefaultCollisionConfiguration configuration;
  btCollisionDispatcher dispatcher;
  btSimpleBroadphase broadphase;
  btSequentialImpulseConstraintSolver solver;
  btDiscreteDynamicsWorld world;
  btSphereShape shape;  // Bullet wants one; it is masked from everything
  btRigidBody body;
  TerrainRaycaster raycaster;
  RaycastCar car;
  btVector3 last_position;
};

Chassis::Impl::Impl(const CarOptions& car_options, const Terrain& terrain,
                    const Eigen::Vector2d& start_m, double heading_rad)
    : options(car_options),
      tuning(Tuning(options)),
      configuration(SmallPools(16)),
      dispatcher(&configuration),
      broadphase(4),
      world(&dispatcher, &broadphase, &solver, &configuration),
      shape(0.5),
      body(options.mass_kg, nullptr, &shape, Inertia(options)),
      raycaster(terrain),
      car(tuning, &body, &raycaster, options.friction) {
  world.setGravity({0.0, 0.0, -kGravity_m_s2});
  body.setCenterOfMassTransform(StartPose(options, terrain, start_m, heading_rad));
  body.setActivationState(DISABLE_DEACTIVATION);
  world.addRigidBody(&body, 1, 0);
  world.addAction(&car);
  for (const double x_sign : {1.0, -1.0}) {
    for (const double y_sign : {1.0, -1.0}) AddWheel(x_sign, y_sign);
  }
  last_position = body.getCenterOfMassPosition();
}

Chassis::Impl::~Impl() {
  world.removeAction(&car);
  world.removeRigidBody(&body);
}

void Chassis::Impl::AddWheel(double x_sign, double y_sign) {
  const double sag = kGravity_m_s2 / (4.0 * tuning.m_suspensionStiffness);
  // Hangs so that at rest, sagged, the centre of mass is cg_height_m above the ground.
  const double length_at_rest = kBumpTravel_m;
  const btVector3 top(0.5 * x_sign * options.wheelbase_m, 0.5 * y_sign * options.track_width_m,
                      kWheelRadius_m + length_at_rest - options.cg_height_m);
  car.addWheel(top, {0.0, 0.0, -1.0}, {0.0, 1.0, 0.0}, length_at_rest + sag, kWheelRadius_m, tuning,
               x_sign > 0.0);
}

// Ackermann: all axles' lines meet in one point beside the car.
void Chassis::Impl::Apply(const Controls& controls) {
  const double tan_steer = std::tan(controls.steer_rad);
  const double length = options.wheelbase_m;
  const double half_track = 0.5 * options.track_width_m;
  for (int wheel = 0; wheel < 4; ++wheel) {
    const bool front = wheel < 2;
    const double y = wheel % 2 == 0 ? half_track : -half_track;
    car.setSteeringValue(front ? std::atan2(length * tan_steer, length - y * tan_steer) : 0.0,
                         wheel);
    car.applyEngineForce(front ? 0.5 * controls.drive_n : 0.0, wheel);
    car.setBrake(0.25 * controls.brake_n, wheel);
  }
}

Chassis::Chassis(const CarOptions& options, const Terrain& terrain, const Eigen::Vector2d& start_m,
                 double heading_rad)
    : impl_(std::make_unique<Impl>(options, terrain, start_m, heading_rad)) {}

Chassis::~Chassis() = default;
Chassis::Chassis(Chassis&&) noexcept = default;
Chassis& Chassis::operator=(Chassis&&) noexcept = default;

void Chassis::Step(const Controls& controls) {
  impl_->Apply(controls);
  impl_->last_position = impl_->body.getCenterOfMassPosition();
  impl_->world.stepSimulation(kStep_s, 0);  // 0: exactly one step of this length
}

nav::Pose Chassis::T_WB() const {
  const btQuaternion q = impl_->body.getOrientation();
  return {Eigen::Quaterniond(q.w(), q.x(), q.y(), q.z()).normalized(),
          FromBullet(impl_->body.getCenterOfMassPosition())};
}

Eigen::Vector3d Chassis::v_WB_m_s() const {
  return FromBullet((impl_->body.getCenterOfMassPosition() - impl_->last_position) / kStep_s);
}

std::array<double, 4> Chassis::WheelLoads_n() const {
  std::array<double, 4> loads{};
  for (int i = 0; i < 4; ++i) loads[i] = impl_->car.getWheelInfo(i).m_wheelsSuspensionForce;
  return loads;
}

// Velocities as they moved the body in the last step: what Bullet holds between steps already has
// the next step's wheel forces, but not yet its gravity.
double Chassis::MechanicalEnergy_j() const {
  const Impl& impl = *impl_;
  const double stiffness = impl.tuning.m_suspensionStiffness * impl.options.mass_kg;
  const btVector3 w_B =
      impl.body.getAngularVelocity() * impl.body.getCenterOfMassTransform().getBasis();
  double energy = 0.5 * impl.options.mass_kg * v_WB_m_s().squaredNorm() +
                  0.5 * w_B.dot(w_B * Inertia(impl.options)) +
                  impl.options.mass_kg * kGravity_m_s2 * impl.body.getCenterOfMassPosition().z();
  for (int i = 0; i < 4; ++i) {
    const btWheelInfo& wheel = impl.car.getWheelInfo(i);
    const double squeezed = wheel.m_suspensionRestLength1 - wheel.m_raycastInfo.m_suspensionLength;
    energy += 0.5 * stiffness * squeezed * squeezed;
  }
  return energy;
}

}  // namespace polnav::sim
