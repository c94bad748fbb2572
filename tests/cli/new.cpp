// hamel new: what it writes, and what it refuses. tests/consumers/new builds and runs what it
// writes.
#include "program.hpp"

namespace {

using namespace hamel::test;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

class New : public CommandLine {
 protected:
  void refused_name(const std::vector<std::string>& words, const std::string& message) {
    std::vector<std::string> line = {"new"};
    line.insert(line.end(), words.begin(), words.end());
    const std::vector<std::string> before = files();
    const Outcome o = run(line);
    EXPECT_EQ(o.status, 2) << message;
    EXPECT_THAT(o.err, HasSubstr(message));
    EXPECT_EQ(files(), before) << "nothing is written";
  }
};

TEST_F(New, EveryKindHasItsFiles) {
  for (const std::string& kind : std::vector<std::string>{"system", "group", "scheme", "project"}) {
    const std::string name = "own_" + kind, source = name + (kind == "project" ? ".toml" : ".hpp");
    const Outcome o = run({"new", kind, name});
    ASSERT_EQ(o.status, 0) << o.err;
    for (const std::string& part : {std::string("CMakeLists.txt"), std::string("README.md"),
                                    std::string(".github/workflows/ci.yml"),
                                    std::string("laws.cpp"), std::string("main.cpp"), source}) {
      const std::string text = contents(file(name + "/" + part));
      EXPECT_THAT(text, Not(IsEmpty())) << part;
      EXPECT_THAT(o.out, HasSubstr(name + "/" + part));
      for (const char* token : {"my_", "MyName", "hamel_version", "hamel_release"})
        EXPECT_THAT(text, Not(HasSubstr(token))) << part;
    }
    EXPECT_THAT(contents(file(name + "/README.md")), HasSubstr("# " + name));
  }
  EXPECT_THAT(contents(file("own_system/own_system.hpp")),
              AllOf(HasSubstr("struct OwnSystem {"), HasSubstr("return \"own_system\"")));
}

TEST_F(New, TheFileForCINamesThePackagesOfThisRelease) {
  ASSERT_EQ(run({"new", "system", "skate"}).status, 0);
  const std::string version = split(run({"--version"}).out, ' ').at(1);
  EXPECT_THAT(contents(file("skate/.github/workflows/ci.yml")),
              AllOf(HasSubstr("releases/download/v" + version),
                    HasSubstr("${package}_" + version + "_amd64.deb")));
}

TEST_F(New, NothingIsOverwritten) {
  ASSERT_EQ(run({"new", "group", "lattice"}).status, 0);
  const std::string before = contents(file("lattice/lattice.hpp"));
  refused_name({"system", "lattice"}, "NAME: 'lattice' exists in this folder");
  EXPECT_EQ(contents(file("lattice/lattice.hpp")), before);
  write("skate", "a file");
  refused_name({"system", "skate"}, "NAME: 'skate' exists in this folder");
}

TEST_F(New, MistakesNameTheNearestValidName) {
  refused_name({"sytem", "skate"}, "did you mean 'system'?");
  refused_name({"system", "My-Skate"}, "got 'My-Skate', expected small letters");
  refused_name({"system", "My-Skate"}, "a letter first: my_skate");
  refused_name({"system", "2wheels"}, ": my_2wheels");
  refused_name({"system", "a__b"}, ": a_b");
  refused_name({"system", "../skate"}, ": skate");
  refused_name({"system", "..."}, ": my_name");
  refused_name({"system", "test"}, "'test' is taken by CMake");
  refused_name({"system", "group"}, ": my_group");
  refused_name({"system", "suslov"}, "'suslov' is a system of the library: my_suslov");
  refused_name({"system", "bicycle"}, "'bicycle' is a system of the library");
  refused_name({"group", "so3"}, "'so3' is a group of the library");
  refused_name({"scheme", "dla"}, "'dla' is a scheme of the library");
  refused_name({"system"}, "NAME");
  const Outcome both = run({"new", "sytem", "My"});
  EXPECT_THAT(both.err, AllOf(HasSubstr("unknown kind 'sytem'"), HasSubstr("got 'My'")));
}

TEST_F(New, AFolderThatCannotBeMadeIsSaid) {
  const Outcome o = run({"new", "system", std::string(300, 'a')});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr("cannot make the folder"));
}

}  // namespace
