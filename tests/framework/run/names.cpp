// Names: what the registry makes when it is asked for, and which kinds of files it holds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/framework/run/names/registry.hpp>
#include <hamel/simulate.hpp>
#include <hamel/systems/by_text.hpp>

namespace hamel {
namespace {

// A deferred system is described once, when its name is first looked up, by whomever.
TEST(Registry, DescribesDeferredSystemsWhenAsked) {
  Registry mine;
  std::atomic<int> made = 0;
  mine.add_deferred("late", [&made] {
    ++made;
    SystemInfo info;
    info.name = "late";
    return info;
  });
  EXPECT_THAT(mine.systems_and_files(), testing::ElementsAre("late"));
  EXPECT_EQ(mine.system("later"), nullptr);
  EXPECT_EQ(made, 0);
  std::vector<std::jthread> asking;
  for (int k = 0; k < 4; ++k) asking.emplace_back([&mine] { (void)mine.system("late"); });
  asking.clear();
  ASSERT_NE(mine.system("late"), nullptr);
  EXPECT_EQ(mine.system("late")->name, "late");
  EXPECT_EQ(made, 1);
}

// Kinds of files are the registry's, not the process's.
TEST(Registry, HoldsItsKindsOfFiles) {
  EXPECT_TRUE(Registry().file_kinds().empty());
  ASSERT_EQ(registry().file_kinds().size(), 1u);
  EXPECT_EQ(registry().file_kinds().front().keys.front(), "body");
}

// A format whose package a build lacks is named with it; one that it has becomes TOML, its notes
// those of the system.
TEST(Registry, ReadsFormatsOfOtherPrograms) {
  Registry lacking;
  lacking.add(FileFormat{".urdf", {"wheel"}, "liburdfdom-dev"});
  try {
    (void)data_system_maker(lacking, "robot.urdf?wheel=left", "<robot/>")({});
    FAIL() << "not refused";
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "robot.urdf: this build reads no .urdf files: install liburdfdom-dev and build it "
                 "again");
  }
  Registry having = registry();
  FileFormat format{".own", {"size"}};
  format.convert = [](const std::string& text, const std::string& path, const NameOptions&) {
    return FileFormat::Converted{text + "name = \"own\"\n", {path + " has more"}};
  };
  having.add(format);
  const SystemModel model =
      data_system_maker(having, "x.own", "group = \"r1\"\ninertia = [1]\n")({});
  EXPECT_EQ(model.name, "own");
  EXPECT_THAT(model.notes, testing::ElementsAre("x.own has more"));
}

// Names of files, and the options behind the question mark.
TEST(Registry, RecognisesFilesByName) {
  EXPECT_TRUE(names_file("a/b.toml"));
  EXPECT_TRUE(names_file("robot.urdf"));
  const std::string name = with_name_option(
      with_name_option("a?/robot.urdf", "wheel", {"left", "right"}), "root", {"free"});
  EXPECT_EQ(name, "a?/robot.urdf?wheel=left,right&root=free");
  EXPECT_TRUE(names_file(name));
  EXPECT_EQ(path_of_system(name), "a?/robot.urdf");
  EXPECT_EQ(options_of_system(name),
            (NameOptions{{"wheel", {"left", "right"}}, {"root", {"free"}}}));
  for (const char* other : {"suslov", "robot.urdf.gz", "urdf"}) EXPECT_FALSE(names_file(other));
}

/// r1, r2, r3 are compiled; the others are made of lines, and move as products of these.
TEST(Registry, HasTranslationsOfAnyDimension) {
  const auto info = registry().group_or_product("r5");
  ASSERT_TRUE(info.has_value());
  EXPECT_THAT(info->columns, testing::ElementsAre("x1", "x2", "x3", "x4", "x5"));
  EXPECT_EQ(info->factors.size(), 1u);
  EXPECT_EQ(info->matrices(std::vector<double>{1, 2, 3, 4, 5}).front()(3, 5), 4);
  for (const std::string name : {"r", "r0", "r01", "r-1", "r5x", "R5", "r 5"})
    EXPECT_FALSE(registry().group_or_product(name).has_value()) << name;
  const auto end = [](const std::string& group) {
    const std::string text = "group = '" + group + R"('
inertia = [1, 2, 3, 4, 5]
coordinates = ["a", "b", "c", "d", "e"]
rates = ["u", "v", "w", "p", "q"]
potential = "a^2 + (b - a)^2 + c*d + e^4"
constraints = [[1, 0, "b", 0, 1]]
velocity = [0.1, 0.2, 0, 0.3, -0.1]
)";
    return simulate_text(text, "springs.toml").step(0.01).until(1).run().last.coordinates;
  };
  EXPECT_EQ(end("r5"), end("r2*r3"));
}

TEST(ByName, ListsAndDescribes) {
  EXPECT_THAT(systems(), testing::IsSupersetOf({"suslov", "bicycle", "n_trailer"}));
  EXPECT_THAT(schemes(), testing::IsSupersetOf({"lift", "dop853"}));
  EXPECT_THAT(retractions("so3"), testing::IsSupersetOf({"cayley", "exp"}));
  EXPECT_THAT(retractions("se2*so2^5"), testing::Contains("cayley"));
  const SystemDescription segway = describe_system("segway");
  EXPECT_EQ(segway.velocities.size(), 6u);
  EXPECT_EQ(segway.inputs.size(), 2u);
  for (const std::string& name : systems()) {
    const SystemDescription d = describe_system(name);
    EXPECT_EQ(d.name, name);
    EXPECT_FALSE(d.coordinates.empty()) << name;
    EXPECT_FALSE(d.velocities.empty()) << name;
  }
  EXPECT_THROW(describe_system("suslof"), ConfigError);
}

// The text of a file is the system of that file, bit for bit, and its name is in the messages.
TEST(ByName, RunsAndDescribesATextAtHand) {
  const std::string text = R"(
group = "se2"
coordinates = ["theta", "x", "y"]
rates = ["omega", "v1", "v2"]
inertia = ["J", "m", "m"]
constraints = [[0, 0, 1]]
force = ["push", 0, 0]
velocity = [1, 2, 0]
[parameters]
m = { value = 2, unit = "kg" }
J = 0.5
[inputs]
push = { unit = "N m" }
)";
  const Result result = simulate_text(text, "sleigh.toml").set("m", 3).step(0.01).until(1).run();
  ASSERT_TRUE(result) << result.status.reason;
  EXPECT_NEAR(result.last.velocity[0], 1, 1e-12);

  const ModelDescription d = describe_model(*result.system);
  EXPECT_THAT(d.coordinates, testing::ElementsAre("theta", "x", "y"));
  EXPECT_THAT(d.coordinate_units, testing::ElementsAre("rad", "m", "m"));
  EXPECT_THAT(d.velocities, testing::ElementsAre("omega", "v1", "v2"));
  EXPECT_THAT(d.velocity_units, testing::ElementsAre("rad/s", "m/s", "m/s"));
  ASSERT_EQ(d.inputs.size(), 1u);
  EXPECT_EQ(d.inputs[0].unit, "N m");
  try {
    simulate_text("group = 3", "sleigh.toml").run();
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("sleigh.toml:1:9"));
  }
}

}  // namespace
}  // namespace hamel
