// Robots in URDF by their options: --wheel, --motor, --weld, and what a description leaves over.
#include <cmath>

#include "program.hpp"

namespace {

using namespace hamel::test;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;
using Words = std::vector<std::string>;

class UrdfOptions : public CommandLine {
 protected:
  static std::string inertial(double mass, const std::string& ixx = "0.01") {
    return "<inertial><mass value=\"" + std::to_string(mass) + "\"/><inertia ixx=\"" + ixx +
           "\" ixy=\"0\" ixz=\"0\" iyy=\"0.02\" iyz=\"0\" izz=\"0.015\"/></inertial>";
  }
  static std::string link(const std::string& name, const std::string& inside = inertial(1)) {
    return "<link name=\"" + name + "\">" + inside + "</link>";
  }
  static std::string joint(const std::string& kind, const std::string& name,
                           const std::string& parent, const std::string& child,
                           const std::string& at, const std::string& axis = "0 1 0",
                           const std::string& inside = "") {
    return "<joint name=\"" + name + "\" type=\"" + kind + "\"><origin xyz=\"" + at +
           "\"/><parent link=\"" + parent + "\"/><child link=\"" + child + "\"/><axis xyz=\"" +
           axis + "\"/>" + inside + "</joint>";
  }
  /// A wheel of radius 0.1 m on a hinge of the base.
  static std::string wheel(const std::string& name, const std::string& at,
                           const std::string& inside = "", const std::string& geometry = kCylinder,
                           const std::string& parent = "base") {
    return link(name, inertial(0.5) + "<collision><origin rpy=\"1.5707963267948966 0 0\"/>" +
                          "<geometry>" + geometry + "</geometry></collision>") +
           joint("continuous", name + "_axle", parent, name, at, "0 1 0", inside);
  }
  static std::string two_wheels(const std::string& geometry = kCylinder,
                                const std::string& inside = "") {
    return link("base", inertial(5)) + wheel("left", "0 0.2 0.1", inside, geometry) +
           wheel("right", "0 -0.2 0.1", inside, geometry);
  }
  std::string robot(const std::string& inside, const std::string& name = "robot.urdf") const {
    return write(name, "<robot name=\"r\">\n" + inside + "</robot>");
  }
  std::string toml(const Words& system) const {
    Words all = {"describe", "--toml"};
    all.insert(all.end(), system.begin(), system.end());
    const Outcome o = run(all);
    EXPECT_EQ(o.status, 0) << o.err;
    return o.out;
  }
  std::string mistake(const Words& system) const {
    Words all = {"run", "--until", "0.1", "--quiet"};
    all.insert(all.end(), system.begin(), system.end());
    const Outcome o = run(all);
    EXPECT_EQ(o.status, 2) << o.out;
    EXPECT_THAT(o.err, Not(HasSubstr("as TOML")));
    return o.err;
  }
  /// The columns of the last row, by name.
  std::map<std::string, double> end_of(const Words& system, const Words& more = {}) const {
    Words all = {"run", "--step", "0.01", "--until", "1", "--quiet", "-o", file("end.csv")};
    all.insert(all.end(), system.begin(), system.end());
    all.insert(all.end(), more.begin(), more.end());
    const Outcome o = run(all);
    EXPECT_EQ(o.status, 0) << o.err;
    std::map<std::string, double> out;
    const auto rows = lines(contents(file("end.csv")));
    const auto names = split(rows.at(0));
    std::string last;
    for (const std::string& row : rows)
      if (row[0] != '#') last = row;
    const auto values = split(last);
    for (size_t i = 0; i < names.size(); ++i) out[names[i]] = std::stod(values.at(i));
    return out;
  }
  /// Two systems end at the same state, of the columns that both have.
  void same_end(const Words& a, const Words& b, const Words& more = {}) const {
    const auto x = end_of(a, more), y = end_of(b, more);
    int compared = 0;
    for (const auto& [name, value] : x) {
      if (!y.contains(name) || name == "iterations" || name == "residual") continue;
      EXPECT_NEAR(value, y.at(name), 1e-10) << name;
      ++compared;
    }
    EXPECT_GT(compared, 8);
  }
  std::vector<std::string> motors(const Words& system) const {
    Words all = {"describe"};
    all.insert(all.end(), system.begin(), system.end());
    std::vector<std::string> out;
    for (const json& input : answer(all)["inputs"]) {
      const auto name = input["name"].get<std::string>();
      out.push_back(name.substr(0, name.rfind('.')));
    }
    return out;
  }

