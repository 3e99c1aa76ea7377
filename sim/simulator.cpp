#include "sim/simulator.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "sim/disturbances/on_the_road.h"
#include "sim/random.h"
#include "sim/world/fog.h"

namespace polnav::sim {
namespace {

constexpr double kTruthRateWithoutCameras_hz = 10.0;

// A seed for a part of the world that takes one number.
std::uint64_t SeedOf(const RunKey& key, std::string_view part) {
  RandomStream::Sample sample = RandomStream(key.seed, key.trial, part).At(0);
  const std::uint64_t high = sample.Bits();
  return high << 32U | sample.Bits();
}

struct GroundSeeds {
  std::uint64_t terrain, driver;
};
GroundSeeds GroundSeedsOf(const RunKey& world) {
  return {SeedOf(world, "world/terrain"), SeedOf(world, "vehicle/driver")};
}

// Where the cameras come by.
std::vector<Eigen::Vector3d> ViewpointsOf(const VehicleOptions& vehicle, const Track& track,
                                          const Terrain& terrain, double camera_height_m) {
  constexpr double kSpacing_m = 4.0;
  if (const auto place = PlaceOf(vehicle)) {
    const double above_m = vehicle.turntable ? vehicle.turntable->position_m.z() : 0.0;
    return {{place->x(), place->y(),
             above_m + (terrain.Height(place->x(), place->y()) + camera_height_m)}};
  }
  std::vector<Eigen::Vector3d> viewpoints;
  for (double s_m = 0.0; s_m < track.length_m(); s_m += kSpacing_m) {
    const Eigen::Vector2d p = track.At(s_m).p_m;
    viewpoints.emplace_back(p.x(), p.y(), terrain.Height(p.x(), p.y()) + camera_height_m);
  }
  return viewpoints;
}

nav::TimeNs PeriodOf(double rate_hz) { return nav::FromSeconds(1.0 / rate_hz); }

}  // namespace

bool IsSampleRate(double rate_hz) {
  const nav::TimeNs period = PeriodOf(rate_hz);
  return period > 0 && period % Vehicle::kStep == 0;
}

nav::Rig NominalRig(const SensorOptions& sensors) {
  nav::Rig rig;
  if (sensors.stereo) rig.stereo = NominalStereo(*sensors.stereo);
  if (sensors.polarimeter) rig.polarimeter = NominalPolarimeter(*sensors.polarimeter);
  if (sensors.polarization_camera) {
    rig.polarization_camera = NominalPolarizationCamera(*sensors.polarization_camera);
  }
  if (sensors.imu) rig.imu = NominalImu(*sensors.imu);
  if (sensors.optical_flow) rig.optical_flow = NominalOpticalFlow(*sensors.optical_flow);
  return rig;
}

RunKey WorldKey(const WorldOptions& world, const RunKey& key) {
  return world.seed == 0 ? key : RunKey{.seed = world.seed, .trial = 0};
}

Motion RecordMotion(const SimulatorOptions& options, const RunKey& key, nav::TimeNs duration) {
  const GroundSeeds seeds = GroundSeedsOf(WorldKey(options.world, key));
  const Track track(options.world.track);
  const Terrain terrain(options.world.terrain, track, seeds.terrain);
  Vehicle vehicle(options.vehicle, track, terrain, seeds.driver);
  Motion motion;
  motion.push_back(vehicle.truth());
  while (motion.back().stamp <= duration) {  // the simulator is one step ahead at its end
    vehicle.Step();
    motion.push_back(vehicle.truth());
  }
  return motion;
}

Simulator::Simulator(const SimulatorOptions& options, const RunKey& key, nav::TimeNs duration,
                     std::shared_ptr<const Motion> motion)
    : events_(ScheduleDisturbances(options.disturbances, nav::ToSeconds(duration), key.seed,
                                   key.trial)) {
  const auto utc = sky::ParseUtc(options.site.utc);
  if (!utc) throw std::logic_error("Simulator: site.utc is no date: " + options.site.utc);
  track_ = std::make_unique<Track>(options.world.track);
  const GroundSeeds seeds = GroundSeedsOf(WorldKey(options.world, key));
  terrain_ = std::make_unique<Terrain>(options.world.terrain, *track_, seeds.terrain);
  sky_ = std::make_unique<sky::WorldSky>(
      options.sky, sky::ComputeSunArc(sky::SiteOf(options.site), *utc), SeedOf(key, "sky/clouds"),
      CloudPassages(events_, options.vehicle, *track_));
  if (std::any_of(events_.begin(), events_.end(),
                  [](const DisturbanceEvent& event) { return event.what.fog.has_value(); })) {
    fog_light_.emplace(*sky_);
  }
  if (motion) {
    vehicle_.emplace(std::move(motion));
  } else {
    vehicle_.emplace(options.vehicle, *track_, *terrain_, seeds.driver);
  }
  BuildScene(
      WithDisturbances(options.world, options.disturbances, events_, options.vehicle, *track_),
      options, key, duration);
  EquipVehicle(options.sensors, key);
  if (options.sensors.optical_flow) EquipWithFlow(options, key);
  if (options.sensors.stereo && options.level == Level::kMeasurement) {
    EquipWithFeatures(*options.sensors.stereo, options.vehicle, key);
  }
}

// Whoever looks at the sky sees the same scene hide it, whether cameras look at it too or not.
void Simulator::BuildScene(const WorldOptions& world, const SimulatorOptions& options,
                           const RunKey& key, nav::TimeNs duration) {
  const SensorOptions& sensors = options.sensors;
  hides_sky_ = (sensors.polarimeter || sensors.polarization_camera) && HidesSky(world);
  // Whatever other sensors there are.
  has_things_ = sensors.optical_flow && HidesSky(world);
  const bool draws = (sensors.stereo || sensors.optical_flow) && options.level == Level::kImage;
  if (!sensors.stereo && !hides_sky_ && !has_things_ && !draws) return;
  scene_ = BuildWorld(world, *track_, *terrain_, SeedOf(WorldKey(world, key), "world/plaza"),
                      nav::ToSeconds(duration), draws);
  const bool follows_points = sensors.stereo && options.level == Level::kMeasurement;
  if (!hides_sky_ && !has_things_ && !follows_points) return;
  occlusion_ = std::make_unique<Occlusion>(
      scene_, [lighting = Lighting(*sky_)](const Eigen::Vector3d& normal_W) {
        return lighting.OfWhite(normal_W);
      });
}

Simulator::Clock Simulator::ClockOf(double rate_hz) {
  if (!IsSampleRate(rate_hz)) {
    throw std::logic_error("Simulator: a sensor's period must be a multiple of the physics step");
  }
  return {.period = PeriodOf(rate_hz)};
}

void Simulator::EquipVehicle(const SensorOptions& sensors, const RunKey& key) {
  truth_clock_ = ClockOf(sensors.stereo ? sensors.stereo->rate_hz : kTruthRateWithoutCameras_hz);
  if (sensors.imu) {
    imu_clock_ = ClockOf(sensors.imu->rate_hz);
    imu_.emplace(*sensors.imu, key.seed, key.trial);
  }
  if (sensors.polarimeter) {
    polarimeter_clock_ = ClockOf(sensors.polarimeter->rate_hz);
    polarimeter_.emplace(*sensors.polarimeter, *sky_, key.seed, key.trial, hides_sky());
  }
  if (sensors.reference) {
    reference_clock_ = ClockOf(sensors.reference->rate_hz);
    reference_.emplace(*sensors.reference, key.seed, key.trial);
  }
  if (sensors.stereo) {
    stereo_clock_ = ClockOf(sensors.stereo->rate_hz);
    true_stereo_ = DrawTrueStereo(*sensors.stereo, key.seed, key.trial);
  }
  if (sensors.polarization_camera) {
    polarization_camera_clock_ = ClockOf(sensors.polarization_camera->rate_hz);
    polarization_camera_.emplace(*sensors.polarization_camera, *sky_, key.seed, key.trial,
                                 hides_sky());
  }
}

void Simulator::EquipWithFeatures(const StereoCameraOptions& stereo, const VehicleOptions& vehicle,
                                  const RunKey& key) {
  const auto viewpoints = ViewpointsOf(vehicle, *track_, *terrain_, stereo.position_m.z());
  feature_camera_.emplace(
      scene_, *occlusion_,
      DrawFeatureCloud(scene_, stereo.features, viewpoints, key.seed, key.trial), *true_stereo_,
      stereo, key.seed, key.trial);
}

void Simulator::EquipWithFlow(const SimulatorOptions& options, const RunKey& key) {
  const OpticalFlowOptions& flow = *options.sensors.optical_flow;
  flow_clock_ = ClockOf(flow.internal_rate_hz);
  if (ClockOf(flow.rate_hz).period % flow_clock_.period != 0) {
    throw std::logic_error("Simulator: a flow reading takes a whole number of its pictures");
  }
  optical_flow_.emplace(flow, *terrain_, has_things_ ? occlusion_.get() : nullptr, key.seed,
                        key.trial);
  if (options.level == Level::kMeasurement) {
    flow_model_.emplace(flow, GrainContrast(options.world), key.seed, key.trial);
  }
}

void Simulator::LookDown(const Truth& now, std::vector<Emission>& due) {
  if (!optical_flow_ || !flow_clock_.Due(now.stamp)) return;
  ++flow_clock_.index;
  std::optional<FlowInterval> interval = optical_flow_->Look(now);
  if (!interval) return;
  if (flow_model_) {
    due.emplace_back(flow_model_->Take(*interval));
  } else {
    due.emplace_back(FlowRequest{std::move(*interval)});
  }
}

sky::FogAbove Simulator::FogAt(const Truth& truth) const {
  if (!fog_light_) return {};
  const double visibility_m = ConditionsAt(events_, truth.stamp).visibility_m;
  if (std::isinf(visibility_m)) return {};
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const double sun_share =
      sky_->Transmittance(fog_light_->sun_W(), truth.T_WB.p, nav::ToSeconds(truth.stamp));
  const double fallen = fog_light_->FromSky(up) + sun_share * fog_light_->FromSun(up);
  return {FogDepth(visibility_m), FogRadiance(fallen, visibility_m)};
}

std::vector<Simulator::Emission> Simulator::Step() {
  const Truth& now = vehicle_->truth();
  std::vector<Emission> due;
  if (truth_clock_.Due(now.stamp)) {
    Truth truth = now;
    if (imu_) truth.imu_bias = imu_->Bias(now.stamp);
    due.emplace_back(truth);
    ++truth_clock_.index;
  }
  if (imu_ && imu_clock_.Due(now.stamp)) {
    // A reading is a mean over the interval before it: there is none at time zero.
    if (imu_clock_.index > 0) {
      due.emplace_back(imu_->Sample(imu_interval_begin_, now, imu_clock_.index - 1));
    }
    imu_interval_begin_ = now;
    ++imu_clock_.index;
  }
  if (polarimeter_ && polarimeter_clock_.Due(now.stamp)) {
    due.emplace_back(polarimeter_->Sample(now, polarimeter_clock_.index++, FogAt(now)));
  }
  if (reference_ && reference_clock_.Due(now.stamp)) {
    due.emplace_back(reference_->Sample(now, reference_clock_.index++));
  }
  LookDown(now, due);
  if (true_stereo_ && stereo_clock_.Due(now.stamp)) {
    const FrameRequest request{.stamp = now.stamp,
                               .index = stereo_clock_.index++,
                               .T_WB = now.T_WB,
                               .v_WB_m_s = now.v_WB_m_s,
                               .w_WB_B_rad_s = now.w_WB_B_rad_s,
                               .conditions = ConditionsAt(events_, now.stamp)};
    if (feature_camera_) {
      due.emplace_back(feature_camera_->See(request));
    } else {
      due.emplace_back(request);
    }
  }
  if (polarization_camera_ && polarization_camera_clock_.Due(now.stamp)) {
    due.emplace_back(SkyRequest{now, polarization_camera_clock_.index++, FogAt(now)});
  }
  vehicle_->Step();
  return due;
}

}  // namespace polnav::sim
