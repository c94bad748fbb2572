// Mistakes are reported before anything runs: one ConfigError with every mistake, each with the
// value given, the values expected and the nearest name.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <limits>

#include <hamel/groups/se2.hpp>
#include <hamel/groups/so3.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace {

using namespace hamel;
using testing::AllOf;
using testing::HasSubstr;
constexpr double nan_ = std::numeric_limits<double>::quiet_NaN();
constexpr double inf = std::numeric_limits<double>::infinity();

/// The message; run(), build() and mistakes() must agree, but that a run by hand keeps no rows.
std::string refused(const Simulation& simulation, bool by_hand_too = true) {
  const auto mistakes = simulation.mistakes();
  if (mistakes.empty()) return "accepted";
  if (by_hand_too) EXPECT_THROW((void)simulation.build(), ConfigError);
  else EXPECT_NO_THROW((void)simulation.build());
  try {
    (void)simulation.run();
  } catch (const ConfigError& error) {
    EXPECT_EQ(error.mistakes(), mistakes);
    return error.what();
  }
  return "ran";
}

TEST(BadInput, Numbers) {
  const auto with = [](auto&& change) {
    Simulation simulation = simulate("suslov");
    change(simulation);
    return refused(simulation);
  };
  EXPECT_THAT(with([](auto& x) { x.s(1.5); }),
              HasSubstr("s: got 1.5, expected a number in [0, 1]"));
  EXPECT_THAT(with([](auto& x) { x.s(-0.1); }), HasSubstr("s: got -0.1"));
  EXPECT_THAT(with([](auto& x) { x.s(nan_); }), HasSubstr("s: got nan"));
  EXPECT_THAT(with([](auto& x) { x.step(0); }), HasSubstr("step: got 0"));
  EXPECT_THAT(with([](auto& x) { x.step(nan_); }), HasSubstr("step: got nan"));
  EXPECT_THAT(with([](auto& x) { x.step(inf); }), HasSubstr("step: got inf"));
  EXPECT_THAT(with([](auto& x) { x.step(0.01).until(-3); }), HasSubstr("until: got -3"));
  EXPECT_THAT(with([](auto& x) { x.step(-0.01); }), HasSubstr("until: got 20"));
  EXPECT_THAT(with([](auto& x) { x.until(nan_); }), HasSubstr("until: got nan"));
  EXPECT_THAT(with([](auto& x) { x.until(inf); }), HasSubstr("until: got inf"));
  EXPECT_THAT(with([](auto& x) { x.every(0); }), HasSubstr("every: got 0"));
  EXPECT_THAT(with([](auto& x) { x.every(-4); }), HasSubstr("every: got -4"));
  EXPECT_THAT(with([](auto& x) { x.solver("newton", {.tolerance = 0}); }),
              HasSubstr("tolerance: got 0"));
  EXPECT_THAT(with([](auto& x) { x.solver("newton", {.tolerance = nan_}); }),
              HasSubstr("tolerance: got nan"));
}

TEST(BadInput, AMemoryBombIsRefused) {
  EXPECT_THAT(refused(simulate("suslov").until(1e12), false), HasSubstr("rows would be recorded"));
  EXPECT_THAT(refused(simulate("suslov").step(0.01).until(1e12), false), HasSubstr("every"));
  EXPECT_THAT(refused(simulate("suslov").step(1e-300).until(1)), HasSubstr("until"));
  EXPECT_THAT(refused(simulate("suslov").step(1e-12).until(20), false), HasSubstr("every"));
  // Recording rarely is fine.
  EXPECT_EQ(refused(simulate("suslov").until(100).every(1000)).substr(0, 3), "acc");
}

TEST(BadInput, Names) {
  EXPECT_THAT(refused(simulate("suslow")),
              AllOf(HasSubstr("unknown system 'suslow'"), HasSubstr("did you mean 'suslov'?")));
  EXPECT_THAT(refused(simulate("bycicle")), HasSubstr("did you mean 'bicycle'?"));
  EXPECT_THAT(refused(simulate("suslov").scheme("lfit")), HasSubstr("did you mean 'lift'?"));
  EXPECT_THAT(refused(simulate("suslov").retraction("cayly")), HasSubstr("did you mean 'cayley'?"));
  EXPECT_THAT(refused(simulate("suslov").solver("newtn")), HasSubstr("did you mean 'newton'?"));
  EXPECT_THAT(refused(simulate("suslov").compose("suzuki")), HasSubstr("did you mean 'suzuki4'?"));
  EXPECT_THAT(refused(simulate("suslov").set("inerta", {1, 2, 3})),
              HasSubstr("did you mean 'inertia'?"));
  // polar exists, but not on se2.
  EXPECT_THAT(refused(simulate("chaplygin_sleigh").retraction("polar")),
              HasSubstr("unknown retraction of se2 'polar'"));
  EXPECT_THAT(refused(simulate("")), HasSubstr("unknown system ''"));
}