  static const std::string kCylinder, kMesh, kSphere;
};
const std::string UrdfOptions::kCylinder = R"(<cylinder radius="0.1" length="0.02"/>)";
const std::string UrdfOptions::kMesh = R"(<mesh filename="package://a/wheel.stl"/>)";
const std::string UrdfOptions::kSphere = R"(<sphere radius="0.1"/>)";

// ---- joints -----------------------------------------------------------------------------------

TEST_F(UrdfOptions, FixedJointsHaveNeitherDampingNorLimits) {
  const std::string more = R"(<dynamics damping="0.7" friction="0.1"/><limit effort="1"
                              velocity="1" lower="0" upper="0"/>)";
  const auto with = [&](const std::string& inside, const std::string& name) {
    return robot(two_wheels() + link("eye", inertial(0.1)) +
                     joint("fixed", "mount", "base", "eye", "0.1 0 0.2", "0 1 0", inside),
                 name) +
           "?wheel=left,right";
  };
  same_end({with(more, "a.urdf")}, {with("", "b.urdf")}, {"--input", "left_axle.torque=0.1"});
  EXPECT_THAT(toml({with(more, "a.urdf")}),
              HasSubstr("limits of fixed joints mean nothing and are left out: \"mount\""));
  EXPECT_THAT(toml({with("", "b.urdf")}), Not(HasSubstr("fixed joints")));
}

/// Only the whole that is welded together must be a rigid body: -0.004 and 0.01 are as 0.006.
TEST_F(UrdfOptions, MomentsOfTheWeldedWhole) {
  const auto arm = [&](const std::string& part, const std::string& main, const std::string& name) {
    return robot(link("base") + link("arm", inertial(1, main)) +
                     joint("continuous", "hinge", "base", "arm", "0 0 0.5", "1 0 0") +
                     link("antenna", "<inertial><mass value=\"0\"/><inertia ixx=\"" + part +
                                         "\" ixy=\"0\" ixz=\"0\" iyy=\"0\" iyz=\"0\" izz=\"0\"/>"
                                         "</inertial>") +
                     joint("fixed", "mount", "arm", "antenna", "0 0 0"),
                 name) +
           "?root=fixed";
  };
  const Words push = {"--input", "hinge.torque=0.001"};
  same_end({arm("-0.004", "0.01", "a.urdf")}, {arm("0", "0.006", "b.urdf")}, push);
  EXPECT_GT(end_of({arm("-0.004", "0.01", "a.urdf")}, push).at("hinge.angle"), 0.05);
  EXPECT_THAT(answer({"run", arm("-0.004", "0.01", "a.urdf"), "--until", "0.1"})["notes"].dump(),
              HasSubstr("a.urdf: body 'antenna': a moment of -0.004 about some axis; with all that "
                        "it is welded to none is below 0"));
  EXPECT_THAT(mistake({arm("-0.02", "0.01", "a.urdf")}),
              HasSubstr("a.urdf: body 'antenna': inertia: a moment of -0.01 about some axis, that "
                        "of all that it is welded to included, expected none below 0"));
}

