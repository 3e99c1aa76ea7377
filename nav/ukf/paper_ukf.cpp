#include "nav/ukf/paper_ukf.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "nav/inertial/options.h"
#include "nav/ukf/start.h"

namespace polnav::nav {
namespace {

constexpr double kFastest_rad_s = 100.0;
constexpr double kHardest_m_s2 = 1000.0;
constexpr TimeNs kLatest = kNsPerSecond / 10;  // older measurements are left out
constexpr double kLongest_s = 1.0;             // of a gap between two readings, bridged as one
constexpr double kSeen_s = 1.0;
constexpr double kQuality = 0.2;

double Square2(double x) { return x * x; }

template <typename Column>
Eigen::Quaterniond QuaternionOf(const Column& x) {
  return Eigen::Quaterniond(x(6), x(7), x(8), x(9)).normalized();
}

Eigen::Vector4d Coefficients(const Eigen::Quaterniond& q) { return {q.w(), q.x(), q.y(), q.z()}; }

}  // namespace

PaperUkf::PaperUkf(const PaperUkfOptions& options, const ImuCalibration& imu,
                   const OpticalFlowCalibration& flow, const StartPrior& start,
                   std::optional<SkySource> sky)
    : options_(options), imu_(imu), flow_(flow), start_(start), sky_(std::move(sky)) {
  ukf::CheckSigmas(imu, flow, start);
  interval_ = FromSeconds(1.0 / imu.rate_hz);
}

Report PaperUkf::Process(const Measurement& measurement) {
  Report report;
  if (const auto* imu = std::get_if<ImuSample>(&measurement)) {
    report.outcome = TakeImu(*imu);
  } else if (const auto* flow = std::get_if<OpticalFlowSample>(&measurement)) {
    report.outcome = TakeFlow(*flow, report);
  } else if (const auto* light = std::get_if<PolarizationSample>(&measurement); light && sky_) {
    report.outcome = TakeLight(*light, report);
  } else {
    return report;
  }
  const TimeNs period = FromSeconds(1.0 / options_.output_rate_hz);
  if (now_ && *now_ / period > answered_ / period) {
    answered_ = *now_;
    report.estimate = Answer();
  }
  return report;
}

bool PaperUkf::StandsYet(TimeNs stamp) const {
  return ToSeconds(stamp - *began_) < start_.standing_s;
}

// The start's attitude, tilted as the force says.
void PaperUkf::Align() {
  aligned_ = true;
  const auto errors = standing_.Errors();
  if (!errors) return;
  errors_ = *errors;
  if (flow_stood_s_ > 0.0) flow_bias_rad_s_ = flow_turned_rad_.head<2>() / flow_stood_s_;
  x_.tail<4>() = Coefficients(LevelAttitude(start_.heading_rad) * errors_.q_LB);
}

void PaperUkf::Begin(TimeNs stamp) {
  now_ = answered_ = stamp;
  began_ = stamp;
  const Eigen::Quaterniond q = LevelAttitude(start_.heading_rad);
  x_ << start_.p_WB_m, Eigen::Vector3d::Zero(), Coefficients(q);
  P_.setZero();
  P_.diagonal().head<3>().setConstant(Square2(start_.position_sigma_m));
  P_.diagonal().segment<3>(3).setConstant(Square2(options_.velocity_sigma_m_s));
  // q' - q = (0, theta) q / 2; along the quaternion itself a little, to stay definite.
  const Eigen::Vector3d sigma(start_.level_sigma_rad, start_.level_sigma_rad,
                              start_.heading_sigma_rad);
  Eigen::Matrix<double, 4, 3> by;
  for (int k = 0; k < 3; ++k) {
    const Eigen::Vector3d half = 0.5 * Eigen::Vector3d::Unit(k);
    by.col(k) = Coefficients(Eigen::Quaterniond(0.0, half.x(), half.y(), half.z()) * q);
  }
  P_.bottomRightCorner<4, 4>() = by * sigma.cwiseAbs2().asDiagonal() * by.transpose();
  P_.bottomRightCorner<4, 4>().diagonal().array() += 1e-6;
}

// [Zeng2020, eq. 17]
PaperUkf::Points PaperUkf::SigmaPoints(Report* report) {
  P_ = 0.5 * (P_ + P_.transpose()).eval();
  Eigen::LLT<Square> llt(P_);
  if (llt.info() != Eigen::Success) {
    const Eigen::SelfAdjointEigenSolver<Square> solver(P_);
    P_ = solver.eigenvectors() * solver.eigenvalues().cwiseMax(1e-10).asDiagonal() *
         solver.eigenvectors().transpose();
    llt.compute(P_);
    if (report) ++report->failed_solves;
  }
  const Square root = std::sqrt(static_cast<double>(kSize)) * Square(llt.matrixL());
  Points points;
  points.leftCols<kSize>() = root.colwise() + x_;
  points.rightCols<kSize>() = (-root).colwise() + x_;
  return points;
}

// [Zeng2020, eqs 18-19]
Outcome PaperUkf::TakeImu(const ImuSample& sample) {
  const bool sound = sample.gyro_rad_s.allFinite() && sample.accel_m_s2.allFinite() &&
                     sample.gyro_rad_s.cwiseAbs().maxCoeff() < kFastest_rad_s &&
                     sample.accel_m_s2.cwiseAbs().maxCoeff() < kHardest_m_s2;
  if (!sound || (now_ && sample.stamp <= *now_)) return Outcome::kUnusable;
  if (!now_) Begin(sample.stamp - interval_);
  const double dt = std::min(ToSeconds(sample.stamp - *now_), kLongest_s);
  now_ = sample.stamp;
  if (StandsYet(sample.stamp)) {
    standing_.Add(imu_.T_BI.q * sample.gyro_rad_s, imu_.T_BI.q * sample.accel_m_s2);
    return Outcome::kUsed;
  }
  if (!aligned_) Align();
  rate_B_ = imu_.T_BI.q * sample.gyro_rad_s - errors_.gyro_bias_rad_s;
  const Eigen::Vector3d force_B = imu_.T_BI.q * sample.accel_m_s2 - errors_.accel_bias_m_s2;
  const Eigen::Quaterniond half = ukf::Exp(0.5 * dt * rate_B_);
  const Eigen::Vector3d gravity(0.0, 0.0, -kGravity_m_s2);
  Points points = SigmaPoints(nullptr);
  for (int k = 0; k < kPoints; ++k) {
    auto x = points.col(k);
    const Eigen::Quaterniond middle = QuaternionOf(x) * half;
    const Eigen::Vector3d a = middle * force_B + gravity;
    x.head<3>() += dt * x.segment<3>(3) + 0.5 * dt * dt * a;
    x.segment<3>(3) += dt * a;
    x.tail<4>() = Coefficients(middle * half);
  }
  x_ = points.rowwise().mean();
  x_.tail<4>().normalize();
  const Points off = points.colwise() - x_;
  P_ = off * off.transpose() / kPoints;
  const double share = options_.noise_per_step ? 1.0 : dt;
  P_.diagonal().head<3>().array() += share * Square2(options_.position_sigma_m);
  P_.diagonal().segment<3>(3).array() += share * Square2(options_.velocity_sigma_m_s);
  P_.diagonal().tail<4>().array() += share * Square2(options_.quaternion_sigma);
  return Outcome::kUsed;
}

// [Zeng2020, eqs 20-24]
template <int Z>
bool PaperUkf::Correct(const Eigen::Matrix<double, Z, kPoints>& expected,
                       const Eigen::Matrix<double, Z, 1>& measured,
                       const Eigen::Matrix<double, Z, 1>& variance, const Points& points,
                       Innovation innovation, Report& report) {
  const Eigen::Matrix<double, Z, 1> mean = expected.rowwise().mean();
  const Eigen::Matrix<double, Z, kPoints> off = expected.colwise() - mean;
  Eigen::Matrix<double, Z, Z> covariance = off * off.transpose() / kPoints;
  covariance.diagonal() += variance;
  const Points deviation = points.colwise() - x_;
  const Eigen::Matrix<double, kSize, Z> cross = deviation * off.transpose() / kPoints;
  const Eigen::Matrix<double, Z, Z> inverse = covariance.inverse();
  const Eigen::Matrix<double, Z, 1> residual = measured - mean;
  innovation.nis = residual.dot(inverse * residual);
  if (!std::isfinite(innovation.nis)) return false;
  const Eigen::Matrix<double, kSize, Z> gain = cross * inverse;
  x_ += gain * residual;
  x_.tail<4>().normalize();
  P_ -= gain * cross.transpose();
  report.innovations.push_back(innovation);
  return true;
}

Outcome PaperUkf::TakeFlow(const OpticalFlowSample& sample, Report& report) {
  const bool sound = sample.flow_rad.allFinite() && sample.gyro_rad.allFinite() &&
                     sample.integration > 0 && sample.quality >= kQuality && sample.range_m &&
                     std::isfinite(*sample.range_m) && *sample.range_m > 0.0;
  if (!sound || !now_ || *now_ - sample.stamp > kLatest) return Outcome::kUnusable;
  const double integration_s = ToSeconds(sample.integration);
  if (!aligned_) {
    flow_turned_rad_ += sample.gyro_rad;
    flow_stood_s_ += integration_s;
    return Outcome::kUsed;
  }
  const std::optional<OpticalFlowSample> before = std::exchange(ranged_, sample);
  if (!before || sample.stamp <= before->stamp) return Outcome::kUnusable;
  const double d = *sample.range_m;
  const Eigen::Vector2d turned = sample.gyro_rad.head<2>() - integration_s * flow_bias_rad_s_;
  const Eigen::Vector2d moved = d / integration_s * (sample.flow_rad - turned);
  const double climb = (d - *before->range_m) / ToSeconds(sample.stamp - before->stamp);
  const Eigen::Vector3d v_F(moved.y(), -moved.x(), -climb);
  const Eigen::Vector3d measured = flow_.T_BF.q * v_F - rate_B_.cross(flow_.T_BF.p);
  const Points points = SigmaPoints(&report);
  Eigen::Matrix<double, 3, kPoints> expected;
  for (int k = 0; k < kPoints; ++k) {
    expected.col(k) = QuaternionOf(points.col(k)).conjugate() * points.col(k).segment<3>(3);
  }
  const double aside = Square2(options_.flow_sigma_m_s);
  const Eigen::Vector3d variance(aside, aside, Square2(options_.climb_sigma_m_s));
  const Innovation innovation{.stamp = sample.stamp, .sensor = "optical_flow", .dof = 3};
  return Correct<3>(expected, measured, variance, points, innovation, report) ? Outcome::kUsed
                                                                              : Outcome::kUnusable;
}

// Compass heading = sun's azimuth + pi/2 + phi, an axis: phi turns from S's x towards its y,
// against the compass; the nearer of its two ends counts.
Outcome PaperUkf::TakeLight(const PolarizationSample& sample, Report& report) {
  const bool frozen = newest_light_ && sample.channel == newest_light_->channel;
  newest_light_ = sample;
  const bool finite = std::all_of(sample.channel.begin(), sample.channel.end(),
                                  [](double c) { return std::isfinite(c); });
  const auto light = finite ? UsableLight(sample, sky_->options) : std::nullopt;
  if (!light || frozen || !aligned_ || *now_ - sample.stamp > kLatest) return Outcome::kUnusable;
  const Eigen::Vector3d e_B = EVectorOf(*light, sky_->calibration);
  const Eigen::Vector3d sun_W = sky_->sun(sample.stamp);
  const double sun_azimuth = std::atan2(sun_W.x(), sun_W.y());
  const double heading = sun_azimuth + 0.5 * std::numbers::pi + std::atan2(e_B.y(), e_B.x());
  const double believed = CompassHeading(QuaternionOf(x_));
  const Points points = SigmaPoints(&report);
  Eigen::Matrix<double, 1, kPoints> expected;
  for (int k = 0; k < kPoints; ++k) {
    expected(k) = WrapPi(CompassHeading(QuaternionOf(points.col(k))) - believed);
  }
  using Scalar = Eigen::Matrix<double, 1, 1>;
  const Scalar measured(WrapHalfPi(heading - believed));
  const Innovation innovation{.stamp = sample.stamp, .sensor = "polarimeter", .dof = 1};
  return Correct<1>(expected, measured, Scalar(Square2(options_.heading_sigma_rad)), points,
                    innovation, report)
             ? Outcome::kUsed
             : Outcome::kUnusable;
}

Estimate PaperUkf::Answer() const {
  const Eigen::Quaterniond q = QuaternionOf(x_);
  Estimate e{.stamp = *now_, .T_WB = {q, x_.head<3>()}};
  // theta = 2 vec(dq q^-1)
  Eigen::Matrix<double, 6, kSize> by = Eigen::Matrix<double, 6, kSize>::Zero();
  by.leftCols<3>().topRows<3>().setIdentity();
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector4d unit = Eigen::Vector4d::Unit(k);
    by.block<3, 1>(3, 6 + k) =
        2.0 * (Eigen::Quaterniond(unit(0), unit(1), unit(2), unit(3)) * q.conjugate()).vec();
  }
  e.covariance = by * P_ * by.transpose();
  e.tracked = ranged_ && ToSeconds(*now_ - ranged_->stamp) < kSeen_s;
  return e;
}

}  // namespace polnav::nav
