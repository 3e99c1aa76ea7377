#include "tests/architecture/include_rules.h"

#include <gtest/gtest.h>

namespace polnav::architecture {
namespace {

std::size_t Broken(const std::string& path, const std::string& line) {
  return IncludeViolations({path, "#pragma once\n" + line + "\n"}).size();
}

TEST(IncludeRules, HoldInEverySourceFile) {
  const std::vector<SourceFile> files = ReadCpp();
  ASSERT_GT(files.size(), 20U);  // the tree was found
  for (const SourceFile& file : files) {
    for (const std::string& violation : IncludeViolations(file)) ADD_FAILURE() << violation;
  }
}

TEST(IncludeRules, HeadersGuardThemselves) {
  for (const SourceFile& file : ReadCpp()) {
    if (!file.path.ends_with(".h")) continue;
    EXPECT_NE(file.text.find("#pragma once\n"), std::string::npos) << file.path;
    EXPECT_TRUE(file.text.starts_with("// ")) << file.path << " does not say what it answers";
  }
}

// A rule that cannot be broken holds nothing: each is broken here once, and kept once.
TEST(IncludeRules, FindAPlantedViolation) {
  EXPECT_EQ(Broken("sim/planted.cpp", "#include \"nav/stereo/tracker.h\""), 1U);
  EXPECT_EQ(Broken("sim/planted.cpp", "#include \"nav/api/time.h\""), 0U);
  EXPECT_EQ(Broken("nav/stereo/planted.h", "  #  include \"sim/truth.h\""), 1U);
  EXPECT_EQ(Broken("nav/stereo/planted.h", "#include \"sky/rayleigh.h\""), 0U);
  EXPECT_EQ(Broken("nav/polarization/planted.h", "#include \"sky/skylight.h\""), 1U);
  EXPECT_EQ(Broken("nav/polarization/planted.h", "#include \"sky/hazy.h\""), 1U);
  EXPECT_EQ(Broken("nav/polarization/planted.h", "#include \"sky/clouds.h\""), 1U);
  EXPECT_EQ(Broken("sky/planted.h", "#include \"nav/api/geometry.h\""), 1U);
  EXPECT_EQ(Broken("sky/planted.h", "#include <Eigen/Core>\n#include <cmath>"), 0U);
  EXPECT_EQ(Broken("nav/api/planted.h", "#include <opencv2/imgproc.hpp>"), 1U);
  EXPECT_EQ(Broken("nav/api/planted.h", "#include <opencv2/core/mat.hpp>"), 0U);
  EXPECT_EQ(Broken("nav/api/planted.h", "#include \"nav/stereo/tracker.h\""), 1U);
  EXPECT_EQ(Broken("sim/sensors/planted.cpp", "#include <GL/osmesa.h>"), 1U);
  EXPECT_EQ(Broken("sim/world/planted.cpp", "#include <btBulletDynamicsCommon.h>"), 1U);
  EXPECT_EQ(Broken("sim/planted.cpp", "#include <ceres/ceres.h>"), 1U);
  EXPECT_EQ(Broken("tools/testbed/planted.cpp", "#include \"tools/polnav/commands.h\""), 1U);
  EXPECT_EQ(Broken("sim/planted.cpp", "#include \"random.h\""), 1U);
  EXPECT_EQ(Broken("sim/planted.cpp", "#include <sim/random.h>"), 1U);
  EXPECT_EQ(Broken("elsewhere/planted.cpp", ""), 1U);
}

}  // namespace
}  // namespace polnav::architecture
