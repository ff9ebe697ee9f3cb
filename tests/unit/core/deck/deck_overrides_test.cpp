#include <barchan/core/deck/deck.hpp>

#include <gtest/gtest.h>

#include <unit/core/deck_text.hpp>

namespace barchan {
namespace {

Deck with(const std::vector<DeckOverride>& overrides) {
  return parse_deck(deck_test::good_deck(), "test.toml", overrides);
}

std::string error_with(const std::string& key, const std::string& value) {
  try {
    (void)with({{key, value}});
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(DeckOverrides, ReplaceValuesByDottedKey) {
  const Deck deck = with({{"time.step", "1e-3"}, {"gravity", "[0.0, -1.62]"}});

  EXPECT_EQ(deck.model.time.num_steps, 2000);
  EXPECT_EQ(deck.model.gravity.y(), -1.62);
}

TEST(DeckOverrides, FindEntriesByNameAndByNumber) {
  const Deck deck = with({{"material.soil.friction", "0.1"}, {"particles.1.count", "17"}});

  EXPECT_EQ(deck.model.contacts.at(0, 0).mu, 0.1);
  EXPECT_EQ(std::get<PackingSource>(deck.sources[0].kind).count, 17);
}

TEST(DeckOverrides, TakeBareWordsAsStringsAndAddMissingTables) {
  const Deck deck = with({{"search.kind", "all-pairs"}});

  EXPECT_EQ(deck.model.search.kind, ContactSearchKind::AllPairs);
}

TEST(DeckOverrides, AreCheckedLikeTheDeckAndPlacedAtTheOption) {
  EXPECT_EQ(
      error_with("time.stpe", "1").rfind("--set time.stpe=1: unknown key 'stpe' in [time]", 0), 0u);
  EXPECT_EQ(
      error_with("time.step", "fast").rfind("--set time.step=fast: step: expected a number", 0),
      0u);
  EXPECT_EQ(error_with("time.step", "-1").rfind("--set time.step=-1: step = -1 is out of range", 0),
            0u);
}

TEST(DeckOverrides, NameTheEntriesThatExist) {
  EXPECT_NE(error_with("material.siol.friction", "1").find("did you mean 'soil'?"),
            std::string::npos);
  EXPECT_NE(error_with("particles.9.count", "1").find("numbered from 1"), std::string::npos);
  EXPECT_NE(error_with("time.step.more", "1").find("lies inside a number"), std::string::npos);
  EXPECT_NE(error_with("time..step", "1").find("not a dotted key"), std::string::npos);
}

TEST(DeckOverrides, AreTakenApartAtTheFirstEqualsSign) {
  const DeckOverride change = parse_override("title=a=b");

  EXPECT_EQ(change.key, "title");
  EXPECT_EQ(change.value, "a=b");
  EXPECT_THROW((void)parse_override("title"), InputError);
  EXPECT_THROW((void)parse_override("=3"), InputError);
}

}  // namespace
}  // namespace barchan
