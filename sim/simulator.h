// What does the vehicle feel, second by second?
//
// Owns the clock and the seed: builds the world, steps the vehicle, and samples every sensor that
// the vehicle carries at its own rate. Pictures are only asked for here (FrameRequest, SkyRequest)
// and taken by whoever has time (measurement_stream.h): they cost a thousand times more than the
// rest.
// (options, seed, trial) fixes every byte; leaving a sensor out leaves the others as they are.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "nav/api/calibration.h"
#include "nav/api/measurements.h"
#include "sim/disturbances/schedule.h"
#include "sim/render/lighting.h"
#include "sim/sensors/feature_camera.h"
#include "sim/sensors/frame_request.h"
#include "sim/sensors/imu.h"
#include "sim/sensors/optical_flow.h"
#include "sim/sensors/optical_flow_model.h"
#include "sim/sensors/polarimeter.h"
#include "sim/sensors/polarization_camera.h"
#include "sim/sensors/reference.h"
#include "sim/sensors/stereo_camera.h"
#include "sim/truth.h"
#include "sim/vehicle/vehicle.h"
#include "sim/world/occlusion.h"
#include "sim/world/terrain.h"
#include "sim/world/track.h"
#include "sim/world/world.h"
#include "sky/skylight.h"
#include "sky/sun.h"

namespace polnav::sim {

// Absent: the vehicle does not carry it.
struct SensorOptions {
  std::optional<StereoCameraOptions> stereo;
  std::optional<ImuOptions> imu;
  std::optional<PolarimeterOptions> polarimeter;
  std::optional<PolarizationCameraOptions> polarization_camera;
  std::optional<ReferenceOptions> reference;
  std::optional<OpticalFlowOptions> optical_flow;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("stereo", stereo);
    v("imu", imu);
    v("polarimeter", polarimeter);
    v("polarization_camera", polarization_camera);
    v("reference", reference);
    v("optical_flow", optical_flow);
  }
};

// What stereo camera and optical-flow sensor work with. All other sensors are the same at both.
enum class Level {
  kImage,        // pictures, drawn
  kMeasurement,  // what pictures would have given; a hundred times as fast
};

struct SimulatorOptions {
  sky::SiteOptions site;
  sky::SkyOptions sky;
  WorldOptions world;
  VehicleOptions vehicle;
  SensorOptions sensors;
  std::vector<DisturbanceOptions> disturbances;
  Level level = Level::kImage;
};

// Which run of a scenario: everything random depends on these two and nothing else.
struct RunKey {
  std::uint64_t seed = 1;
  std::uint64_t trial = 0;
};

// What draws the ground and the vehicle's way.
[[nodiscard]] RunKey WorldKey(const WorldOptions& world, const RunKey& key);

// The vehicle's motion for so long, as a Simulator with the same options would have it.
[[nodiscard]] Motion RecordMotion(const SimulatorOptions& options, const RunKey& key,
                                  nav::TimeNs duration);

// A picture of the sky to be taken.
struct SkyRequest {
  Truth truth;
  std::uint64_t index = 0;
  sky::FogAbove fog;
};

// Pictures of the ground to be taken, for one reading.
struct FlowRequest {
  FlowInterval interval;
};

// True: a sensor of this rate can be sampled at whole physics steps.
[[nodiscard]] bool IsSampleRate(double rate_hz);

// What the estimators are told about the sensors.
[[nodiscard]] nav::Rig NominalRig(const SensorOptions& sensors);

class Simulator {
 public:
  // duration: traffic and actors move so long, and disturbances are drawn. motion: the vehicle's,
  // when it was recorded with these options and this key (motion_memory.h); null: it is simulated.
  // Throws std::logic_error when a rate is none of IsSampleRate's or the date is none.
  Simulator(const SimulatorOptions& options, const RunKey& key,
            nav::TimeNs duration = 600 * nav::kNsPerSecond,
            std::shared_ptr<const Motion> motion = nullptr);

  using Emission =
      std::variant<Truth, nav::ImuSample, nav::PolarizationSample, nav::ReferencePose,
                   nav::OpticalFlowSample, FrameRequest, SkyRequest, FlowRequest, FeatureSightings>;

  // What falls due at the current instant, in a fixed order, the truth (at the cameras' rate, or
  // 10 Hz without cameras) first; then one physics step. The first call is at time zero.
  [[nodiscard]] std::vector<Emission> Step();

  [[nodiscard]] const Truth& truth() const { return vehicle_->truth(); }
  [[nodiscard]] const Scene& scene() const { return scene_; }
  [[nodiscard]] const sky::WorldSky& sky() const { return *sky_; }
  // Only for taking pictures: the cameras as they really are. Absent without cameras.
  [[nodiscard]] const std::optional<nav::StereoCalibration>& true_stereo() const {
    return true_stereo_;
  }
  // The optical-flow sensor wants pictures taken.
  [[nodiscard]] bool looks_down() const { return optical_flow_ && !flow_model_; }
  // Only for taking pictures, from any thread. Absent without one.
  [[nodiscard]] const std::optional<PolarizationCamera>& polarization_camera() const {
    return polarization_camera_;
  }

 private:
  // When a sensor is due next.
  struct Clock {
    nav::TimeNs period = 0;
    std::uint64_t index = 0;
    [[nodiscard]] bool Due(nav::TimeNs stamp) const {
      return stamp == static_cast<nav::TimeNs>(index) * period;
    }
  };

  [[nodiscard]] static Clock ClockOf(double rate_hz);
  void BuildScene(const WorldOptions& world, const SimulatorOptions& options, const RunKey& key,
                  nav::TimeNs duration);
  void EquipWithFeatures(const StereoCameraOptions& stereo, const VehicleOptions& vehicle,
                         const RunKey& key);
  // What stands between the sky and who looks at it; null: nothing.
  [[nodiscard]] const Occlusion* hides_sky() const {
    return hides_sky_ ? occlusion_.get() : nullptr;
  }
  [[nodiscard]] sky::FogAbove FogAt(const Truth& truth) const;
  void EquipWithFlow(const SimulatorOptions& options, const RunKey& key);
  void LookDown(const Truth& now, std::vector<Emission>& due);
  void EquipVehicle(const SensorOptions& sensors, const RunKey& key);

  std::vector<DisturbanceEvent> events_;
  std::optional<Lighting> fog_light_;  // what falls on fogs; absent without any
  std::unique_ptr<Track> track_;
  std::unique_ptr<Terrain> terrain_;
  std::unique_ptr<sky::WorldSky> sky_;
  Scene scene_;
  bool hides_sky_ = false;                // of the scene, something
  bool has_things_ = false;               // for the optical-flow sensor to notice
  std::unique_ptr<Occlusion> occlusion_;  // null: nobody asks what is behind what
  std::optional<Vehicle> vehicle_;

  Clock truth_clock_;
  Clock imu_clock_;
  Clock polarimeter_clock_;
  Clock reference_clock_;
  Clock stereo_clock_;
  Clock polarization_camera_clock_;
  Clock flow_clock_;  // of its pictures
  std::optional<Imu> imu_;
  std::optional<Polarimeter> polarimeter_;
  std::optional<Reference> reference_;
  std::optional<nav::StereoCalibration> true_stereo_;
  std::optional<FeatureCamera> feature_camera_;  // in the stereo camera's place
  std::optional<PolarizationCamera> polarization_camera_;
  std::optional<OpticalFlow> optical_flow_;
  std::optional<OpticalFlowModel> flow_model_;  // in its pictures' place
  Truth imu_interval_begin_;
};

}  // namespace polnav::sim