TEST(BadInput, Parameters) {
  const auto suslov = [](std::vector<double> inertia) {
    return refused(simulate("suslov").set("inertia", std::move(inertia)));
  };
  EXPECT_THAT(suslov({1, 2}), HasSubstr("inertia: got 2 values, expected 3, 6 or 9"));
  EXPECT_THAT(suslov({}), HasSubstr("inertia"));
  EXPECT_THAT(suslov({1, nan_, 3}), HasSubstr("not finite"));
  EXPECT_THAT(suslov({1, -2, 3}), HasSubstr("not positive definite"));
  EXPECT_THAT(suslov({1, 0, 3}), HasSubstr("not positive definite"));
  EXPECT_THAT(suslov({1, 5, 0, 1, 0, 3}), HasSubstr("not positive definite"));
  EXPECT_THAT(suslov({1, .1, 0, 0, 2, 0, 0, 0, 3}), HasSubstr("not symmetric"));
  EXPECT_THAT(refused(simulate("suslov").set("normal", {0, 0, 0})), HasSubstr("normal"));
  EXPECT_THAT(refused(simulate("suslov").set("normal", {0, 1})),
              HasSubstr("got 2 values, expected 3"));
  EXPECT_THAT(refused(simulate("chaplygin_sleigh").set("mass", -1)),
              HasSubstr("not positive definite"));
  EXPECT_THAT(refused(simulate("chaplygin_sleigh").set("mass", nan_)), HasSubstr("not finite"));
  EXPECT_THAT(refused(simulate("rolling_disk").set("mass", {1, 2})),
              HasSubstr("got 2 values, expected 1"));
}

TEST(BadInput, Start) {
  const auto start = [](Start s) { return refused(simulate("suslov").start(std::move(s))); };
  EXPECT_THAT(start({.configuration = {}, .velocity = {1, 0, 0}, .momentum = {1, 0, 0}}),
              HasSubstr("not both"));
  EXPECT_THAT(start({.configuration = {}, .velocity = {1, 0}, .momentum = {}}),
              HasSubstr("velocity: got 2 values, expected 3 (omega1, omega2, omega3) for so3"));
  EXPECT_THAT(start({.configuration = {}, .velocity = {}, .momentum = {1, 0, 0, 0}}),
              HasSubstr("momentum: got 4 values, expected 3"));
  EXPECT_THAT(start({.configuration = {}, .velocity = {1, nan_, 0}, .momentum = {}}),
              HasSubstr("not finite"));
  EXPECT_THAT(start({.configuration = {1, 0, 0}, .velocity = {}, .momentum = {}}),
              HasSubstr("configuration"));
  EXPECT_THAT(start({.configuration = {2, 0, 0, 0, 1, 0, 0, 0, 1}, .velocity = {}, .momentum = {}}),
              HasSubstr("configuration"));
  EXPECT_THAT(
      start({.configuration = {1, 0, 0, 0, 1, 0, 0, 0, -1}, .velocity = {}, .momentum = {}}),
      HasSubstr("configuration"));
  EXPECT_THAT(
      start({.configuration = {1, 0, 0, 0, nan_, 0, 0, 0, 1}, .velocity = {}, .momentum = {}}),
      HasSubstr("configuration"));
}

/// A start off d is no mistake: it is projected, and a note has the part that was dropped.
TEST(BadInput, AnInadmissibleStartIsProjectedWithANote) {
  const Result r = simulate("suslov")
                       .start({.configuration = {}, .velocity = {1, 0, 0.25}, .momentum = {}})
                       .until(0.1)
                       .run();
  EXPECT_THAT(r.notes,
              testing::Contains(HasSubstr("velocity was projected onto d: dropped omega3 = 0.25")));
  EXPECT_NEAR(r.config.start.velocity[2], 0, 1e-16);
  // Round-off has none.
  EXPECT_THAT(simulate("n_trailer").set("trailers", 60).step(0.01).until(0.02).run().notes,
              testing::IsEmpty());
}

// ---- systems of a user --------------------------------------------------------------------------

template <int K>
struct Loose {
  using Group = SO3;
  Mat<3, 3> matrix = Mat<3, 3>::Identity();
  Eigen::Matrix<double, K, 3> rows = Eigen::Matrix<double, K, 3>::Zero();
  Mat<3, 3> inertia() const { return matrix; }
  Eigen::Matrix<double, K, 3> constraints() const { return rows; }
  Start start() const { return {.configuration = {}, .velocity = {1, 0, 0}, .momentum = {}}; }
};

