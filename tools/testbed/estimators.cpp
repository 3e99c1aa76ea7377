#include "tools/testbed/estimators.h"

#include <algorithm>
#include <optional>
#include <stdexcept>

namespace polnav::testbed {
namespace {

AnyEstimator MakeWalking(const EstimatorInfo& info, const Scenario& scenario, const nav::Rig& rig,
                         const nav::StartPrior& start) {
  std::optional<nav::SkySource> sky;
  if (info.needs_polarimeter) {
    sky = {scenario.estimators.polarization, rig.polarimeter.value(), SunFor(scenario.site)};
  }
  if (info.name.starts_with("ukf_paper")) {
    return nav::PaperUkf(scenario.estimators.ukf_paper, rig.imu.value(), rig.optical_flow.value(),
                         start, std::move(sky));
  }
  return nav::Ukf(scenario.estimators.ukf, rig.imu.value(), rig.optical_flow.value(), start,
                  std::move(sky));
}

}  // namespace

const EstimatorInfo* FindInfo(std::string_view name) {
  const auto* const info = std::find_if(kEstimators.begin(), kEstimators.end(),
                                        [&](const EstimatorInfo& i) { return i.name == name; });
  return info == kEstimators.end() ? nullptr : info;
}

const EstimatorInfo& InfoOf(std::string_view name) {
  const EstimatorInfo* const info = FindInfo(name);
  if (info == nullptr) throw std::logic_error("no estimator is called " + std::string(name));
  return *info;
}

AnyEstimator MakeEstimator(const std::string& name, const Scenario& scenario, const nav::Rig& rig,
                           const nav::StartPrior& start) {
  const EstimatorInfo& info = InfoOf(name);
  if (info.needs_polarization_camera) {
    nav::CompassOptions options = scenario.estimators.compass;
    options.method = info.name.substr(std::string_view("compass_").size());
    return nav::CompassEstimator(options, rig.polarization_camera.value(), SunFor(scenario.site),
                                 start);
  }
  if (info.needs_optical_flow) return MakeWalking(info, scenario, rig, start);
  if (info.needs_polarimeter && !info.needs_stereo) {
    return nav::PolarimeterCompass(scenario.estimators.polarization, rig.polarimeter.value(),
                                   SunFor(scenario.site), start);
  }
  std::optional<nav::HeadingFusion> polarization;
  if (info.needs_polarimeter) {
    polarization.emplace(scenario.estimators.polarization, rig.polarimeter.value(),
                         SunFor(scenario.site));
  }
  return nav::StereoEstimator(scenario.estimators.stereo, rig.stereo.value(), rig.imu, start,
                              std::move(polarization), ClosesLoops(scenario, name));
}

bool ClosesLoops(const Scenario& scenario, const std::string& name) {
  const auto& names = scenario.estimators.close_loops;
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool WantsDescriptors(const Scenario& scenario) {
  const auto& run = scenario.estimators.run;
  return std::any_of(run.begin(), run.end(),
                     [&](const std::string& name) { return ClosesLoops(scenario, name); });
}

nav::SunModel SunFor(const sky::SiteOptions& site) {
  const auto utc = sky::ParseUtc(site.utc);
  if (!utc) throw std::logic_error("SunFor: site.utc is no date: " + site.utc);
  const sky::SunArc arc = sky::ComputeSunArc(sky::SiteOf(site), *utc);
  return [arc](nav::TimeNs stamp) { return arc.At(nav::ToSeconds(stamp)); };
}

}  // namespace polnav::testbed
