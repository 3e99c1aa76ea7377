// Is it the sensor that is wrong, or the filter?
//
// A reading that the gate refuses is the sensor's fault, until those refused agree with each other
// for some time: then what the filter believes is wrong, and has to become less sure of itself.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "nav/api/time.h"

namespace polnav::nav::ukf {

class Doubt {
 public:
  explicit Doubt(double after_s) : after_(FromSeconds(after_s)) {}

  void Reset() { count_ = 0; }

  // A refused reading's residual. Their mean square, once they are many, agree to within half of
  // it, and have been coming for long enough; after that it begins anew.
  [[nodiscard]] std::optional<double> Add(TimeNs stamp, const Eigen::Vector2d& residual) {
    if (count_ == 0) {
      since_ = stamp;
      sum_.setZero();
      squares_ = 0.0;
    }
    ++count_;
    sum_ += residual;
    squares_ += residual.squaredNorm();
    if (count_ < kLeast || stamp - since_ < after_) return std::nullopt;
    const double mean2 = (sum_ / count_).squaredNorm();
    const double spread2 = squares_ / count_ - mean2;
    count_ = 0;
    if (spread2 > 0.25 * mean2) return std::nullopt;
    return squares_ == 0.0 ? std::nullopt : std::optional(mean2 + spread2);
  }

 private:
  static constexpr int kLeast = 5;
  TimeNs after_;
  TimeNs since_ = 0;
  int count_ = 0;
  Eigen::Vector2d sum_ = Eigen::Vector2d::Zero();
  double squares_ = 0.0;
};

}  // namespace polnav::nav::ukf
