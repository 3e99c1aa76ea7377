// Seconds written in decimals become whole nanoseconds, exactly.
#include "tools/testbed/decimal_time.h"

#include <gtest/gtest.h>

namespace polnav::testbed {
namespace {

TEST(DecimalTime, KeepsEveryNanosecondOfAnEpochOfToday) {
  EXPECT_EQ(ParseDecimalSeconds("1403636579.763555527"), 1'403'636'579'763'555'527);
  EXPECT_EQ(ParseDecimalSeconds("-1.000000001"), -1'000'000'001);
}

// A double would turn 0.1037 s into 103699999.99...
TEST(DecimalTime, ExponentsMoveTheDotOnly) {
  EXPECT_EQ(ParseDecimalSeconds("1.037000e-01"), 103'700'000);
  EXPECT_EQ(ParseDecimalSeconds("1.403636579763555527e9"), 1'403'636'579'763'555'527);
  EXPECT_EQ(ParseDecimalSeconds("12E+2"), 1'200'000'000'000);
  EXPECT_EQ(ParseDecimalSeconds("1e-30"), 0);
  EXPECT_EQ(ParseDecimalSeconds("0.000000e+00"), 0);
}

TEST(DecimalTime, RoundsWhatIsBelowANanosecond) {
  EXPECT_EQ(ParseDecimalSeconds("0.0000000004"), 0);
  EXPECT_EQ(ParseDecimalSeconds(".0000000005"), 1);
  EXPECT_EQ(ParseDecimalSeconds("5e-10"), 1);
  EXPECT_EQ(ParseDecimalSeconds("1.9999999999"), 2'000'000'000);
}

TEST(DecimalTime, IsNothingWhenItIsNoTime) {
  for (const char* text : {"", ".", "-", "e5", "1e", "1e+", "1.2.3", "0x10", "nan", "1 s", "--1",
                           "1e99", "99999999999", "1,5"}) {
    EXPECT_FALSE(ParseDecimalSeconds(text).has_value()) << text;
  }
}

}  // namespace
}  // namespace polnav::testbed
