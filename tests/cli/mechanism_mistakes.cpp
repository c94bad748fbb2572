// What is wrong with the file of a mechanism: each mistake names the part, its file, line and
// column, before anything runs.
#include "mechanism_texts.hpp"

namespace {

using namespace hamel::test;
using testing::HasSubstr;

TEST_F(MechanismMistakes, InBodiesAndJoints) {
  refuses({
      {kFlat + "[[body]]\nname = \"b\"\n", "9:1: body 'b': mass: not given"},
      {"[[body]]\nname = \"a\"\nmass = \"1/0\"\n", "3:8: mass: expected a finite number, got inf"},
      {"gravity = \"x\"\n" + kFlat, "1:12: gravity: unknown name 'x': there are none"},
      {kFlat + "[[body]]\nname = \"a\"\nmass = 1\n", "9:1: body 'a': this name is taken"},
      {kFlat + "[[body]]\nname = \"a\"\nmass = 1\n[[joint]]\nname = \"c\"\nkind = \"hinge\"\n" +
           "parent = \"ab\"\nchild = \"a\"\n",
       "12:1: joint 'c': unknown parent 'ab': expected one of a; did you mean 'a'?"},
      {kFlat + "[[body]]\nname = \"b\"\nmass = 1\ninertia = [1, 1]\n" +
           "[[joint]]\nkind = \"hinge\"\nparent = \"a\"\nchild = \"b\"\n",
       "9:1: body 'b': inertia: got 2 numbers, expected 3, 6 or 9"},
      {kFlat + "[[body]]\nname = \"b\"\nmass = 1\n", "9:1: body 'b': hangs on no joint"},
      {"[[joint]]\nkind = \"planar\"\nchild = \"a\"\n", "1:1: joint 'a': unknown child 'a'"},
      {kFlat + "[[joint]]\nchild = \"a\"\n", "9:1: joint 'a': kind: missing, expected one of ball"},
      {kFlat + kArm + "[[joint]]\nname = \"c\"\nkind = \"hinge\"\nchild = \"b\"\n",
       "19:1: joint 'c': body 'b' hangs on joint 'arm' already: a joint that closes a chain is a "
       "loop"},
      {"[[body]]\nname = \"a\"\nmass = 1\ninertia = [1, 1, 1]\n" + kArm +
           "[[joint]]\nname = \"back\"\nkind = \"hinge\"\nparent = \"b\"\nchild = \"a\"\n",
       "10:1: joint 'arm': 'arm', 'back' go round in a circle that does not reach the ground; "},
      {kFlat + "[[body]]\nname = \"tip\"\nmass = 0\n[[joint]]\nname = \"end\"\nkind = \"hinge\"\n" +
           "parent = \"a\"\nchild = \"tip\"\nat = [1, 0, 0]\n",
       "12:1: joint 'end': body 'tip' and all that it carries have no inertia"},
      {kFlat + "[[body]]\nname = \"b\"\nmass = 1\nat = [1, 0, 0]\ninertia = [1, 1, 1]\n" +
           "[[joint]]\nname = \"u\"\nkind = \"universal\"\nparent = \"a\"\nchild = \"b\"\n" +
           "axis2 = [0, 0, 1]\n",
       "14:1: joint 'u': 'u1', 'u2' can move so that nothing that has inertia moves"},
  });
  const Outcome o = run({"run",
                         write("system.toml",
                               "[[body]]\nname = \"a\"\nmass = 1\ninertia = [1, 1, 3]\n"
                               "[[joint]]\nkind = \"planar\"\nchild = \"a\"\n"
                               "[start]\nv1 = 1\n"),
                         "--verbose"});
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_THAT(o.out + o.err, HasSubstr("system.toml:1:1: body 'a': no rigid body has the "
                                       "principal moments 1,1,3"));
}

TEST_F(MechanismMistakes, InContactsAndLoops) {
  const std::string wheel = kSpace + "[[wheel]]\nbody = \"a\"\nradius = 0.3\n";
  refuses({
      {kFlat + "[[wheel]]\nbody = \"b\"\nradius = 1\n",
       "9:1: wheel 'b': unknown body 'b': expected one of a"},
      {wheel + "at = [0, 0, 0.32]\n",
       "10:1: wheel 'a': does not touch the ground z = 0 as drawn: its lowest point is at 0.02 m"},
      {wheel + "at = [0, 0, 0.3]\naxle = [0, 0, 1]\n", "10:1: wheel 'a': axle: is vertical"},
      {kSpace + "[[wheel]]\nbody = \"a\"\nat = [0, 0, 0.3]\n",
       "10:1: wheel 'a': radius: got 0, expected a positive number"},
      {kFlat + "[[blade]]\nbody = \"a\"\nallong = [1, 0, 0]\n", "11:10: unknown key 'allong'"},
      {kFlat + "[[blade]]\nname = \"left\"\nbody = \"a\"\nat = [0, 1, 0]\n" +
           "[[blade]]\nname = \"right\"\nbody = \"a\"\nat = [0, -1, 0]\n",
       "13:1: redundant row: blade 'right' (does not slip across its edge) is implied by "
       "blade 'left' (does not slip across its edge); take a part with fewer rows"},
      {kFlat +
           "[[body]]\nname = \"post\"\nmass = 0\n[[joint]]\nkind = \"weld\"\nchild = \"post\"\n" +
           "[[wheel]]\nbody = \"post\"\nat = [0, 0, 0.3]\nradius = 0.3\n",
       "15:1: wheel 'post': body: expected a body that moves, not the ground or what is welded to "
       "it"},
      {"redundant = \"dropp\"\n" + kFlat, "1:13: unknown redundant 'dropp': expected one of"},
      {kCrank + "[[loop]]\nname = \"pin\"\na = \"rod\"\nb = \"crank\"\nat = [1, 0, 1]\n" +
           "[[loop]]\nname = \"end\"\na = \"rod\"\nb = \"rodd\"\n",
       "28:1: loop 'end': unknown body 'rodd': expected one of crank, rod, ground"},
      {kFlat + "[[force]]\nname = \"f\"\nbody = \"ground\"\nalong = [5, 0, 0]\n",
       "9:1: force 'f': body: expected a body that moves, not the ground or what is welded to it"},
      {kFlat + "[[spring]]\nname = \"s\"\na = \"ground\"\nb = \"ground\"\nto = [1, 0, 0]\n",
       "9:1: spring 's': expected a body that moves at one of its ends, not the ground or what is "
       "welded to it"},
      {kFlat + "[[body]]\nname = \"post\"\nmass = 0\n[[joint]]\nkind = \"weld\"\nparent = \"a\"\n" +
           "child = \"post\"\n[[spring]]\nname = \"s\"\na = \"a\"\nb = \"post\"\nstiffness = 1\n",
       "16:1: spring 's': 'a' and 'post' are one rigid body"},
      {kCrank + "[[loop]]\nname = \"pin\"\na = \"rod\"\nb = \"rod\"\nat = [1, 0, 1]\n",
       "23:1: loop 'pin': 'rod' and 'rod' are one body"},
      {kCrank + "[[loop]]\nname = \"pin\"\na = \"rod\"\nb = \"ground\"\nat = [1, 0, 1]\n",
       "23:1: loop 'pin' (the points of the joint coincide): the parts leave no motion, 2 "},
  });
}

TEST_F(MechanismMistakes, InTheStart) {
  const std::string pin =
      kCrank + "[[loop]]\nname = \"pin\"\na = \"rod\"\nb = \"ground\"\nat = [1, 0, 1]\n";
  refuses({
      {kFlat + "[start]\nspeeed = 1\n", "10:10: unknown number of the start"},
      {kFlat + "[start]\nv1 = nan\n", "10:6: v1: expected a finite number, got nan"},
      {kFlat + "[[blade]]\nbody = \"a\"\n[start]\nv1 = 1\nv2 = 1\n",
       "13:6: start: blade 'a' (does not slip across its edge) with v2 = 1 are inconsistent"},
      {pin + "[start]\nlow.angle = 1.5\nhigh.angle = 0.3\n",
       "29:13: start: loop 'pin' (the points of the joint coincide) with high.angle = 0.3, "
       "low.angle = 1.5 cannot be reached, 1.91 m is left"},
      {kSpace + "[start]\nR11 = 3\n", "11:7: start: R11 = 3: se3: R11..R33 has"},
      {"asks = [\"sped\"]\n" + kFlat, "1:8: start_arguments: unknown number of the start"},
      {kFlat + kArm + "[[prescribed]]\njoint = \"arm\"\nangle = \"0.5 + t\"\n[start]\n" +
           "arm.angle = 0.25\n",
       "23:13: start: arm.angle = 0.25, but it is prescribed as 0.5 at t = 0; leave it out"},
      {"start_arguments = [\"arm.angle\"]\n" + kFlat + kArm +
           "[[prescribed]]\njoint = \"arm\"\nangle = \"t\"\n",
       "1:19: start_arguments: arm.angle is prescribed"},
  });
}

TEST_F(MechanismMistakes, InFormulas) {
  const std::string motor = kFlat + kArm + "[[motor]]\njoint = \"arm\"\n",
                    moved = kFlat + kArm + "[[prescribed]]\njoint = \"arm\"\n",
                    pushed = kFlat + "[[force]]\nname = \"f\"\nbody = \"a\"\n";
  refuses({
      {kFlat + "[[motor]]\njoint = \"a\"\neffort = \"1\"\n",
       "9:1: motor 'a': unknown hinge or slider 'a': there are none"},
      {motor + "[[motor]]\njoint = \"arm\"\n",
       "21:1: motor 'arm': this joint is driven by an input already"},
      {motor + "effort = \"1/arm.angle\"\n", "19:1: motor 'arm': effort is inf at the start"},
      {pushed + "along = [\"2*omeg\", 0, 0]\n",
       "12:13: along: unknown name 'omeg': expected one of t, theta, x, y, omega, v1, v2; did you "
       "mean 'omega'?"},
      {pushed + "along = [0, \"1/x\", 0]\n", "9:1: force 'f': along is inf at the start"},
      {moved + "rate = \"ln(t)\"\n", "21:8: rate: expected a rate finite at t = 0, got -inf"},
      {moved + "angle = \"ln(t)\"\n", "21:9: angle: expected an angle finite at t = 0, got -inf"},
      {moved + "angle = \"sqrt(t)\"\n",
       "21:9: angle: expected an angle whose rate is finite at t = 0, got inf"},
      {moved + "angle = \"t < 1 ? 4 : 7\"\n",
       "21:9: angle: expected a formula without comparisons, a ? b : c, sign and rint, since its "
       "rate contains nothing of a jump; prescribe the rate instead"},
      {moved + "angle = \"0.3*sign(t - 1)\"\n", "21:9: angle: expected a formula without "},
      {moved + "rate = \"1\"\nangle = \"t\"\n", "19:1: prescribed: expected one of rate and angle"},
      {moved + "rate = \"1\"\n[[prescribed]]\njoint = \"arm\"\nrate = \"2\"\n",
       "22:1: prescribed 'arm': this joint is prescribed already"},
      {moved + "rate = \"wind\"\n[inputs]\nwind = {}\n",
       "21:8: rate: expected a formula of t and parameters, since its rate is needed too; 'wind' "
       "is none of them"},
      {kFlat + "[inputs]\nx = {}\n", "10:5: inputs.x: expected a name that nothing else has"},
      {kFlat + "wheels = 3\n", "9:10: unknown key 'wheels'"},
      {kFlat + "[parameters]\nt = 3\n",
       "10:5: parameters.t: expected a name that nothing else has"},
      {kFlat + "[parameters]\nx = 3\nm = 1\nv1 = { value = 2 }\n",
       "12:6: parameters.v1: expected a name that nothing else has"},
      {kFlat + "[parameters]\nwind = 3\n[inputs]\nwind = {}\n",
       "10:8: parameters.wind: expected a name that nothing else has"},
  });
}

/// What no part can be, or what would have no effect.
TEST_F(MechanismMistakes, InNamesAndNumbers) {
  const auto body = [](const std::string& shape) {
    return "[[body]]\nname = \"a\"\nmass = 1\n" + shape +
           "\n[[joint]]\nkind = \"planar\"\nchild = \"a\"\n";
  };
  const std::string arm = kFlat + kArm;
  refuses({
      {body("box = [1, -1, 1]"), "1:1: body 'a': box: got 1,-1,1, expected at least 0"},
      {body("cylinder = [-0.1, 1]"), "1:1: body 'a': cylinder: got -0.1,1, expected at least 0"},
      {"gravity = [0, -9.81, 0]\nslope = 0.1\n" + kFlat,
       "2:9: slope: expected gravity as a number beside it"},
      {kFlat + "[[body]]\nname = \"b\"\nmass = 1\nsphere = 1\n[[joint]]\nname = \"u\"\n" +
           "kind = \"universal\"\nparent = \"a\"\nchild = \"b\"\naxis2 = [1, 0, 0]\n" +
           "[[body]]\nname = \"c\"\nmass = 1\nsphere = 1\n[[joint]]\nname = \"u1\"\n" +
           "kind = \"hinge\"\nparent = \"b\"\nchild = \"c\"\n",
       "23:1: joint 'u1': 'u1' is the name of two hinges"},
      {body("sphere = -1"), "1:1: body 'a': sphere: got -1, expected at least 0"},
      {arm + "[[motor]]\njoint = \"arm\"\neffort = 1\nleast = -1\n",
       "22:9: least: expected none beside a formula"},
      {arm + "[[prescribed]]\njoint = \"arm\"\nangle = \"t\"\nmost = 1\n",
       "22:8: most: expected none beside a formula"},
      {arm + "[[motor]]\njoint = \"arm\"\nleast = 2\nmost = 1\n",
       "19:1: motor 'arm': least 2 is more than most 1"},
      {arm + "[inputs]\nu = { least = 2, most = 1 }\n",
       "20:5: inputs.u: expected least below most, got 2 and 1"},
      {kCrank + "[[loop]]\nname = \"pin\"\na = \"rod\"\nb = \"crank\"\nat = [0, 0, 1]\n" +
           "axis = [0, 1, 0]\n",
       "23:1: loop 'pin': constrains nothing: the joints between its bodies hold it already"},
      {"[[body]]\nname = \"a\"\nmass = 1\nat = [1, 0, 0]\ninertia = [1, 1, 1]\n[[joint]]\n"
       "kind = \"hinge\"\nchild = \"a\"\n[[blade]]\nname = \"keel\"\nbody = \"a\"\n",
       "9:1: redundant row: blade 'keel' (does not slip across its edge) constrains nothing: no "
       "joint "
       "moves its body that way; leave it out, or redundant = \"drop\""},
      {kFlat +
           "[[body]]\nname = \"b\"\nmass = 1\nat = [1, 0, 0]\ninertia = [1, 1, 1]\n[[joint]]\n" +
           "kind = \"universal\"\nparent = \"a\"\nchild = \"b\"\naxis2 = [1, 0, 0]\n" +
           "damping = 1\n",
       "14:1: joint 'b': stiffness and damping: expected a hinge or slider, got universal"},
      {kFlat + "[[body]]\nname = \"b\"\nmass = 1\n[[joint]]\nkind = \"weld\"\nparent = \"a\"\n" +
           "child = \"b\"\nstiffness = 1\n",
       "12:1: joint 'b': stiffness and damping: expected a hinge or slider, got weld"},
  });
  for (const std::string name : {"a,b", "a\\nb", "a\\\"b", "a\\u0007"})
    refuses({{"[[body]]\nname = \"" + name + "\"\nmass = 1\nsphere = 1\n[[joint]]\n" +
                  "kind = \"planar\"\nchild = \"" + name + "\"\n",
              "1:1: body '"}});
  std::string chain;
  for (int i = 0; i < 1001; ++i)
    chain += "[[body]]\nname = \"b" + std::to_string(i) + "\"\nmass = 1\nsphere = 1\n[[joint]]\n" +
             "kind = \"hinge\"\nchild = \"b" + std::to_string(i) + "\"\n";
  EXPECT_THAT(run({"describe", write(chain)}).err,
              HasSubstr("dimension 1001, expected at most 1000"));
}

/// Parts may have any name; what is not allowed in a formula is left out of them, with a mistake
/// that names it.
TEST_F(MechanismMistakes, InFormulasOfJointsWithAnyName) {
  for (const std::string name : {"left arm", "left-arm", "3rd", "дрель", "sin"}) {
    const std::string arm = "[[body]]\nname = \"" + name +
                            "\"\nmass = 1\nat = [1, 0, 0]\ninertia = [1, 1, 1]\n[[joint]]\n"
                            "kind = \"hinge\"\nchild = \"" +
                            name + "\"\n[[motor]]\njoint = \"" + name + "\"\neffort = ";
    const Outcome o = run({"run", write(arm + "\"0.3*sin(t)\"\n"), "--until", "0.1"});
    EXPECT_EQ(o.status, 0) << name << o.err;
    if (name == "sin") continue;
    refuses(
        {{arm + "\"2*" + name + ".angle\"\n",
          "11:13: effort: '" + name + ".angle' is not allowed in a formula: expected a letter, "}});
  }
  refuses(
      {{kFlat + "[[body]]\nname = \"b\"\nmass = 1\nat = [1, 0, 0]\ninertia = [1, 1, 1]\n" +
            "[[joint]]\nname = \"left arm\"\nkind = \"hinge\"\nparent = \"a\"\nchild = \"b\"\n" +
            "[[motor]]\njoint = \"left arm\"\neffort = \"-left_arm.angle\"\n",
        "21:12: effort: unknown name 'left_arm.angle': "},
       {kFlat + "[[body]]\nname = \"b\"\nmass = 1\nat = [1, 0, 0]\ninertia = [1, 1, 1]\n" +
            "[[joint]]\nname = \"left arm\"\nkind = \"hinge\"\nparent = \"a\"\nchild = \"b\"\n" +
            "[[prescribed]]\njoint = \"left arm\"\nrate = \"steer l\"\n",
        "21:9: rate: "}});
}

/// Bodies that are all welded to the ground: every command that takes a system has one message.
TEST_F(MechanismMistakes, NothingMoves) {
  const std::string welded =
      write("welded.toml",
            "[[body]]\nname = \"a\"\nmass = 1\n[[joint]]\nkind = \"weld\"\nchild = \"a\"\n");
  const std::string link =
      "<inertial><mass value=\"1\"/><inertia ixx=\"1\" ixy=\"0\" ixz=\"0\" iyy=\"1\" iyz=\"0\" "
      "izz=\"1\"/></inertial>";
  const std::string robot =
      write("robot.urdf", "<robot name=\"r\"><link name=\"a\">" + link + "</link></robot>");
  const std::string world = write("world.urdf", "<robot name=\"r\"><link name=\"world\"/></robot>");
  for (const std::string& system : {welded, robot + "?root=fixed", world}) {
    write("study.toml", "system = [{ name = \"" + system + "\" }]\nstep = [0.1]\nuntil = 1\n");
    write("ensemble.toml",
          "system = \"" + system + "\"\nmembers = 2\nuntil = 1\nkeep = " + "[\"end.energy\"]\n");
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {"run", system},
             {"describe", system},
             {"describe", "--toml", system},
             {"describe", "--analyse", system},
             {"steady", system},
             {"section", system, "--event", "x=0", "--count", "2"},
             {"study", file("study.toml"), "-o", file("study")},
             {"ensemble", file("ensemble.toml"), "-o", file("ensemble")}}) {
      const Outcome o = run(words);
      EXPECT_EQ(o.status, 2) << words[0] << " " << system << o.out;
      EXPECT_THAT(o.err, HasSubstr("nothing moves")) << words[0] << " " << system;
    }
  }
}

}  // namespace
