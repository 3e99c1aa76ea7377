#include "sim/sensors/polarization_camera.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "sim/sensors/rotation.h"
#include "sky/stokes_axes.h"

namespace polnav::sim {
namespace {

constexpr double kSunRadius_rad = 0.00465;
constexpr double kSunRadiance = 1e4;  // saturates whatever sees it; the true one is higher still
constexpr double kGroundRadiance = 0.1;
constexpr double kExposureQuantile = 0.98;
constexpr double kExposureTarget = 0.8;

nav::Lens NominalLens(const PolarizationCameraOptions& options) {
  return {.model = options.lens == "equidistant" ? nav::LensModel::kEquidistant
                                                 : nav::LensModel::kPinhole,
          .focal_px = options.focal_px,
          .center_px = {0.5 * (options.width_px - 1), 0.5 * (options.height_px - 1)}};
}

template <typename Pixel>
void WritePixel(cv::Mat& mosaic, int row, int col, double value) {
  mosaic.at<Pixel>(row, col) = static_cast<Pixel>(value);
}

}  // namespace

nav::PolarizationCameraCalibration NominalPolarizationCamera(
    const PolarizationCameraOptions& options) {
  return {.width_px = options.width_px,
          .height_px = options.height_px,
          .bits = options.bits,
          .lens = NominalLens(options),
          .T_BS = {Eigen::Quaterniond::Identity(), options.position_m},
          .polarizer_rad = sky::ParseLayout(options.layout),
          .full_well_e = options.full_well_e,
          .read_noise_e = options.read_noise_e,
          .gain_sigma = options.gain_sigma,
          .offset_sigma = options.offset_sigma,
          .polarizer_sigma_rad = nav::DegToRad(options.polarizer_angle_sigma_deg),
          .mount_sigma_rad = nav::DegToRad(options.mount_error_sigma_deg),
          .focal_sigma = options.focal_sigma,
          .center_sigma_px = options.center_sigma_px};
}

PolarizationCamera::PolarizationCamera(const PolarizationCameraOptions& options,
                                       const sky::WorldSky& sky, std::uint64_t seed,
                                       std::uint64_t trial, const Occlusion* occlusion)
    : options_(options),
      sky_(&sky),
      occlusion_(occlusion),
      lens_(NominalLens(options)),
      noise_(seed, trial, "polarization_camera") {
  if (options.width_px % 2 != 0 || options.height_px % 2 != 0) {
    throw std::invalid_argument("polarization camera: a mosaic has even width and height");
  }
  RandomStream::Sample draw = RandomStream(seed, trial, "polarization_camera/instrument").At(0);
  sky::Cell angle = sky::ParseLayout(options.layout);
  sky::Cell gain{};
  for (std::size_t k = 0; k < angle.size(); ++k) {
    gain[k] = 1.0 + options.gain_sigma * draw.Gaussian();
    offset_[k] = options.offset_sigma * draw.Gaussian();
    angle[k] += nav::DegToRad(options.polarizer_angle_sigma_deg) * draw.Gaussian();
  }
  analyzers_ = sky::AnalyzerMatrix(angle, gain);
  q_BS_ = RotationOf(nav::DegToRad(options.mount_error_sigma_deg) * GaussianVector(draw));
  lens_.focal_px *= 1.0 + options.focal_sigma * draw.Gaussian();
  lens_.center_px.x() += options.center_sigma_px * draw.Gaussian();
  lens_.center_px.y() += options.center_sigma_px * draw.Gaussian();
  half_view_rad_ = HalfView();
  RandomStream::Sample wall = RandomStream(seed, trial, "polarization_camera/obstacles").At(0);
  const double harmonic_rad =
      nav::DegToRad(options.obstacles.roughness_deg) / std::sqrt(static_cast<double>(wall_.size()));
  for (Eigen::Vector2d& harmonic : wall_) {
    harmonic.x() = harmonic_rad * wall.Gaussian();
    harmonic.y() = harmonic_rad * wall.Gaussian();
  }
}

double PolarizationCamera::HalfView() const {
  // The grid of rays reaches up to a step beyond the picture.
  const double right = options_.width_px + options_.sky_step_px;
  const double bottom = options_.height_px + options_.sky_step_px;
  double half = 0.0;
  for (const Eigen::Vector2d& corner :
       {Eigen::Vector2d(0, 0), {right, 0}, {0, bottom}, {right, bottom}}) {
    const Eigen::Vector3d ray_S = nav::AxesOfPixel(lens_, corner).ray_S.normalized();
    half = std::max(half, std::acos(std::clamp(ray_S.z(), -1.0, 1.0)));
  }
  return half;
}

double PolarizationCamera::WallHeight(const Eigen::Vector3d& ray_W) const {
  const double azimuth = std::atan2(ray_W.x(), ray_W.y());
  double height = nav::DegToRad(options_.obstacles.mean_deg);
  for (std::size_t k = 0; k < wall_.size(); ++k) {
    const double phase = static_cast<double>(k + 1) * azimuth;
    height += wall_[k].x() * std::cos(phase) + wall_[k].y() * std::sin(phase);
  }
  return height;
}

Eigen::Vector3d PolarizationCamera::Light(const nav::PixelAxes& axes, const View& view) const {
  const Eigen::Vector3d ray_W = (view.q_WS * axes.ray_S).normalized();
  Eigen::Vector3d stokes = Eigen::Vector3d::Zero();
  const double elevation = std::asin(std::clamp(ray_W.z(), -1.0, 1.0));
  const auto hidden_by =
      view.scene.empty() ? std::optional<Occlusion::Hit>() : view.scene.Look(ray_W);
  if (hidden_by) {
    stokes[0] = hidden_by->radiance;
  } else if (elevation < 0.0) {
    stokes[0] = kGroundRadiance;
  } else if (elevation < WallHeight(ray_W)) {
    stokes[0] = options_.obstacles.radiance;
  } else {
    const sky::Skylight light = view.sky.Look(ray_W, view.p_WS_m);
    stokes = sky::StokesAbout(view.q_WS * axes.x_S, view.q_WS * axes.y_S, light);
    stokes = view.fog.Through(stokes, ray_W.z());
  }
  // Flare needs the sun on the lens, not in the picture; behind cloud or wall there is none.
  if (view.sun_share > 0.0) {
    const double from_sun = std::atan2(ray_W.cross(view.sun_W).norm(), ray_W.dot(view.sun_W));
    const double in_degrees = nav::RadToDeg(std::max(from_sun, kSunRadius_rad));
    stokes[0] += view.sun_share * options_.flare / (in_degrees * in_degrees);
  }
  return stokes;
}

Eigen::Vector3f PolarizationCamera::Grid::At(int row, int col, int step) const {
  const int above = std::min(row / step, rows - 2);
  const int left = std::min(col / step, cols - 2);
  const float down = static_cast<float>(row - above * step) / static_cast<float>(step);
  const float right = static_cast<float>(col - left * step) / static_cast<float>(step);
  const Eigen::Vector3f* const upper = &stokes[static_cast<std::size_t>(above * cols + left)];
  const Eigen::Vector3f* const lower = upper + cols;
  return (1.0F - down) * ((1.0F - right) * upper[0] + right * upper[1]) +
         down * ((1.0F - right) * lower[0] + right * lower[1]);
}

PolarizationCamera::View PolarizationCamera::ViewFrom(const Truth& truth,
                                                      const sky::FogAbove& fog) const {
  const double t_s = nav::ToSeconds(truth.stamp);
  View view{.sky = sky_->At(t_s),
            .q_WS = truth.T_WB.q * q_BS_,
            .p_WS_m = truth.T_WB * options_.position_m,
            .sun_W = sky_->sun_W(t_s),
            .fog = fog};
  const double elevation = std::asin(std::clamp(view.sun_W.z(), -1.0, 1.0));
  if (elevation > std::max(0.0, WallHeight(view.sun_W))) {
    view.sun_share = view.sky.Transmittance(view.sun_W, view.p_WS_m) * fog.Passed(view.sun_W.z());
  }
  if (occlusion_ == nullptr) return view;
  const Occlusion& scene = *occlusion_;
  view.scene =
      scene.From(view.p_WS_m, view.q_WS * Eigen::Vector3d::UnitZ(), half_view_rad_, truth.stamp);
  const Occlusion::View to_sun = scene.From(view.p_WS_m, view.sun_W, 0.0, truth.stamp);
  if (!to_sun.empty() && to_sun.Look(view.sun_W)) view.sun_share = 0.0;
  return view;
}

PolarizationCamera::Grid PolarizationCamera::LookAround(const View& view) const {
  const int step = options_.sky_step_px;
  Grid grid;
  grid.cols = (options_.width_px - 1 + step - 1) / step + 1;
  grid.rows = (options_.height_px - 1 + step - 1) / step + 1;
  grid.stokes.reserve(static_cast<std::size_t>(grid.cols) * static_cast<std::size_t>(grid.rows));
  for (int row = 0; row < grid.rows; ++row) {
    for (int col = 0; col < grid.cols; ++col) {
      const nav::PixelAxes axes = nav::AxesOfPixel(
          lens_, {static_cast<double>(col * step), static_cast<double>(row * step)});
      grid.stokes.emplace_back(Light(axes, view).cast<float>());
    }
  }
  return grid;
}

double PolarizationCamera::Exposure(const Grid& grid) const {
  if (!options_.auto_exposure) return options_.exposure;
  std::vector<float> brightest;  // of the four channels
  brightest.reserve(grid.stokes.size());
  for (const Eigen::Vector3f& s : grid.stokes) brightest.push_back(s[0] + std::hypot(s[1], s[2]));
  const auto rank =
      static_cast<std::ptrdiff_t>(kExposureQuantile * static_cast<double>(brightest.size() - 1));
  std::nth_element(brightest.begin(), brightest.begin() + rank, brightest.end());
  return kExposureTarget / std::max(1e-9, static_cast<double>(brightest[rank]));
}

void PolarizationCamera::AddSun(const View& view, const Eigen::Vector2d& pixel,
                                Eigen::Vector3f& stokes) const {
  const Eigen::Vector3d ray_W = view.q_WS * nav::AxesOfPixel(lens_, pixel).ray_S;
  if ((ray_W - view.sun_W).norm() < kSunRadius_rad) {
    stokes[0] += static_cast<float>(view.sun_share * kSunRadiance);
  }
}

nav::PolarizationImage PolarizationCamera::Take(const Truth& truth, std::uint64_t index,
                                                const sky::FogAbove& fog) const {
  const View view = ViewFrom(truth, fog);
  const Grid grid = LookAround(view);
  const Eigen::Matrix<float, 4, 3> analyzers = (Exposure(grid) * analyzers_).cast<float>();
  const double top = std::ldexp(1.0, options_.bits) - 1.0;
  const double read_variance = std::pow(options_.read_noise_e / options_.full_well_e, 2);
  const Eigen::Vector2d sun_px = nav::PixelOfRay(lens_, view.q_WS.conjugate() * view.sun_W);
  const double near_sun_px = 4.0 + 4.0 * kSunRadius_rad * lens_.focal_px;
  RandomStream::Sample draw = noise_.At(index);
  cv::Mat mosaic(options_.height_px, options_.width_px, options_.bits > 8 ? CV_16UC1 : CV_8UC1);
  for (int row = 0; row < mosaic.rows; ++row) {
    for (int col = 0; col < mosaic.cols; ++col) {
      Eigen::Vector3f stokes = grid.At(row, col, options_.sky_step_px);
      const Eigen::Vector2d pixel(col, row);
      if (view.sun_share > 0.0 && (pixel - sun_px).norm() < near_sun_px) {
        AddSun(view, pixel, stokes);
      }
      const int channel = 2 * (row % 2) + col % 2;
      const double clean = analyzers.row(channel).dot(stokes);
      const double sigma = std::sqrt(std::max(0.0, clean) / options_.full_well_e + read_variance);
      const double reading =
          clean + offset_[static_cast<std::size_t>(channel)] + sigma * draw.Gaussian();
      const double value = std::round(std::clamp(reading, 0.0, 1.0) * top);
      options_.bits > 8 ? WritePixel<std::uint16_t>(mosaic, row, col, value)
                        : WritePixel<std::uint8_t>(mosaic, row, col, value);
    }
  }
  return {truth.stamp, mosaic};
}

}  // namespace polnav::sim
