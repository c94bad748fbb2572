// What users' files and names may ask for at most: a clear refusal, never a crash, a wait or a
// gigabyte.
#include <sys/stat.h>

#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <hamel/framework/analysis/analysis.hpp>
#include <hamel/framework/io/text_file.hpp>
#include <hamel/framework/run/data/data_system.hpp>

#include "../study/studies.hpp"

namespace {

using namespace hamel;
using testing::AllOf;
using testing::Contains;
using testing::Each;
using testing::HasSubstr;
using testing::Not;

std::string repeated(const std::string& word, int count) {
  std::string out;
  for (int i = 0; i < count; ++i) out += word;
  return out;
}

/// The mistakes of a text read as each of the three kinds of files.
std::vector<std::vector<std::string>> refusals(const std::string& text) {
  std::vector<std::vector<std::string>> out;
  const auto take = [&](auto read) {
    try {
      read();
      out.push_back({"accepted"});
    } catch (const ConfigError& error) {
      out.push_back(error.mistakes());
    }
  };
  take([&] { Config::from_toml(text, "file"); });
  take([&] { data_system(registry(), text, "file"); });
  take([&] { parse_study(text, "file", registry()); });
  return out;
}

/// Half a million levels of each kind of nesting end toml++, which works by recursion, in a stack
/// overflow.
TEST(Limits, DepthOfToml) {
  constexpr int kDeep = 500'000;
  for (const std::string& text :
       {"a = " + repeated("[", kDeep), "a = " + repeated("{a=", kDeep),
        "a" + repeated(".a", kDeep) + " = 1", "[a" + repeated(".a", kDeep) + "]",
        "a" + repeated(" . 'a'", kDeep) + " = 1", "a = {a" + repeated(".\"a\"", kDeep) + " = 1}",
        "[[a" + repeated(".a", kDeep) + "]]\n",
        // A string of three quotes may end with two more.
        "a = [\"\"\" \"\"\"\"\"," + repeated("[", kDeep)}) {
    for (const auto& mistakes : refusals(text))
      EXPECT_THAT(mistakes, testing::ElementsAre("file:1: nested more than 30 deep"))
          << text.substr(0, 20);
  }
}

/// What only looks deep is read: dots and brackets in strings and comments, lists of floats, long
/// tables.
TEST(Limits, WhatIsNotDeep) {
  for (const std::string& text :
       {"# " + repeated("[.", 1000), "velocity = [" + repeated("1.5, ", 1000) + "1.5]",
        "system = '" + repeated("[a.", 1000) + "'", "system = \"\\\"" + repeated("{.", 1000) + "\"",
        "system = '''\n" + repeated("[a.\n", 1000) + "'''",
        std::string("set = { a = [[1.0, 2.0], [3.0]] }")}) {
    for (const auto& mistakes : refusals(text))
      EXPECT_THAT(mistakes, Each(Not(HasSubstr("deep")))) << text.substr(0, 20);
  }
  EXPECT_EQ(
      Config::from_toml("velocity = [" + repeated("1.5, ", 1000) + "1.5]").start.velocity.size(),
      1001u);
}

TEST(Limits, LengthOfToml) {
  const std::string text = "# " + std::string(kMaxText, 'x');
  for (const auto& mistakes : refusals(text))
    EXPECT_THAT(mistakes, testing::ElementsAre(HasSubstr("characters, more than 4000000")));
  // Long names are not repeated whole.
  for (const auto& mistakes : refusals(std::string(1'000'000, 'k') + " = 1"))
    for (const std::string& mistake : mistakes) EXPECT_LT(mistake.size(), 2000u);
}

/// Every refusal of a data system names what is wrong.
TEST(Limits, DataSystemsAreRefusedWithAReason) {
  for (const std::string text :
       {"", "group = ''", "group = 1", "group = []", "group = '*'", "group = '^'", "group = 'so3^'",
        "group = 'so2^0'", "group = 'so3'\ninertia = []", "group = 'so2^1001'\ninertia = [1]"}) {
    EXPECT_THAT(refusals(text)[1], Not(testing::IsEmpty())) << text;
    EXPECT_THAT(refusals(text)[1], Each(Not(testing::IsEmpty()))) << text;
  }
}

/// "so2^1000*so2^1000*...": its list of factors alone took gigabytes.
TEST(Limits, DimensionOfProducts) {
  const std::string thousand = "so2^1000", many = thousand + repeated("*so2^1000", 100'000);
  EXPECT_TRUE(registry().group_or_product(thousand).has_value());
  for (const std::string& name :
       {many, thousand + "*so2", std::string("se3^167"), std::string("so3*so2^999999999999999999"),
        std::string("r1001"), std::string("r99999999999999999999"), std::string("so3*r998")}) {
    EXPECT_FALSE(registry().group_or_product(name).has_value());
    EXPECT_THAT(registry().missing_group(name), AllOf(HasSubstr("its dimension is above 1000"),
                                                      testing::SizeIs(testing::Lt(200u))));
    EXPECT_THAT(refusals("group = '" + name + "'\ninertia = [1]")[1],
                Contains(HasSubstr("its dimension is above 1000")));
  }
  EXPECT_THAT(registry().missing_group("so2^1000*so4"), HasSubstr("unknown group"));
}

/// A pipe that nobody writes to keeps its reader waiting for ever.
TEST(Limits, OnlyRegularFilesAreRead) {
  const test::TemporaryFolder folder;
  const std::string pipe = folder / "pipe.toml", large = folder / "large.toml";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::ofstream(large) << std::string(kMaxText + 1, '#');
  for (const auto& [path, why] :
       {std::pair<std::string, const char*>{pipe, "it is no regular file"},
        {folder.path(), "it is no regular file"},
        {large, "characters, more than 4000000"},
        {folder / "none.toml", "there is no such file"}}) {
    const auto expect_refusal = [&, &file = path, &reason = why](auto read) {
      EXPECT_THAT([&] { read(file); },
                  testing::ThrowsMessage<ConfigError>(
                      AllOf(HasSubstr("cannot read '" + file + "'"), HasSubstr(reason))));
    };
    expect_refusal([](const std::string& file) { read_config(file); });
    expect_refusal([](const std::string& file) { read_study(file, registry()); });
    expect_refusal([](const std::string& file) { data_system_maker(registry(), file)({}); });
  }
}

/// Each takes 40 us to read.
TEST(Limits, NumberOfFormulas) {
  const std::string row = "[" + repeated("'t',", 150) + "],";
  const std::string text = "group = 'so2^150'\ninertia = [" + repeated("1,", 150) +
                           "]\nconstraints = [" + repeated(row.c_str(), 140) + "]";
  EXPECT_THAT([&] { data_system(registry(), text, "file"); },
              testing::ThrowsMessage<ConfigError>(HasSubstr(": more than 20000 formulas")));
}

/// Brackets take n^4 operations: so2^200 did not come back.
TEST(Limits, DimensionOfAnAnalysis) {
  Registry all = registry();
  SystemInfo wide;
  wide.name = "wide";
  wide.make = [&all](const Parameters&) {
    return data_system(all,
                       "group = 'so2^101'\ninertia = [" + repeated("1,", 101) + "]\nvelocity = [" +
                           repeated("1,", 101) + "]",
                       "wide");
  };
  all.add(wide);
  EXPECT_THAT([&] { analyse(all, "wide"); },
              testing::ThrowsMessage<ConfigError>(HasSubstr("its dimension 101 is above 100")));
}

}  // namespace
