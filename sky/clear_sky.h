// What light comes from one direction of a cloudless sky?
//
// One of three models, prepared for one place of the sun:
//   rayleigh  single scattering (rayleigh.h), brightness by CIE type 12 (cie_sky.h)
//   berry     the same with neutral points (berry.h)
//   hazy      fitted to radiative transfer: sun elevation, wavelength, aerosol (hazy.h)
// Each has Look<T>(sun, up) -> SkyStokes<T>, where sun and up are unit vectors by their components
// along axis 1, axis 2 and the ray. They are functions of the ray by these alone, so they hold
// about any axes across the ray: those of RayAxes, or a pixel's. T is double or ceres::Jet.
// Preparing hazy takes some 0.6 ms, a ray of it less than a microsecond: prepare once an instant.
// Twilight and night: with the sun at or below the horizon all three are finite and continuous, the
// pattern moving on with the sun. What is missing is the earth's shadow and the night's own light;
// radiance stays relative to the zenith.
#pragma once

#include <Eigen/Core>
#include <string>
#include <variant>

#include "sky/berry.h"
#include "sky/cie_sky.h"
#include "sky/hazy.h"
#include "sky/ray_axes.h"
#include "sky/rayleigh.h"
#include "sky/sky_stokes.h"

namespace polnav::sky {

// YAML keys = field names.
struct ClearSkyOptions {
  std::string model = "berry";    // rayleigh: no neutral points; hazy: as radiative transfer has it
  double max_dop = 0.70;          // 90 degrees from the sun (rayleigh, berry)
  double aot = 0.1;               // aerosol optical thickness at 550 nm (berry, hazy)
  double wavelength_nm = 450.0;   // (hazy)
  double separation_scale = 1.0;  // times the separation of neutral points (berry); 0: Rayleigh

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("model", model, {"rayleigh", "berry", "hazy"});
    v("max_dop", max_dop, {.min = 0.0, .max = 1.0});
    v("aot", aot, {.min = 0.0, .max = 1.0});
    v("wavelength_nm", wavelength_nm, {.min = 400.0, .max = 700.0});
    v("separation_scale", separation_scale, {.min = 0.0, .max = 3.0});
  }
};

struct RayleighSky {
  double max_dop = 0.7;

  template <typename T>
  [[nodiscard]] SkyStokes<T> Look(const Eigen::Matrix<T, 3, 1>& sun,
                                  const Eigen::Matrix<T, 3, 1>& up) const {
    const Eigen::Matrix<T, 2, 1> p = RayleighStokes<T>(sun, max_dop);
    return {CieRadiance<T>(sun, up), p.x(), p.y()};
  }
};

class ClearSky {
 public:
  using Model = std::variant<RayleighSky, BerrySky, HazySky>;

  // sun_W: unit vector towards the sun, ENU. Throws std::invalid_argument on an unknown model.
  ClearSky(const ClearSkyOptions& options, const Eigen::Vector3d& sun_W);

  // ray_W: unit vector at or above the horizon, ENU. Stokes parameters about RayAxes.
  [[nodiscard]] SkyStokes<double> Look(const Eigen::Vector3d& ray_W) const {
    return Look(AxesOf(ray_W));
  }
  [[nodiscard]] SkyStokes<double> Look(const RayAxes& axes) const {
    return Look<double>(axes.Components(sun_W_), axes.Components(Eigen::Vector3d::UnitZ()));
  }

  // About any axes: sun, up by their components along the first, the second and the ray.
  template <typename T>
  [[nodiscard]] SkyStokes<T> Look(const Eigen::Matrix<T, 3, 1>& sun,
                                  const Eigen::Matrix<T, 3, 1>& up) const {
    return std::visit([&](const auto& model) { return model.template Look<T>(sun, up); }, model_);
  }

  [[nodiscard]] const Eigen::Vector3d& sun_W() const { return sun_W_; }
  [[nodiscard]] const Model& model() const { return model_; }

 private:
  Eigen::Vector3d sun_W_;
  Model model_;
};

}  // namespace polnav::sky
