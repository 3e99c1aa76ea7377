#include "tools/testbed/hash.h"

#include <gtest/gtest.h>

#include "tools/testbed/run_record.h"

namespace polnav::testbed {
namespace {

// NIST's example of FIPS 180-4.
TEST(Sha256, OfAbcIsThePublishedOne) {
  EXPECT_EQ(Sha256Of("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Sha256, DoesNotDependOnThePieces) {
  Sha256 hash;
  hash.Update("a");
  (void)hash.HexDigest();  // looking does not end it
  hash.Update("");
  hash.Update("bc");
  EXPECT_EQ(hash.HexDigest(), Sha256Of("abc"));
}

TEST(HashOf, SeesEveryFieldOfAnEstimate) {
  const nav::Estimate e;
  const std::string base = HashOf({e});
  nav::Estimate changed = e;
  changed.tracked = true;
  EXPECT_NE(HashOf({changed}), base);
  changed = e;
  changed.covariance(5, 0) = 1e-300;
  EXPECT_NE(HashOf({changed}), base);
  changed = e;
  changed.T_WB.p.z() = 1e-300;
  EXPECT_NE(HashOf({changed}), base);
  EXPECT_NE(HashOf({e, e}), base);
  EXPECT_EQ(HashOf({e}), base);
}

}  // namespace
}  // namespace polnav::testbed
