#include <barchan/core/deck/deck.hpp>
#include <barchan/core/deck/schema.hpp>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

namespace barchan {
namespace {

std::filesystem::path source_dir() {
#ifdef BARCHAN_TREE
  return BARCHAN_TREE;
#else
  return std::filesystem::path(__FILE__).parent_path() / "../../..";
#endif
}

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

std::string row_of(const KeyDoc& doc) {
  return "| `" + doc.key + "` | " + doc.type + " | " + doc.unit + " | " + doc.default_value +
         " | " + doc.meaning + " |";
}

/// Rows of the reference, as `table: row`; a comment `<!-- keys of TABLE -->` stands over each of
/// its tables.
std::set<std::string> documented_rows() {
  std::set<std::string> rows;
  std::istringstream lines(read_text(source_dir() / "docs/deck.md"));
  std::string table;
  for (std::string line; std::getline(lines, line);) {
    const std::string mark = "<!-- keys of ";
    if (line.rfind(mark, 0) == 0) table = line.substr(mark.size(), line.find(" -->") - mark.size());
    if (line.empty()) table.clear();
    if (!table.empty() && line.rfind("| `", 0) == 0) rows.insert(table + ": " + line);
  }
  return rows;
}

std::set<std::string> parser_rows() {
  std::set<std::string> rows;
  for (const KeyDoc& doc : deck_keys()) rows.insert(doc.table + ": " + row_of(doc));
  return rows;
}

TEST(DeckReference, HoldsEveryKeyOfTheParser) {
  const auto documented = documented_rows();

  for (const std::string& row : parser_rows())
    EXPECT_TRUE(documented.count(row)) << "docs/deck.md lacks " << row;
}

TEST(DeckReference, HoldsNoKeyThatTheParserLacks) {
  const auto known = parser_rows();

  for (const std::string& row : documented_rows())
    EXPECT_TRUE(known.count(row)) << "only in docs/deck.md: " << row;
}

TEST(DeckReference, ShowsADeckThatIsRight) {
  const std::string text = read_text(source_dir() / "docs/deck.md");
  const std::size_t begin = text.find("```toml\n") + 8;

  EXPECT_NO_THROW(
      (void)parse_deck(text.substr(begin, text.find("```", begin) - begin), "docs/deck.md"));
}

TEST(DeckReference, HasExamplesThatAreRight) {
  std::size_t num_examples = 0;
  for (const auto& entry : std::filesystem::directory_iterator(source_dir() / "examples")) {
    if (entry.path().extension() != ".toml") continue;
    ++num_examples;
    EXPECT_NO_THROW((void)read_deck(entry.path().string())) << entry.path();
    const std::string text = read_text(entry.path());
    EXPECT_EQ(text.rfind("# ", 0), 0u) << entry.path();
    EXPECT_NE(text.find("# Run: "), std::string::npos) << entry.path();
    EXPECT_NE(text.find("# Look at: "), std::string::npos) << entry.path();
  }
  EXPECT_GE(num_examples, 7u);
}

}  // namespace
}  // namespace barchan
