// Tables as other programs write them are read; what is broken is refused by line.
#include "tools/testbed/dataset/table_reader.h"

#include <gtest/gtest.h>

#include "tests/testbed/dataset/dataset_files.h"
#include "tests/testbed/temporary_folder.h"
#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

class Table : public ::testing::Test {
 protected:
  // How many rows of two fields it has, or what is wrong with it.
  std::string Read(const std::string& text, TableKind kind = TableKind::kStampedCsv) {
    WriteText(file_, text);
    int rows = 0;
    try {
      TableReader reader(file_, kind);
      while (const auto row = reader.Next()) {
        reader.ExpectFields(*row, {2});
        (void)reader.Number(*row, 0);
        (void)reader.Number(*row, 1);
        ++rows;
      }
    } catch (const InputError& error) {
      return std::string(error.what()).substr(file_.string().size());
    }
    return std::to_string(rows);
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.path() / "data.csv";
};

TEST_F(Table, PassesOverHeadersBlankLinesAndWindowsLineEnds) {
  EXPECT_EQ(Read("#timestamp [ns],a,b\r\n1403715273262142976, 0.5 ,-1e-3\r\n\r\n"
                 "1403715273267142976,+2,3"),
            "2");
  EXPECT_EQ(Read("0.0 1 2\r\n1.037e-01   3\t4\n", TableKind::kSecondsWords), "2");
  EXPECT_EQ(Read("1 2\n1 2\n", TableKind::kWords), "2");
  EXPECT_EQ(Read(""), "0");
}

TEST_F(Table, NamesTheLineThatIsBroken) {
  EXPECT_EQ(Read("#\n1,2,3\n2,3\n"), ":3: expected 3 columns, got 2");
  EXPECT_EQ(Read("1,2,3,\n"), ":1: expected 3 columns, got 4");
  EXPECT_EQ(Read("1,2,3\n2,2,x\n"), ":2: column 3: expected a number, got 'x'");
  EXPECT_EQ(Read("1,2,nan\n"), ":1: column 3: expected a number, got 'nan'");
  EXPECT_EQ(Read("1,,3\n"), ":1: column 2: expected a number, got ''");
  EXPECT_EQ(Read("1.5,2,3\n"), ":1: expected a time in whole nanoseconds, got '1.5'");
  EXPECT_NE(Read("9223372036854775807,2,3\n").find("expected a time"), std::string::npos);
  EXPECT_EQ(Read("x 2 3\n", TableKind::kSecondsWords), ":1: expected a time in seconds, got 'x'");
  EXPECT_EQ(Read("5,2,3\n5,2,3\n"), ":2: the time does not increase: 5 ns after 5 ns");
  EXPECT_EQ(Read("5,2,3\n4,2,3\n"), ":2: the time does not increase: 4 ns after 5 ns");
  EXPECT_THROW(TableReader(folder_.path() / "none.csv", TableKind::kStampedCsv), InputError);
  EXPECT_THROW(TableReader(folder_.path(), TableKind::kStampedCsv), InputError);
}

TEST_F(Table, TheLastStampIsFoundFromTheEndWhateverStandsThere) {
  std::string text = "#timestamp\n";
  for (int i = 1; i <= 20000; ++i) text += std::to_string(1'000'000'000LL * i) + ",0,0\n";
  WriteText(file_, text + "broken\n20001");
  EXPECT_EQ(LastStamp(file_, TableKind::kStampedCsv), 20'000'000'000'000);
  WriteText(file_, "#timestamp\n");
  EXPECT_FALSE(LastStamp(file_, TableKind::kStampedCsv).has_value());
  EXPECT_FALSE(LastStamp(folder_.path() / "none", TableKind::kStampedCsv).has_value());
}

}  // namespace
}  // namespace polnav::testbed