TEST(BadInput, UserMatrices) {
  Loose<2> dependent;
  dependent.rows << 0, 0, 1, 0, 0, 2;
  EXPECT_THAT(refused(simulate(dependent)), HasSubstr("2 rows of rank 1"));
  Loose<1> zero;
  EXPECT_THAT(refused(simulate(zero)), HasSubstr("1 rows of rank 0"));
  Loose<3> all;
  all.rows.setIdentity();
  EXPECT_THAT(refused(simulate(all)), HasSubstr("leave no motion"));
  Loose<1> nan_rows;
  nan_rows.rows << 0, nan_, 1;
  EXPECT_THAT(refused(simulate(nan_rows)), HasSubstr("not finite"));
  Loose<1> indefinite;
  indefinite.rows << 0, 0, 1;
  indefinite.matrix(1, 1) = -1;
  EXPECT_THAT(refused(simulate(indefinite)), HasSubstr("not positive definite"));
  indefinite.matrix(1, 1) = nan_;
  EXPECT_THAT(refused(simulate(indefinite)), HasSubstr("not finite"));
  Loose<1> asymmetric;
  asymmetric.rows << 0, 0, 1;
  asymmetric.matrix(0, 1) = 0.1;
  EXPECT_THAT(refused(simulate(asymmetric)), HasSubstr("not symmetric"));
}
struct TooMany {
  using Group = SO3;
  Mat<3, 3> inertia() const { return Mat<3, 3>::Identity(); }
  Mat<4, 3> constraints() const {
    Mat<4, 3> out = Mat<4, 3>::Zero();
    out.topRows<3>().setIdentity();
    return out;
  }
  Start start() const { return {.configuration = {}, .velocity = {1, 0, 0}, .momentum = {}}; }
};
TEST(BadInput, MoreRowsThanDimensions) {
  EXPECT_THAT(refused(simulate(TooMany{})), HasSubstr("constraints"));
}
struct NoStart {
  using Group = SO3;
  Mat<3, 3> inertia() const { return Mat<3, 3>::Identity(); }
};
TEST(BadInput, NoDefaultStart) {
  EXPECT_THAT(refused(simulate(NoStart{})), HasSubstr("no default start"));
  EXPECT_EQ(refused(simulate(NoStart{})
                        .start({.configuration = {}, .velocity = {1, 0, 0}, .momentum = {}})
                        .until(0.1)),
            "accepted");
}

TEST(BadInput, AllAtOnce) {
  const std::string all =
      refused(simulate("suslov")
                  .scheme("lfit")
                  .retraction("cayly")
                  .compose("suzuki")
                  .solver("newtn")
                  .s(1.5)
                  .step(0)
                  .set("inertia", {1, -2, 3})
                  .start({.configuration = {1}, .velocity = {1}, .momentum = {1}}));
  for (const char* piece : {"'lift'", "'cayley'", "'suzuki4'", "'newton'", "s: got 1.5",
                            "step: got 0", "not positive definite", "not both", "configuration",
                            "velocity: got 1", "momentum: got 1"}) {
    EXPECT_THAT(all, HasSubstr(piece));
  }
}

// ---- files --------------------------------------------------------------------------------------

TEST(BadInput, RowsThatAreNotInMemory) {
  namespace fs = std::filesystem;
  const fs::path folder =
      fs::temp_directory_path() / ("hamel_rows_elsewhere_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const Result r = simulate("suslov").until(0.1).record_to((folder / "a.csv").string()).run();
  for (const char* name : {"b.csv", "b.csv.gz", "b.h5"}) {
    EXPECT_THROW(r.write((folder / name).string()), ConfigError) << name;
    EXPECT_FALSE(fs::exists(folder / name)) << name;
  }
  r.write((folder / "b.json").string());
  fs::remove_all(folder);
}

TEST(BadInput, FilesThatCannotBeWritten) {
  namespace fs = std::filesystem;
  const fs::path folder =
      fs::temp_directory_path() / ("hamel_bad_input_" + std::to_string(::getpid()));
  fs::create_directories(folder);
  const Result r = simulate("suslov").until(0.1).run();
  EXPECT_THROW(r.write((folder / "no_such_folder" / "a.csv").string()), ConfigError);
  EXPECT_THROW(r.write((folder / "a.txt").string()), ConfigError);
  EXPECT_THROW(r.write("/dev/full/a.csv"), ConfigError);
  fs::create_directory(folder / "is_a_folder.csv");
  EXPECT_THROW(r.write((folder / "is_a_folder.csv").string()), ConfigError);
  EXPECT_NE(unwritable((folder / "is_a_folder.csv").string()), "");
  EXPECT_NE(unwritable((folder / "no_such_folder" / "a.csv").string()), "");
  // The question makes no file, not even for a moment, which a kill would make last.
  fs::last_write_time(folder, fs::file_time_type());
  const auto untouched = fs::last_write_time(folder);
  EXPECT_EQ(unwritable((folder / "fine.csv").string()), "");
  EXPECT_EQ(fs::last_write_time(folder), untouched);
  r.write((folder / "fine.csv").string());
  // Nothing else was left behind.
  std::vector<std::string> left;
  for (const auto& entry : fs::directory_iterator(folder)) left.push_back(entry.path().filename());
  EXPECT_THAT(left, testing::UnorderedElementsAre("is_a_folder.csv", "fine.csv"));
  // A check leaves an existing file unchanged.
  std::ofstream(folder / "kept.csv") << "precious";
  EXPECT_EQ(unwritable((folder / "kept.csv").string()), "");
  EXPECT_EQ(fs::file_size(folder / "kept.csv"), 8u);
  fs::remove_all(folder);
}

}  // namespace