TEST_F(UrdfOptions, WeldedJointsAreRigid) {
  const auto base = [&](const std::string& kind, const std::string& name) {
    return robot(two_wheels() + link("arm", inertial(0.4)) +
                     joint(kind, "shoulder", "base", "arm", "0.2 0 0.3", "0 0 1",
                           kind == "fixed" ? "" : "<dynamics damping=\"0.1\"/>") +
                     link("tip", "") + joint(kind, "wrist", "arm", "tip", "0.3 0 0"),
                 name);
  };
  const Words wheels = {"--wheel", "left", "--wheel", "right"};
  const auto of = [&](const Words& more) {
    Words out = {base("continuous", "a.urdf")};
    out.insert(out.end(), wheels.begin(), wheels.end());
    out.insert(out.end(), more.begin(), more.end());
    return out;
  };
  const std::string fixed = base("fixed", "b.urdf") + "?wheel=left,right";
  const Words push = {"--input", "left_axle.torque=0.1", "--speed", "0.2"};
  same_end(of({"--weld", "shoulder,wrist"}), {fixed}, push);
  same_end(of({"--weld-all-but", "left_axle", "--weld-all-but", "right_axle"}), {fixed}, push);
  same_end({base("continuous", "a.urdf") + "?wheel=left,right&weld-all-but=left_axle,right_axle"},
           {fixed}, push);
  EXPECT_THAT(mistake(of({"--weld", "sholder"})),
              HasSubstr("--weld: unknown joint 'sholder': expected one of left_axle, right_axle, "
                        "shoulder, wrist; did you mean 'shoulder'?"));
  EXPECT_THAT(mistake(of({"--weld-all-but", "elbow"})), HasSubstr("unknown joint 'elbow'"));
  EXPECT_THAT(mistake(of({"--weld", "wrist", "--weld-all-but", "left_axle"})),
              HasSubstr("--weld and --weld-all-but are inconsistent"));
  // A link without mass on a joint that moves, and the option by which it is welded.
  EXPECT_THAT(mistake(of({})),
              HasSubstr("link 'tip': it and all that it carries have no mass: give it an "
                        "<inertial> with mass and inertia, or make the joint rigid: --weld wrist"));
  EXPECT_THAT(mistake(of({"--weld-all-but", "left_axle"})),
              HasSubstr("wheel 'right': cannot roll: its joint 'right_axle' is welded: leave it "
                        "out of --weld, or add it to --weld-all-but"));
}

