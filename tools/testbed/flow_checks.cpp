#include "tools/testbed/flow_checks.h"

#include <fmt/format.h>

#include <optional>

#include "nav/api/time.h"

namespace polnav::testbed {
namespace {

void CheckFlowRates(const YamlDocument& document, const sim::OpticalFlowOptions& flow) {
  const char* const key = "sensors.optical_flow.internal_rate_hz";
  if (!sim::IsSampleRate(flow.internal_rate_hz)) {
    FailAt(document, key,
           fmt::format("{} Hz does not fit whole steps of the simulation", flow.internal_rate_hz));
  }
  const nav::TimeNs reading = nav::FromSeconds(1.0 / flow.rate_hz);
  if (reading % nav::FromSeconds(1.0 / flow.internal_rate_hz) != 0) {
    FailAt(document, key,
           fmt::format("{} pictures a second do not make {} readings a second: expected a whole "
                       "number for each",
                       flow.internal_rate_hz, flow.rate_hz));
  }
}

// Of B above the ground, where the vehicle says; any other's is at least on it.
std::optional<double> BodyHeight(const sim::VehicleOptions& vehicle) {
  if (vehicle.turntable) return vehicle.turntable->position_m.z();
  if (vehicle.hexapod) return vehicle.hexapod->gait.body_height_m;
  return std::nullopt;
}

}  // namespace

void CheckFlow(const YamlDocument& document, const Scenario& scenario) {
  if (!scenario.sensors.optical_flow) return;
  const sim::OpticalFlowOptions& flow = *scenario.sensors.optical_flow;
  CheckFlowRates(document, flow);
  if (flow.range_min_m >= flow.range_max_m) {
    FailAt(document, "sensors.optical_flow.range_min_m",
           fmt::format("{} m is not below range_max_m, {} m", flow.range_min_m, flow.range_max_m));
  }
  const std::optional<double> body_m = BodyHeight(scenario.vehicle);
  const double height_m = flow.position_m.z() + body_m.value_or(0.0);
  if (height_m > flow.range_max_m) {
    FailAt(document, "sensors.optical_flow.position_m",
           fmt::format("the sensor is {:.4g} m or more above the ground, beyond range_max_m, {} m",
                       height_m, flow.range_max_m));
  }
  if (body_m && height_m < flow.range_min_m) {
    FailAt(document, "sensors.optical_flow.position_m",
           fmt::format("the sensor is {:.4g} m above the ground, below range_min_m, {} m", height_m,
                       flow.range_min_m));
  }
}

}  // namespace polnav::testbed
