#include <gtest/gtest.h>

#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/architecture/source_tree.h"

namespace polnav::architecture {
namespace {

// A key in brackets, alone or followed by where in the paper: one author, four digits of a year.
std::vector<std::string> CitedKeys(const std::string& text) {
  static const std::regex citation(R"(\[([A-Z][A-Za-z]+[0-9]{4}[a-z]?)(?:,[^\]]{0,80})?\])");
  std::vector<std::string> keys;
  for (std::sregex_iterator it(text.begin(), text.end(), citation), end; it != end; ++it) {
    keys.push_back((*it)[1].str());
  }
  return keys;
}

// Entries of the bibliography start with their key in bold.
std::set<std::string> BibliographyKeys() {
  static const std::regex entry(R"(\n- \*\*([A-Za-z]+[0-9]{4}[a-z]?)\*\*)");
  std::set<std::string> keys;
  for (const SourceFile& file : ReadTree(Root(), {"docs/bibliography.md"}, {".md"})) {
    for (std::sregex_iterator it(file.text.begin(), file.text.end(), entry), end; it != end; ++it) {
      EXPECT_TRUE(keys.insert((*it)[1].str()).second) << (*it)[1].str() << " is there twice";
    }
  }
  return keys;
}

TEST(Citations, ResolveInTheBibliography) {
  const std::set<std::string> known = BibliographyKeys();
  ASSERT_TRUE(known.contains("Chu2021"));
  const std::vector<SourceFile> files =
      ReadTree(Root(), {"sky", "nav", "sim", "tools", "tests", "scenarios", "docs", "README.md"},
               {".h", ".cpp", ".md", ".yaml", ".txt"});
  std::size_t citations = 0;
  for (const SourceFile& file : files) {
    for (const std::string& key : CitedKeys(file.text)) {
      ++citations;
      EXPECT_TRUE(known.contains(key)) << file.path << " cites " << key;
    }
  }
  EXPECT_GT(citations, 10U);
}

// The brackets are put on at run time, so that this file cites nobody.
TEST(Citations, FindKeysWithAndWithoutAPlace) {
  const std::string open = "[";
  EXPECT_EQ(CitedKeys(open + "Nobody1999]"), std::vector<std::string>{"Nobody1999"});
  EXPECT_EQ(CitedKeys(open + "Nobody1999, eqs 5-7]"), std::vector<std::string>{"Nobody1999"});
  EXPECT_TRUE(CitedKeys(open + "0, 2 pi) array[3] [rad] [Wave2]").empty());
  EXPECT_FALSE(BibliographyKeys().contains("Nobody1999"));
}

}  // namespace
}  // namespace polnav::architecture
