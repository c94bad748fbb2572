// What a command loads, and the modules that are opened when they are named
// (framework/io/module.hpp).
#include "program.hpp"

namespace {

using namespace hamel::test;
using testing::AllOf;
using testing::AnyOf;
using testing::HasSubstr;
using testing::Not;

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

const fs::path kBuilt = fs::path(HAMEL_BUILD) / HAMEL_MODULE_FOLDER;

// A module of this build: the words that name it, and the message where it is missing.
struct Part {
  std::string module;
  Words words;
  std::string missing;
};

std::vector<Part> parts() {
  std::vector<Part> out;
  const Words run = {"run", "suslov", "--until", "1", "--quiet"};
  const std::vector<Part> all = {
      {"ceres", {"--solver", "ceres"}, "solver 'ceres' needs the package libceres-dev"},
      {"nlopt", {"--solver", "nlopt:lbfgs"}, "solver 'nlopt:lbfgs' needs the package libnlopt-dev"},
      {"hdf5", {"-o", "a.h5"}, "'a.h5': this build has no HDF5 (libhdf5-dev)"}};
  for (Part part : all) {
    if (!fs::exists(kBuilt / ("hamel_" + part.module + ".so"))) continue;
    part.words.insert(part.words.begin(), run.begin(), run.end());
    out.push_back(part);
  }
  return out;
}

class StartUp : public CommandLine {
 protected:
  /// A copy of the program as it is installed, in the folder of that name.
  std::string installed(const std::string& name, bool with_modules) const {
    const fs::path tree = file(name), program = std::getenv("HAMEL_PROGRAM");
    fs::create_directories(tree / "bin");
    fs::copy_file(program, tree / "bin/hamel");
    if (!with_modules) return tree / "bin/hamel";
    fs::create_directories((tree / HAMEL_MODULE_FOLDER).parent_path());
    fs::copy(kBuilt, tree / HAMEL_MODULE_FOLDER);
    return tree / "bin/hamel";
  }
  /// Runs this program instead.
  Outcome run_other(const std::string& program, const Words& words) const {
    return run(words, "sh -c 'shift; exec \"$0\" \"$@\"' '" + program + "' ");
  }
  /// The libraries that are loaded in all, by the loader's own account.
  std::string loaded(const Words& words) const { return run(words, "LD_DEBUG=files exec ").err; }
};

TEST_F(StartUp, LoadsFewLibraries) {
  const Outcome o = run({"--version"}, "LD_TRACE_LOADED_OBJECTS=1 exec ");
  EXPECT_LE(lines(o.out).size(), 16u) << o.out;
  const auto heavy = AnyOf(HasSubstr("blas"), HasSubstr("libceres"), HasSubstr("libhdf5"),
                           HasSubstr("libnlopt"), HasSubstr("libcurl"));
  EXPECT_THAT(o.out, Not(heavy));
  EXPECT_THAT(loaded({"list", "solvers"}), AllOf(HasSubstr("libstdc++"), Not(heavy)));
  EXPECT_THAT(loaded({"run", "suslov", "--until", "1", "-o", "a.csv"}), Not(heavy));
}

TEST_F(StartUp, WhatIsNamedIsOpenedAlone) {
  for (const Part& part : parts()) {
    const std::string all = loaded(part.words);
    for (const Part& other : parts()) {
      const auto its = HasSubstr("/hamel_" + other.module + ".so");
      if (other.module == part.module) EXPECT_THAT(all, its);
      else EXPECT_THAT(all, Not(its));
    }
  }
}

/// OpenBLAS, which Ceres brings, starts a thread for each core; where these had no memory for their
/// stacks, programs did not end.
TEST_F(StartUp, EndsWithLittleMemory) {
  for (const std::string& limit : Words{"ulimit -v 150000", "ulimit -d 50000"}) {
    for (const Words& words : std::vector<Words>{
             {"--version"},
             {"list", "systems"},
             {"run", "suslov", "--until", "1", "--quiet", "-o", "a.csv", "-o", "a.json"}}) {
      const Outcome o = run(words, limit + " && exec timeout 60 ");
      EXPECT_EQ(o.status, 0) << limit << " " << words.front() << " " << o.err;
    }
  }
}

TEST_F(StartUp, AModuleThatIsMissing) {
  const std::string program = installed("alone", false);
  for (const Part& part : parts()) {
    const Outcome o = run_other(program, part.words);
    EXPECT_EQ(o.status, 2);
    EXPECT_THAT(o.err, HasSubstr(part.missing));
  }
  EXPECT_EQ(run_other(program, {"run", "suslov", "--until", "1", "--quiet", "-o", "a.csv"}).status,
            0);
  EXPECT_EQ(run_other(program, {"list", "solvers"}).status, 0);
}

TEST_F(StartUp, AModuleThatIsDamaged) {
  const std::string program = installed("tree", true);
  const fs::path modules = fs::path(file("tree")) / HAMEL_MODULE_FOLDER;
  for (const Part& part : parts())
    std::ofstream(modules / ("hamel_" + part.module + ".so")) << "nonsense";
  for (const Part& part : parts()) {
    const Outcome o = run_other(program, part.words);
    EXPECT_EQ(o.status, 2);
    EXPECT_THAT(o.err, HasSubstr("hamel_" + part.module + ".so: "));
    EXPECT_THAT(o.err, Not(HasSubstr(part.missing)));
  }
}

/// A tree that is moved has its modules, by whatever path its program is called.
TEST_F(StartUp, ATreeThatWasMoved) {
  installed("installed", true);
  fs::rename(file("installed"), file("moved here"));
  const std::string program = file("moved here/bin/hamel");
  fs::create_symlink(program, file("link"));
  for (const std::string& path : Words{program, file("link"), "moved here/bin/hamel"}) {
    for (const Part& part : parts()) {
      Outcome o = run_other(path, part.words);
      EXPECT_EQ(o.status, 0) << path << o.err;
      fs::remove(file("a.h5"));
    }
  }
  EXPECT_THAT(run(parts().front().words,
                  "LD_DEBUG=files exec sh -c 'shift; exec \"$0\" \"$@\"' '" + program + "' ")
                  .err,
              HasSubstr(file("moved here/") + HAMEL_MODULE_FOLDER));
  EXPECT_EQ(run_other(program, {"list", "solvers"}).out, run({"list", "solvers"}).out);
}

}  // namespace
