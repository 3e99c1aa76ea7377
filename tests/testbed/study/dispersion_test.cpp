// Dispersions: what they draw, and which of them cannot be meant.
#include "tools/testbed/study/dispersion.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/testbed/study/study_fixture.h"
#include "tools/testbed/study/sampling.h"

namespace polnav::testbed {
namespace {

Dispersion Make(const DispersionOptions& options, const std::string& folder = ".") {
  const YamlDocument document{.file = "s.yaml", .root = {}, .overrides = {}};
  return Dispersion(document, "dispersions.0", options, folder);
}

TEST(Dispersion, CorrelatedValuesHaveTheirCovariance) {
  DispersionOptions options;
  options.keys = {"a", "b"};
  options.correlated = {.mean = {1.0, -1.0},
                        .sigma = {2.0, 0.5},
                        .correlation = {{1.0, 0.8}, {0.8, 1.0}},
                        .covariance = {}};
  const Dispersion dispersion = Make(options);
  ASSERT_EQ(dispersion.Dimensions().size(), 2U);
  const UnitSampler sampler(Sampling::kSobol, 1, 0, dispersion.Dimensions());
  const int n = 4096;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance = Eigen::Matrix2d::Zero();
  for (int i = 0; i < n; ++i) {
    const auto values = dispersion.At(sampler.At(static_cast<std::uint64_t>(i)), 0);
    const Eigen::Vector2d d(*values[0].number - 1.0, *values[1].number + 1.0);
    mean += d / n;
    covariance += d * d.transpose() / n;
  }
  // Sobol points leave well below the 1/sqrt(n) = 1.6 % of random ones.
  EXPECT_NEAR(mean.norm(), 0.0, 0.01);
  EXPECT_NEAR(covariance(0, 0), 4.0, 0.04);
  EXPECT_NEAR(covariance(1, 1), 0.25, 0.0025);
  EXPECT_NEAR(covariance(0, 1), 0.8, 0.008);
}

TEST(Dispersion, TablesGiveWholeRows) {
  const StudyFolder folder;
  std::ofstream(folder.File("t.csv")) << "# measured\nx, y ,z\r\n1,10,a\n\n2,20,b\n3,30,c\n";
  DispersionOptions options;
  options.keys = {"p", "q"};
  options.table = {.file = "t.csv", .columns = {"x", "y"}, .order = "in_order"};
  const Dispersion rows = Make(options, folder.File(""));
  for (std::uint64_t i = 0; i < 7; ++i) {
    const auto values = rows.At(std::vector<double>{0.99}, i);
    EXPECT_EQ(*values[0].number, static_cast<double>(i % 3 + 1));
    EXPECT_EQ(*values[1].number, 10.0 * *values[0].number);
  }
  options.table->order = "random";
  EXPECT_EQ(Make(options, folder.File("")).At(std::vector<double>{0.5}, 0)[1].text, "20");
  EXPECT_EQ(rows.TableSha256().size(), 64U);
}

TEST(Dispersion, ATextThatIsNoNumberStaysText) {
  EXPECT_FALSE(TextInput("k", "icm20602").number.has_value());
  EXPECT_FALSE(TextInput("k", "1e999").number.has_value());
  EXPECT_EQ(TextInput("k", "1e-3").number, 1e-3);
  EXPECT_EQ(NumberInput("k", 0.1).text, "0.1");
  EXPECT_EQ(*TextInput("k", NumberInput("k", 1.0 / 3.0).text).number, 1.0 / 3.0);
}

TEST(Dispersion, RefusesWhatCannotBeMeant) {
  const StudyFolder folder;
  const auto error = [&](const std::string& entry) {
    return folder.ErrorOf("dispersions:\n  - " + entry + "\n");
  };
  EXPECT_EQ(error("key: sky.max_dop"),
            "study.yaml:5: dispersions.0: expected exactly one of normal, uniform, log_uniform, "
            "discrete, correlated, table");
  EXPECT_EQ(error("uniform: {min: 0, max: 1}"),
            "study.yaml:5: dispersions.0: expected 'key', a scenario key such as sky.max_dop");
  EXPECT_EQ(error("{key: sky.max_dop, uniform: {min: 0.8, max: 0.3}}"),
            "study.yaml:5: dispersions.0.uniform.max: max 0.3 must be above min 0.8");
  EXPECT_EQ(error("{key: sky.max_dop, log_uniform: {min: 0, max: 0.3}}"),
            "study.yaml:5: dispersions.0.log_uniform.min: 0 has no logarithm: expected more than "
            "0");
  EXPECT_EQ(error("{key: sky.max_dop, normal: {mean: 0.5, sigma: 0}}"),
            "study.yaml:5: dispersions.0.normal.sigma: 0 is out of range, [1e-300, 1e+300]");
  EXPECT_EQ(error("{key: sky.max_dop, normal: {mean: 0.5, sigma: 0.001, min: 0.7}}"),
            "study.yaml:5: dispersions.0.normal: min and max leave nothing within 30 sigma of the "
            "mean");
  EXPECT_EQ(error("{key: sky.max_dop, discrete: {values: [0.5, 0.6], weights: [1]}}"),
            "study.yaml:5: dispersions.0.discrete.weights: 1 weights for 2 values");
  EXPECT_EQ(error("{key: sky.max_dop, normel: {mean: 0.5}}"),
            "study.yaml:5: dispersions.0.normel: unknown key; did you mean 'normal'?");
  EXPECT_EQ(error("{keys: [sky.max_dop, sky.wind_m_s], correlated: {mean: [0.7, 8], sigma: [0.1, "
                  "1], correlation: [[1, 1.0], [1.0, 1]]}}"),
            "study.yaml:5: dispersions.0.correlated.correlation: expected a symmetric, positive "
            "definite matrix");
  EXPECT_EQ(error("{keys: [sky.max_dop, sky.wind_m_s], correlated: {mean: [0.7, 8], covariance: "
                  "[[1, 2], [2, 1]]}}"),
            "study.yaml:5: dispersions.0.correlated.covariance: expected a symmetric, positive "
            "definite matrix");
  EXPECT_EQ(error("{keys: [sky.max_dop], table: {file: none.csv}}"),
            "none.csv: there is no such table, or it cannot be read");
  std::ofstream(folder.File("t.csv")) << "max_dop,wind\n0.7\n";
  EXPECT_EQ(error("{keys: [sky.max_dop], table: {file: t.csv}}"),
            "t.csv:2: 1 fields under a header of 2");
  std::ofstream(folder.File("t.csv")) << "max_dop,wind\n0.7,1\n";
  EXPECT_EQ(error("{keys: [sky.max_dop], table: {file: t.csv}}"),
            "study.yaml:5: dispersions.0.table: 'sky.max_dop' is no column of t.csv: max_dop, "
            "wind; did you mean 'max_dop'?");
}

}  // namespace
}  // namespace polnav::testbed
