// Mistakes in systems by data alone: place, name, value and what was expected.
#include <string>

#include "program.hpp"

namespace {

using namespace hamel::test;
using testing::HasSubstr;

using DataMistakes = CommandLine;

TEST_F(DataMistakes, MistakesAreNamed) {
  refused("inertia = [1]", "group: missing");
  refused("group = \"se4\"\ninertia = [1]", "did you mean 'se");
  refused("group = \"se2\"", "inertia: missing");
  refused("group = \"se2*\"\ninertia = [1, 2, 3]", "se2*");
  refused("group = \"se2\"\ninertia = [1, 2, 3]\nvelocity = [1, 0, 0]\nmomentum = [1, 0, 0]",
          ":4:12: momentum: expected velocity or momentum, not both");
  refused("group = \"se2\"\ninertia = [1, 2]", ":2:11: inertia: expected 3 numbers");
  refused("group = \"se2\"\ninertia = [1, 2, nan]\nvelocity = [1, 0, 0]", "finite");
  refused("group = \"se2\"\ninertia = [1, 2, -3]\nvelocity = [1, 0, 0]", "positive definite");
  refused("group = \"r2\"\ninertia = [[2, \"cos(x2 - x1)\"], [\"cos(x2)\", 1]]\nvelocity = [1, 0]",
          "inertia: symmetric at the start, but not beside it: entries (2, 1) and (1, 2)");
  refused("group = \"se2\"\ninertia = [1, 2, 3]\nconstraints = [[0, 0]]", "constraints");
  refused("group = \"se2\"\ninertia = [1, 2, 3]\nconstrains = [[0, 0, 1]]",
          "did you mean 'constraints'?");
  const std::string se2 = "group = 'se2'\ninertia = [1, 2, 3]\nvelocity = [1, 0, 0]\n";
  refused(se2 + "potential = 'x + z'",
          ":4:18: potential: unknown name 'z': expected one of theta, x, y");
  refused(se2 + "potential = 'omega*x'", ":4:14: potential: unknown name 'omega'");
  refused(se2 + "potential = 'x +'", ":4:17: potential: ");
  refused(se2 + "potential = true", ":4:13: potential: expected a number or a formula");
  refused(se2 + "force = [0, 'cosh(x', 0]", ":4:20: force: ");
  refused(se2 + "force = [0, 'omge']", ":4:9: force: expected 3 numbers or formulas");
  refused(se2 + "force = [0, 'omge', 0]", "did you mean 'omega'?");
  refused(se2 + "constraints = [[0, 0, 1], [1, 2]]",
          ":4:27: constraints: expected 3 numbers or formulas in each row");
  refused(se2 + "constraints = [[0, 'v1', 1]]", ":4:21: constraints: unknown name 'v1'");
  refused(se2 + "drift = [1]", ":4:9: drift: expected 0 numbers or formulas");
  refused(se2 + "coordinates = ['a', 'b']", ":4:15: coordinates: expected 3 names, got 2");
  refused(se2 + "coordinates = ['a', 'b', '3c']", "names allowed in a formula, got '3c'");
  refused(se2 + "coordinates = ['a', 'b', 'omega']", "two things are called 'omega'");
  refused(se2 + "[parameters]\nx = 1", "two things are called 'x'");
  refused(se2 + "[parameters]\n2x = 1", "a name allowed in a formula, got '2x'");
  refused(se2 + "[parameters]\nm = { valu = 1 }", "did you mean 'value'?");
  refused(se2 + "[parameters]\nm = { value = -1, least = 0 }",
          "parameter 'm' of " + file("system.toml") + ": got -1, expected at least 0");
  refused(se2 + "[inputs]\nu = 3", ":5:5: inputs.u: expected a table");
  refused(se2 + "[inputs]\nu = { value = 3 }", "unknown key 'value'");
  refused(se2 + "[events]\nturn = { meaning = 'x' }", ":5:8: events.turn: expected a formula");
  refused(se2 + "[events]\nturn = 'v3'", "did you mean 'v1'?");
  refused(se2 + "[invariants]\nenergy = 'u'", ":5:11: invariants.energy: unknown name 'u'");
  refused(se2 + "contacts = [1]", ":4:12: contacts: expected numbers of rows, 1 to 0, got 1");
  refused(se2 + "[[draw]]\nat = [0, 0]", "draw.at: expected 3 formulas");
  refused(se2 + "[[draw]]\nat = ['x', 'y', 0]\nshapes = [{ bux = [1, 1, 1] }]",
          "did you mean 'box'?");
  refused(se2 + "[spring]\nx = { stiffness = 2 }", "unknown key 'spring'");
  // At the start, which may be the command line's.
  refused(se2 + "potential = 'sqrt(x - 1)'", ":4:13: potential: 'sqrt(x - 1)' is ");
  refused(se2 + "potential = 'abs(x)^0.5'", "has no finite derivative at the start");
  refused(se2 + "force = ['1/theta', 0, 0]", ":4:10: force: '1/theta' is inf at the start");
  refused(se2 + "potential = '1/0'", ":4:13: potential: expected a finite number, got inf");
  EXPECT_EQ(run({"run", write(se2 + "force = ['1/theta', 0, 0]"), "--configuration", "1,0,0",
                 "--until", "1"})
                .status,
            0);
  refused(se2 + "potential = '" + std::string(2001, '(') + "'", "2001 characters, more than 2000");
  refused("name = 3\ngroup = \"se2\"\ninertia = [1, 2, 3]", ":1:8: name: got 3, expected a string");
  refused("group = 3\ninertia = [1, 2, 3]", ":1:9: group: got 3, expected a string");
  refused("summary = \"a skate\"\ngroup = \"se2\"\ninertia = [1, 2, 3]",
          ":1:11: unknown key 'summary'");
  refused("group = \"se2\"\ninertia = [1, 2, 3]\nevents = 1", ":3:10: events: expected a table");
  refused("group = [", ":1:");
  const Outcome o = run({"run", file("none.toml")});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr("cannot read"));
}

/// A formula without a value at the start is refused by describe, too.
TEST_F(DataMistakes, DescribesNoStartWithoutAValue) {
  const Outcome o =
      run({"describe", write("group = \"r2\"\ninertia = [1, 1]\npotential = \"ln(x1)\"\n"
                             "velocity = [1, 0]\n")});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr("system.toml:3:13: potential: 'ln(x1)' is -inf at the start"));
}

}  // namespace
