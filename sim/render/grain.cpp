#include "sim/render/grain.h"

#include <cmath>
#include <opencv2/core.hpp>

#include "sim/random.h"
#include "sim/world/texture_noise.h"

namespace polnav::sim {
namespace {

constexpr int kSide_px = 512;
constexpr double kFineTile_m = 0.25;
constexpr double kCoarseTile_m = 0.61;
constexpr double kTurn_rad = 0.6;
// Of the noise, and of the sum of two looks at it less its mean, in the texture's unit.
constexpr double kNoiseSigma = 0.35;
constexpr double kNoiseRange = 1.2;
const double kSumSigma = kNoiseSigma / (2.0 * kNoiseRange) * std::sqrt(2.0);

Eigen::Vector2d Fraction(const Eigen::Vector2d& v) {
  return v - Eigen::Vector2d(std::floor(v.x()), std::floor(v.y()));
}

}  // namespace

GrainAtEye GrainSeenFrom(const Eigen::Vector3d& eye_W_m, const CloseUp& close_up) {
  const Eigen::Vector2d along(std::cos(kTurn_rad) / kCoarseTile_m,
                              std::sin(kTurn_rad) / kCoarseTile_m);
  const Eigen::Vector2d eye = eye_W_m.head<2>();
  const Eigen::Vector2d coarse(along.dot(eye), along.x() * eye.y() - along.y() * eye.x());
  const Eigen::Vector3f in_floats = eye_W_m.cast<float>();
  return {.eye_rest_W = (eye_W_m - in_floats.cast<double>()).cast<float>(),
          .fine_at_eye = Fraction(eye / kFineTile_m).cast<float>(),
          .coarse_at_eye = Fraction(coarse).cast<float>(),
          .fine_per_m = static_cast<float>(1.0 / kFineTile_m),
          .coarse_per_m = along.cast<float>(),
          .gain = static_cast<float>(close_up.contrast / kSumSigma)};
}

GLuint LoadGrain(const GlFunctions& gl) {
  RandomStream::Sample random = RandomStream(1, 0, "grain").At(0);
  const cv::Mat noise = FractalNoise(kSide_px, {2, 8, 1.0}, random);
  cv::Mat texels;
  noise.convertTo(texels, CV_8U, 127.5 / kNoiseRange, 127.5);
  GLuint id = 0;
  gl.GenTextures(1, &id);
  gl.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
  gl.BindTexture(GL_TEXTURE_2D, id);
  gl.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, texels.cols, texels.rows, 0, GL_RED, GL_UNSIGNED_BYTE,
                texels.data);
  gl.GenerateMipmap(GL_TEXTURE_2D);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  gl.TexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
  return id;
}

}  // namespace polnav::sim
