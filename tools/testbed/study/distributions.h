// Which value lies at this quantile?
//
// All sampling starts from uniform numbers in (0, 1), so that random, Latin hypercube and Sobol
// points serve every distribution alike.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <vector>

namespace polnav::testbed {

[[nodiscard]] double NormalQuantile(double u, double mean, double sigma);

// Of a normal distribution cut off at min and max (infinite: not cut). Exact into both tails.
[[nodiscard]] double TruncatedNormalQuantile(double u, double mean, double sigma, double min,
                                             double max);

[[nodiscard]] double UniformQuantile(double u, double min, double max);

// log of the value is uniform; 0 < min.
[[nodiscard]] double LogUniformQuantile(double u, double min, double max);

// Which of the values, by their weights; all alike when there are none.
[[nodiscard]] std::size_t DiscreteQuantile(double u, std::size_t count,
                                           const std::vector<double>& weights);

// L of covariance = L L^T; nothing when it is not symmetric and positive definite.
[[nodiscard]] std::optional<Eigen::MatrixXd> CholeskyFactor(const Eigen::MatrixXd& covariance);

}  // namespace polnav::testbed
