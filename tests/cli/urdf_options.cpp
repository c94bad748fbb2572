// Robots in URDF: joints that are welded or driven, and texts as they are found.
#include <cmath>

#include "urdf_robots.hpp"

namespace {

using namespace hamel::test;
using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class UrdfOptions : public UrdfRobots {};

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

/// Only the whole that is welded together must be a rigid body: -0.004 and 0.01 are as 0.006, and
/// -0.4 is made up for by the distance of two masses.
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
  const std::string apart = robot(
      link("base") + link("arm") + joint("continuous", "hinge", "base", "arm", "0 0 0.5") +
      link("antenna", inertial(1, "-0.4")) + joint("fixed", "mount", "arm", "antenna", "0 1 0"));
  EXPECT_EQ(run({"run", apart, "--root", "fixed", "--until", "0.1", "--quiet"}).status, 0);
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

/// A joint about the vertical with the friction f stops after J w/f, and rests.
TEST_F(UrdfOptions, JointsKeepTheirFriction) {
  const std::string arm =
      robot(link("base") + link("arm", inertial(2)) +
            joint("continuous", "turn", "base", "arm", "0 0 0.5", "0 0 1",
                  "<dynamics friction=\"0.3\"/>") +
            link("tool", inertial(1)) + joint("fixed", "mount", "arm", "tool", "0 0 0.1"));
  const Words start = {"--root", "fixed", "--start", "turn.rate=2",
                       "--rtol", "1e-10", "--until", "100"};
  const auto of = [&](const std::string& friction) {
    Words words = {"run", arm};
    words.insert(words.end(), start.begin(), start.end());
    if (!friction.empty()) words.insert(words.end(), {"--slip", "--joint-friction", friction});
    return answer(words);
  };
  const json without = of("");
  EXPECT_THAT(without["notes"].dump(),
              HasSubstr("friction is left out (--joint-friction keeps it), damping is kept"));
  const double rate = without["final"]["velocity"][0].get<double>();
  EXPECT_NEAR(rate, 2, 1e-12);
  const double inertia = without["final"]["momentum"][0].get<double>() / rate;
  for (const char* friction : {"all", "turn"}) {
    const json out = of(friction);
    EXPECT_THAT(out["notes"].dump(), testing::Not(HasSubstr("friction is left out")));
    ASSERT_EQ(out["events"].size(), 1U);
    EXPECT_EQ(out["events"][0]["name"], "turn.sticks");
    EXPECT_NEAR(out["events"][0]["time"].get<double>(), 2 * inertia / 0.3, 1e-10);
    EXPECT_EQ(out["final"]["velocity"][0].get<double>(), 0);
  }
  EXPECT_THAT(mistake({arm, "--joint-friction", "tern"}),
              HasSubstr("--joint-friction: unknown joint 'tern': expected one of turn, all; did "
                        "you mean 'turn'?"));
  EXPECT_THAT(mistake({arm, "--joint-friction", "mount"}),
              HasSubstr("joint 'mount' has none, expected <dynamics friction="));
}

/// The same options in a file of --config.
TEST_F(UrdfOptions, OptionsInAConfiguration) {
  write("a.toml", "system = \"" + robot(two_wheels()) + "\"\nwheel = [\"left\"]\nuntil = 0\n" +
                      "weld_all_but = [\"left_axle\"]\nmotor = [\"left_axle\"]\nroot = \"free\"\n");
  const json record = answer({"run", "--config", file("a.toml")});
  EXPECT_THAT(record["system_file"].get<std::string>(),
              testing::EndsWith("?wheel=left&motor=left_axle&weld-all-but=left_axle&root=free"));
  EXPECT_EQ(record["group"], "se3*so2");
}

/// A joint that mimics is coupled, and needs no motor; it, or the one that it follows, may be
/// welded.
TEST_F(UrdfOptions, MimickingJointsAreCoupled) {
  const std::string path = robot(two_wheels() + link("f1") +
                                 joint("prismatic", "finger1", "base", "f1", "0.2 0 0", "0 1 0",
                                       R"(<limit lower="0" upper="1" effort="5" velocity="1"/>)") +
                                 link("f2") +
                                 joint("prismatic", "finger2", "base", "f2", "0.2 0 0", "0 -1 0",
                                       R"(<limit lower="0" upper="1" effort="5" velocity="1"/><mimic
                     joint="finger1"/>)"));
  EXPECT_THAT(toml({path, "--wheel", "left"}),
              HasSubstr("joint = \"finger2\", to = \"finger1\", ratio = 1"));
  const json run = answer({"run", path, "--wheel", "left", "--wheel", "right", "--input",
                           "finger1.force=0.5", "--until", "0.2"});
  const auto& end = run["final"]["configuration"];
  EXPECT_GT(std::abs(end[3].get<double>()), 1e-3);
  EXPECT_NEAR(end[3].get<double>(), end[4].get<double>(), 1e-12);
  EXPECT_EQ(answer({"describe", path, "--weld", "finger2"})["group"], "se2*r1*so2^2");
  EXPECT_EQ(answer({"describe", path, "--weld", "finger1"})["group"], "se2*so2^2");
  EXPECT_THAT(toml({path, "--weld", "finger1"}),
              HasSubstr("welded too, as they mimic a joint that is: \"finger2\""));
}

// ---- motors -----------------------------------------------------------------------------------

/// Casters trail a swivel: none of theirs has a motor, as far as the description has drives.
TEST_F(UrdfOptions, CastersHaveNoMotors) {
  std::string text = two_wheels();
  std::string option = "?wheel=left,right";
  for (const std::string name : {"a", "b", "c", "d"}) {
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
  // Driven joints: those of the wheels, and what fits beside them.
  std::string many = two_wheels();
  for (int i = 0; i < 34; ++i) many += arm("a" + std::to_string(i), limit);
  EXPECT_EQ(motors({robot(many) + "?wheel=left,right"}).size(), 32u);
  EXPECT_EQ(motors({robot(many) + "?wheel=left,right"})[1], "right_axle");
  EXPECT_THAT(
      toml({robot(many) + "?wheel=left,right"}),
      HasSubstr("no motor, as a system has at most 32 inputs (--motor JOINT names those that "
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
  EXPECT_THAT(
      toml({path}),
      HasSubstr(
          "# macros of xacro are taken out, or replaced by their defaults: \"${namespace}\"\n"));
  // Not with a value of its own.
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
  for (const char* word : {"include filename=\"a.xacro\"", "macro name=\"m\"", "if value=\"1\""})
    EXPECT_THAT(
        mistake({robot("<xacro:" + std::string(word) + "/>" + link("base"), "robot.xacro")}),
        HasSubstr("is of a macro file: " + expands));
  // A call that no definition is left of.
  EXPECT_THAT(toml({robot("<xacro:imu_sensor/>" + two_wheels())}),
              HasSubstr("# macros of xacro are taken out, or replaced by their defaults: "
                        "\"<xacro:imu_sensor>\"\n"));
  // A default is the number; files, colours and what is Gazebo's may have any.
  const std::string harmless =
      "<link name=\"imu\"><visual><geometry><mesh filename=\"$(find a)/b.stl\" scale=\"1 1 1 1\"/>"
      "</geometry><material name=\"m\"><color rgba=\"${x/255} 0 0\"/></material></visual></link>"
      "<joint name=\"j\" type=\"fixed\"><origin rpy=\"$(optenv RPY 0 0 0.3)\"/><parent "
      "link=\"base\"/><child link=\"imu\"/></joint><gazebo><plugin value=\"${x}\"/></gazebo>"
      "<material name=\"m\"/><material name=\"m\"><color rgba=\"1\"/></material>";
  const Outcome o = run({"describe", robot(two_wheels() + harmless)});
  EXPECT_EQ(o.status, 0) << o.err;
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