/// Without couplings a joint that mimics is refused, unless it, or the one that it follows, is
/// welded.
TEST_F(UrdfOptions, MimickingJointsMayBeWelded) {
  const std::string path = robot(two_wheels() + link("f1") +
                                 joint("prismatic", "finger1", "base", "f1", "0.2 0 0", "0 1 0",
                                       R"(<limit lower="0" upper="1" effort="5" velocity="1"/>)") +
                                 link("f2") +
                                 joint("prismatic", "finger2", "base", "f2", "0.2 0 0", "0 -1 0",
                                       R"(<limit lower="0" upper="1" effort="5" velocity="1"/><mimic
                     joint="finger1"/>)"));
  EXPECT_THAT(mistake({path, "--wheel", "left"}), HasSubstr("make it rigid, --weld finger2"));
  EXPECT_EQ(answer({"describe", path, "--weld", "finger2"})["group"], "se2*so2^2*r1");
  EXPECT_EQ(answer({"describe", path, "--weld", "finger1"})["group"], "se2*so2^2");
  EXPECT_THAT(toml({path, "--weld", "finger1"}),
              HasSubstr("welded too, as they mimic a joint that is: \"finger2\""));
}

// ---- wheels -----------------------------------------------------------------------------------

/// Meshes have no radius; given one, they roll as cylinders do, by either spelling.
TEST_F(UrdfOptions, WheelsOfGivenRadius) {
  const std::string mesh = robot(two_wheels(kMesh), "mesh.urdf"),
                    round = robot(two_wheels(), "round.urdf");
  const Words push = {"--input", "left_axle.torque=0.1", "--speed", "0.2"};
  const Words other = {round, "--wheel", "left", "--wheel", "right"};
  same_end({mesh, "--wheel", "left:radius=0.1", "--wheel", "right:wheel:radius=0.1"}, other, push);
  same_end({mesh, "--wheel", "left,radius=0.1", "--wheel", "right:wheel,radius=0.1"}, other, push);
  same_end({mesh + "?wheel=left,radius=0.1,right:radius=0.1"}, other, push);
  EXPECT_THAT(mistake({mesh, "--wheel", "left"}),
              HasSubstr("wheel 'left': its geometry is a mesh: give its radius in m, --wheel "
                        "left:radius=0.1 (the height of its origin above that of the root link)"));
  // Half the radius: the wheel turns twice as fast.
  const auto half =
      end_of({robot(link("base", inertial(5)) + wheel("left", "0 0.2 0.05"), "h.urdf") +
              "?wheel=left:radius=0.05"},
             {"--speed", "0.2"});
  EXPECT_NEAR(half.at("left_axle.rate"), 4, 1e-9);
  for (const auto& [given, message] : std::map<std::string, std::string>{
           {"left:radius=-1", "radius: got '-1', expected a positive number, in m"},
           {"left:radius=1m", "radius: got '1m', expected a positive number, in m"},
           {"left:raduis=1",
            "unknown value 'raduis': expected one of radius, angle; did you mean "
            "'radius'?"},
           {"left:omny",
            "unknown kind of wheel 'omny': expected one of wheel, ball, omni, mecanum"},
           {"left:angle=1", "angle: of the rollers of an omni or mecanum wheel"},
           {"lft:radius=1", "unknown link 'lft'"}})
    EXPECT_THAT(mistake({round, "--wheel", given}), HasSubstr(message)) << given;
}

/// Wheels whose rows are those of a mecanum base: r w = vx -+ vy -+ (lx + ly) omega; the rates that
/// follow from a motion of the base, by either direction of the hinges.
TEST_F(UrdfOptions, MecanumAndOmniWheels) {
  const double vx = 0.3, vy = 0.2, turn = 0.5, r = 0.1, lx = 0.25, ly = 0.2;
  std::string text = link("base", inertial(20));
  std::string option;
  for (const auto& [name, at] : std::map<std::string, std::string>{{"fl", "0.25 0.2 0.1"},
                                                                   {"fr", "0.25 -0.2 0.1"},
                                                                   {"rl", "-0.25 0.2 0.1"},
                                                                   {"rr", "-0.25 -0.2 0.1"}}) {
    text += wheel(name, at);
    option += (option.empty() ? "?wheel=" : ",") + name + ":mecanum";
  }
  const std::string moving = "\n[start]\nv1 = 0.3\nv2 = 0.2\nomega = 0.5\n";
  const auto rates = [&](const std::string& system) {
    const std::string written = write("start.toml", toml({system}) + moving);
    const json record = answer({"run", written, "--until", "0"});
    std::map<std::string, double> out;
    const json d = answer({"describe", written});
    for (size_t i = 0; i < d["velocity"].size(); ++i)
      out[d["velocity"][i]["name"]] = record["start"]["velocity"][i];
    return out;
  };
  const auto mecanum = rates(robot(text) + option);
  EXPECT_NEAR(r * mecanum.at("fl_axle.rate"), vx - vy - (lx + ly) * turn, 1e-12);
  EXPECT_NEAR(r * mecanum.at("fr_axle.rate"), vx + vy + (lx + ly) * turn, 1e-12);
  EXPECT_NEAR(r * mecanum.at("rl_axle.rate"), vx + vy - (lx + ly) * turn, 1e-12);
  EXPECT_NEAR(r * mecanum.at("rr_axle.rate"), vx - vy + (lx + ly) * turn, 1e-12);
  EXPECT_THAT(toml({robot(text) + option}),
              HasSubstr("rollers at a negative angle, the others at a positive one (--wheel "
                        "LINK:mecanum:angle=a sets it): \"fl\", \"rr\""));
  const auto turned = rates(robot(text) + "?wheel=fl:mecanum:angle=0.7853981633974483");
  EXPECT_NEAR(r * turned.at("fl_axle.rate"), vx + vy + (lx - ly) * turn, 1e-12);
  const auto omni = rates(robot(text) + "?wheel=fl:omni,rr:omni");
  EXPECT_NEAR(r * omni.at("fl_axle.rate"), vx - ly * turn, 1e-12);
  EXPECT_NEAR(r * omni.at("rr_axle.rate"), vx + ly * turn, 1e-12);
  EXPECT_THAT(mistake({robot(two_wheels()), "--wheel", "left:mecanum", "--wheel", "right:mecanum"}),
              HasSubstr("wheel 'left': the angle of its rollers follows from the corner"));
}

TEST_F(UrdfOptions, WheelsThatCannotRoll) {
  const auto across = [&](const std::string& geometry) {
    return robot(link("base", inertial(5)) +
                 link("w", inertial(1) + "<collision><origin rpy=\"1.5707963267948966 0 0\"/>" +
                               "<geometry>" + geometry + "</geometry></collision>") +
                 joint("continuous", "axle", "base", "w", "0 0.2 0.1", "1 0 0"));
  };
  EXPECT_THAT(mistake({across(kCylinder), "--wheel", "w"}),
              HasSubstr("wheel 'w': cannot roll: no joint turns about its axle, which is along (0, "
                        "-1, 0); joint 'axle' turns about (1, 0, 0)"));
  // Beside its hinge, as a door.
  EXPECT_THAT(mistake({robot(link("base", inertial(5)) +
                             link("w", inertial(1) +
                                           "<collision><origin xyz=\"0.3 0 0\" "
                                           "rpy=\"1.5707963267948966 0 0\"/><geometry>" +
                                           kCylinder + "</geometry></collision>") +
                             joint("continuous", "axle", "base", "w", "0 0.2 0.1")),
                       "--wheel", "w"}),
              HasSubstr("no joint turns about its axle"));
  EXPECT_THAT(mistake({robot(link("base", inertial(5)) + link("w") +
                             joint("continuous", "axle", "base", "w", "0 0.2 0.1", "0 0 1")),
                       "--wheel", "w:radius=0.1"}),
              HasSubstr("no joint turns about its axle: no hinge about a level axis carries it"));
}

/// Heights that differ by a little more than round-off are of the drawing, others are mistakes.
TEST_F(UrdfOptions, WheelsAtOtherHeights) {
  const auto at = [&](const std::string& height) {
    return robot(link("base", inertial(5)) + wheel("left", "0 0.2 0.1") +
                 wheel("right", "0 -0.2 " + height)) +
           "?wheel=left,right";
  };
  EXPECT_THAT(toml({at("0.105")}), HasSubstr("wheel 'right': its lowest point is 0.005 m above the "
                                             "lowest point of 'left': radius 0.105 m instead of "
                                             "0.1 m"));
  EXPECT_EQ(run({"run", at("0.105"), "--until", "0.1", "--quiet"}).status, 0);
  EXPECT_THAT(
      mistake({at("0.13")}),
      HasSubstr("wheel 'right': does not touch the ground: its lowest point is 0.03 m above "
                "the lowest point of 'left'; leave it out, or give its radius, --wheel "
                "right:radius=0.13"));
}

/// A robot whose root is its ball, or its only wheel: it rolls with a free root.
TEST_F(UrdfOptions, ARootThatRolls) {
  const std::string ball = robot(
      link("ball", inertial(2) + "<collision><geometry>" + kSphere + "</geometry></collision>") +
      link("bob") + joint("continuous", "hinge", "ball", "bob", "0 0 0.05"));
  EXPECT_THAT(mistake({ball, "--wheel", "ball"}),
              HasSubstr("let it roll with the whole robot, --root free"));
  const json d = answer({"describe", ball, "--wheel", "ball", "--root", "free"});
  EXPECT_EQ(d["group"], "se3*so2");
  EXPECT_EQ(d["directions"], 4);  // three of the ball and the hinge
  const std::string disk = robot(
      link("disk", inertial(2) + "<collision><origin rpy=\"1.5707963267948966 0 0\"/><geometry>" +
                       kCylinder + "</geometry></collision>"));
  const json rolling = answer({"describe", disk, "--wheel", "disk", "--root", "free"});
  EXPECT_EQ(rolling["directions"], 3);
}

TEST_F(UrdfOptions, NamesWhatLooksLikeWheels) {
  const std::string path = robot(
      two_wheels() +
      link("ball", inertial(0.1) + "<collision><geometry><sphere radius=\"0.02\"/></geometry>"
                                   "</collision>") +
      joint("fixed", "support", "base", "ball", "0.2 0 0.02") +
      link("head", inertial(0.1) + "<collision><origin rpy=\"1.5707963267948966 0 0\"/><geometry>" +
                       kCylinder + "</geometry></collision>") +
      joint("continuous", "neck", "base", "head", "0 0 0.6"));
  EXPECT_THAT(toml({path}), HasSubstr("no --wheel is given: nothing rolls on the ground, and the "
                                      "root slides on it freely: \"base\"; these look like wheels, "
                                      "--wheel auto takes them: \"left\", \"right\"\n"));
  EXPECT_THAT(toml({path, "--root", "free"}), HasSubstr("nothing touches the ground"));
  const std::string automatic = toml({path, "--wheel", "auto"});
  EXPECT_THAT(automatic, HasSubstr("# --wheel auto takes \"left\", \"right\"\n"));
  same_end({path, "--wheel", "auto"}, {path + "?wheel=left,right"},
           {"--input", "left_axle.torque=0.1"});
  EXPECT_THAT(toml({robot(two_wheels(kMesh))}),
              HasSubstr("these may be wheels: --wheel left:radius=0.1 --wheel right:radius=0.1"));
  EXPECT_THAT(mistake({robot(two_wheels(kMesh)), "--wheel", "auto"}),
              HasSubstr("without a cylinder or sphere: --wheel left:radius=0.1 --wheel "
                        "right:radius=0.1"));
}

// ---- motors -----------------------------------------------------------------------------------

/// Casters trail a swivel: none of theirs has a motor, as far as the description has drives.
TEST_F(UrdfOptions, CastersHaveNoMotors) {
  std::string text = two_wheels();
  std::string option = "?wheel=left,right";
  for (const std::string& name : {"a", "b", "c", "d"}) {
    text += link(name + "_fork", inertial(0.3)) +
            joint("continuous", name + "_swivel", "base", name + "_fork", "0.4 0 0.2", "0 0 1") +
            wheel(name, "-0.05 0 -0.1", "", kCylinder, name + "_fork");
    option += "," + name;
  }
  EXPECT_EQ(motors({robot(text) + option}), (Words{"left_axle", "right_axle"}));
  EXPECT_EQ(motors({robot(text) + option + "&motor=a_swivel,left_axle"}),
            (Words{"a_swivel", "left_axle"}));
  EXPECT_THAT(mistake({robot(text) + "?motor=a_swivl"}),
              HasSubstr("--motor: unknown joint 'a_swivl': expected one of"));
}

TEST_F(UrdfOptions, MotorsOfWheelsFirstThenOfDrivenJoints) {
  const std::string limit = R"(<limit effort="20" velocity="1"/>)",
                    none = R"(<limit effort="0" velocity="0"/>)";
  const auto arm = [&](const std::string& name, const std::string& inside) {
    return link(name) +
           joint("continuous", name + "_joint", "base", name, "0 0 0.5", "0 0 1", inside);
  };
  const std::string arms = arm("driven", limit) + arm("loose", "") + arm("idle", none);
  // Neither wheel is marked: both have one. A transmission alone marks; an effort of 0 does not.
  EXPECT_EQ(motors({robot(arms + "" + two_wheels()) + "?wheel=right,left"}),
            (Words{"right_axle", "left_axle", "driven_joint"}));
  const std::string transmission =
      "<transmission name=\"t\"><type>SimpleTransmission</type><joint name=\"idle_joint\"/>"
      "</transmission><ros2_control name=\"c\" type=\"system\"><joint name=\"loose_joint\">"
      "<state_interface name=\"position\"/></joint><joint name=\"left_axle\"><command_interface "
      "name=\"velocity\"/></joint></ros2_control>";
  EXPECT_EQ(motors({robot(two_wheels() + arms + transmission) + "?wheel=right,left"}),
            (Words{"left_axle", "driven_joint", "idle_joint"}));
  // Ten driven joints: those of the wheels, and what fits beside them.
  std::string many = two_wheels();
  for (int i = 0; i < 10; ++i) many += arm("a" + std::to_string(i), limit);
  EXPECT_EQ(motors({robot(many) + "?wheel=left,right"}).size(), 8u);
  EXPECT_EQ(motors({robot(many) + "?wheel=left,right"})[1], "right_axle");
  EXPECT_THAT(
      toml({robot(many) + "?wheel=left,right"}),
      HasSubstr("no motor, as a system has at most 8 inputs (--motor JOINT names those that "
                "have one): \"a6_joint\", \"a7_joint\", \"a8_joint\", \"a9_joint\""));
  EXPECT_EQ(motors({robot(many), "--motor", "a9_joint"}), (Words{"a9_joint"}));
}

// ---- texts ------------------------------------------------------------------------------------

TEST_F(UrdfOptions, NamesWithANamespace) {
  std::string text = two_wheels();
  for (size_t at = 0; (at = text.find("\"left", at)) != std::string::npos; at += 12)
    text.insert(at + 1, "${namespace}");
  const std::string path =
      robot("<xacro:property name=\"namespace\" value=\"$(arg namespace)\"/>" + text);
  EXPECT_EQ(motors({path + "?wheel=left,right"}), (Words{"left_axle", "right_axle"}));
  EXPECT_THAT(toml({path}), HasSubstr("# macros are taken out of names, or replaced by their "
                                      "defaults: \"${namespace}\"\n"));
  // One that has a value here is not taken out.
  EXPECT_THAT(mistake({robot("<xacro:property name=\"namespace\" value=\"a_\"/>" + text)}),
              HasSubstr("'${namespace}' is a macro"));
}

TEST_F(UrdfOptions, LeftoversOfXacroAreNamed) {
  const std::string expands = "macros are expanded by `xacro robot.urdf.xacro -o robot.urdf`";
  std::string number = two_wheels("<cylinder radius=\"${wheel_radius}\" length=\"0.02\"/>");
  EXPECT_THAT(mistake({robot(number)}),
              HasSubstr("robot.urdf:2: not a robot as URDF has it: "
                        "<cylinder radius>: '${wheel_radius}' is a macro: " +
                        expands));
  EXPECT_THAT(mistake({robot("<xacro:include filename=\"a.xacro\"/>" + link("base"))}),
              HasSubstr("<xacro:include> is a macro: " + expands));
  EXPECT_THAT(mistake({robot("<xacro:wheel name=\"left\"/>" + link("base"), "robot.xacro")}),
              HasSubstr("robot.xacro:2: not a robot as URDF has it: <xacro:wheel> is a macro"));
  // A default is the number; files, colours and what is Gazebo's may have any.
  EXPECT_EQ(run({"describe", robot(two_wheels() +
                                   R"(<link name="imu"><visual><geometry><mesh filename="$(find a)/b.stl" scale="1 1 1 1"/>
      </geometry><material name="m"><color rgba="${x/255} 0 0"/></material></visual></link>
      <joint name="j" type="fixed"><origin rpy="$(optenv RPY 0 0 0.3)"/><parent link="base"/>
      <child link="imu"/></joint><gazebo><plugin value="${x}"/></gazebo><material name="m"/>
      <material name="m"><color rgba="1"/></material>)")})
                .status,
            0);
}

TEST_F(UrdfOptions, OtherExtensionsAndFormats) {
    for (const char* name : {"robot.URDF", "robot.xml", "robot.xacro"})
      EXPECT_EQ(motors({robot(two_wheels(), name) + "?wheel=left,right"}).size(), 2u) << name;
    EXPECT_EQ(motors({robot(two_wheels(), "robot.xml"), "--wheel", "left"}).size(), 1u);
    EXPECT_THAT(mistake({write("a.sdf", "<?xml version=\"1.0\"?>\n<sdf version=\"1.6\"/>")}),
                HasSubstr("a.sdf:2: not a robot as URDF has it: it is SDF, of Gazebo, expected "
                          "<robot>; other formats are not read, export it as URDF"));
    EXPECT_THAT(mistake({write("a.xml", "<mujoco model=\"m\"><worldbody/></mujoco>")}),
                HasSubstr("a.xml:1: not a robot as URDF has it: it is MJCF, of MuJoCo"));
    EXPECT_THAT(mistake({write("a.xml", "<html/>")}), HasSubstr("its first element is <html>"));
}

}  // namespace
