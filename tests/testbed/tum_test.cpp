// A trajectory survives being written and read, and a broken file is refused by line.
#include "tools/testbed/tum.h"

#include <gtest/gtest.h>

#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

std::string ErrorOf(const std::string& text) {
  try {
    (void)ParseTum(text, "a.tum");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Tum, KeepsNanosecondsAndPoses) {
  const Eigen::Quaterniond q = Eigen::Quaterniond(0.1, -0.7, 0.3, 0.2).normalized();
  // An epoch of today in nanoseconds does not fit into a double.
  const Trajectory trajectory{{-1'500'000'001, {q, {1.0 / 3.0, -1e-9, 1e6}}},
                              {0, {}},
                              {1'700'000'000'123'456'789, {q.conjugate(), {0.1, 0.2, 0.3}}}};
  const Trajectory again = ParseTum(ToTum(trajectory), "again");
  ASSERT_EQ(again.size(), trajectory.size());
  for (std::size_t i = 0; i < again.size(); ++i) {
    EXPECT_EQ(again[i].stamp, trajectory[i].stamp);
    // 15 digits: half a unit in the last of 1e6 m is 5e-10 m.
    EXPECT_LT((again[i].T_WB.p - trajectory[i].T_WB.p).norm(), 1e-9);
    EXPECT_LT(again[i].T_WB.q.angularDistance(trajectory[i].T_WB.q), 1e-7);
  }
}

TEST(Tum, ReadsWhatOthersWrite) {
  const Trajectory t = ParseTum(
      "# comment\r\n\r\n1.5 1 2 3 0 0 0 1\r\n 1.6e+00\t+1 2e0 .5 0 0 0.7071 0.7071 # end\n",
      "other");
  ASSERT_EQ(t.size(), 2U);
  EXPECT_EQ(t[0].stamp, 1'500'000'000);
  EXPECT_EQ(t[1].stamp, 1'600'000'000);
  EXPECT_NEAR(t[1].T_WB.q.norm(), 1.0, 1e-15);
  EXPECT_EQ(ParseTum("0.0000000005 0 0 0 0 0 0 1", "x")[0].stamp, 1);  // rounded
}

TEST(Tum, RefusesWhatIsBrokenByLine) {
  EXPECT_EQ(ErrorOf("0 0 0 0 0 0 0 1\n1 2 3\n"),
            "a.tum:2: expected 't x y z qx qy qz qw', got 3 words");
  EXPECT_EQ(ErrorOf("0 a 0 0 0 0 0 1\n"), "a.tum:1: 'a' is no number");
  EXPECT_EQ(ErrorOf("0 nan 0 0 0 0 0 1\n"), "a.tum:1: 'nan' is no number");
  EXPECT_EQ(ErrorOf("t 0 0 0 0 0 0 1\n"), "a.tum:1: 't' is no time");
  EXPECT_EQ(ErrorOf("99999999999 0 0 0 0 0 0 1\n"), "a.tum:1: '99999999999' is no time");
  EXPECT_EQ(ErrorOf("0 0 0 0 0 0 0 0\n"), "a.tum:1: the quaternion's length is 0, not 1");
  EXPECT_EQ(ErrorOf("1 0 0 0 0 0 0 1\n\n1 0 0 0 0 0 0 1\n"), "a.tum:3: the time does not increase");
  EXPECT_EQ(ErrorOf("# nothing\n"), "a.tum: holds no pose");
  EXPECT_THROW((void)ReadTum("/nowhere.tum"), InputError);
  EXPECT_THROW((void)ReadTum("/"), InputError);
}

}  // namespace
}  // namespace polnav::testbed
