#include <barchan/core/model/contact_numbers.hpp>

#include <gtest/gtest.h>

#include <string>

#include <barchan/core/base/error.hpp>

namespace barchan {
namespace {

std::string words_of_fault(const ContactTable& table, const std::string& key, double value) {
  ContactConstants pair;
  try {
    set_number(table, pair, key, value);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

TEST(ContactNumbers, ADashpotFollowsTheSpringAndTheRestitution) {
  const ContactTable table;
  ContactConstants pair;
  set_number(table, pair, "normal_stiffness", 1e4);
  set_number(table, pair, "restitution", 0.5);
  const double critical = pair.cn.critical;
  EXPECT_GT(critical, 0.0);
  set_number(table, pair, "normal_stiffness", 4e4);
  EXPECT_DOUBLE_EQ(pair.cn.critical, 2.0 * critical);
  set_number(table, pair, "normal_damping", 3.0);
  EXPECT_EQ(pair.cn.constant, 3.0);
  EXPECT_EQ(pair.cn.critical, 0.0);
  EXPECT_FALSE(pair.restitution);
  set_number(table, pair, "friction", 0.3);
  EXPECT_EQ(pair.mu, 0.3);
}

TEST(ContactNumbers, RefusesKeysOfOtherLawsInWords) {
  const ContactTable table;
  EXPECT_NE(words_of_fault(table, "young_modulus", 1e9).find("normal_stiffness"),
            std::string::npos);
  EXPECT_NE(words_of_fault(table, "restitution", 1.5).find("from 0 to 1"), std::string::npos);
}

}  // namespace
}  // namespace barchan
