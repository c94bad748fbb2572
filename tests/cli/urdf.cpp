// Robots in URDF: hamel run, describe and steady of FILE.urdf with --wheel.
#include <cmath>
#include <cstdlib>

#include "program.hpp"

namespace {

using namespace hamel::test;
using nlohmann::json;
using testing::HasSubstr;

class Urdf : public CommandLine {
 protected:
  // A base with one wheel on a hinge; parts of it in other words.
  std::string robot(const std::string& wheel = kWheel, const std::string& joint = kJoint) const {
    return write("robot.urdf", "<robot name=\"r\"><link name=\"base\">" + inertial(1) + "</link>" +
                                   "<link name=\"left\">" + wheel + "</link>" + joint + "</robot>");
  }
  static std::string inertial(double mass) {
    return "<inertial><mass value=\"" + std::to_string(mass) +
           "\"/><inertia ixx=\"0.1\" ixy=\"0\" ixz=\"0\" iyy=\"0.1\" iyz=\"0\" izz=\"0.1\"/>"
           "</inertial>";
  }
  void refuses(const std::vector<std::string>& arguments, const std::string& message) const {
    std::vector<std::string> all = {"run"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const Outcome o = run(all);
    EXPECT_EQ(o.status, 2) << o.out;
    EXPECT_THAT(o.err, HasSubstr(message));
  }

  static const std::string kWheel, kJoint;
};
const std::string Urdf::kWheel =
    Urdf::inertial(0.2) +
    R"(<collision><origin rpy="1.5708 0 0"/><geometry><cylinder radius="0.1" length="0.02"/>
       </geometry></collision>)";
const std::string Urdf::kJoint =
    R"(<joint name="axle" type="continuous"><parent link="base"/><child link="left"/>
       <axis xyz="0 1 0"/></joint>)";

std::string example(const std::string& name) {
  return std::string(std::getenv("HAMEL_SOURCE")) + "/tests/examples/" + name;
}

using Words = std::vector<std::string>;
const Words kWheels = {"--wheel", "left_wheel", "--wheel", "right_wheel"};
Words join(Words a, const Words& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// Every number of two CSV files but the record agrees to round-off.
void same_rows(const std::string& a, const std::string& b) {
  const auto rows = lines(a), others = lines(b);
  ASSERT_GT(rows.size(), 100u);
  ASSERT_GT(others.size(), 100u);
  size_t compared = 0;
  for (size_t i = 1; i < rows.size() && rows[i][0] != '#'; ++i) {
    const auto x = split(rows[i]), y = split(others.at(i));
    ASSERT_EQ(x.size(), y.size());
    for (size_t k = 0; k < x.size(); ++k) EXPECT_NEAR(std::stod(x[k]), std::stod(y[k]), 1e-12);
    ++compared;
  }
  EXPECT_GT(compared, 100u);
}

/// A robot of ROS moves as the same mechanism by hand, driven and damped; so does the TOML that
/// `describe --toml` writes of it.
TEST_F(Urdf, MovesAsTheMechanismByHand) {
  const Words run_of = {"--input", "left_axle.torque=0.2",
                        "--input", "right_axle.torque=0.12",
                        "--speed", "0.3",
                        "--step",  "0.01",
                        "--until", "3",
                        "--quiet", "-o"};
  const auto rows = [&](const Words& system, const std::string& to) {
    const Outcome o = run(join(join({"run"}, system), join(run_of, {file(to)})));
    EXPECT_EQ(o.status, 0) << o.err;
    return contents(file(to));
  };
  const std::string robot = rows(join({example("diff_drive.urdf")}, kWheels), "robot.csv");
  EXPECT_THAT(lines(robot)[0], HasSubstr("theta,x,y,left_axle.angle,right_axle.angle"));
  same_rows(robot, rows({example("diff_drive.toml")}, "hand.csv"));
  const Outcome toml = run(join({"describe", "--toml", example("diff_drive.urdf")}, kWheels));
  ASSERT_EQ(toml.status, 0) << toml.err;
  same_rows(robot, rows({write("written.toml", toml.out)}, "written.csv"));
}

/// A name with its wheels goes wherever a system is named, and into the record.
TEST_F(Urdf, IsASystemByName) {
  const std::string name = example("diff_drive.urdf") + "?wheel=left_wheel,right_wheel";
  const json record = answer({"run", name, "--speed", "0.5", "--until", "1", "-o", file("x.json")});
  EXPECT_EQ(record["system"], "diff_drive");
  EXPECT_EQ(record["system_file"], name);
  EXPECT_EQ(record["group"], "se2*so2^2");
  const json next = answer({"run", "--continue", file("x.json")});
  EXPECT_NEAR(next["time"].get<double>(), 2, 1e-9);
  const json steady = answer(join({"steady", example("diff_drive.urdf"), "--speed", "0"}, kWheels));
  EXPECT_LT(steady["residual"].get<double>(), 1e-9);
  const json description = answer(join({"describe", example("diff_drive.urdf")}, kWheels));
  EXPECT_EQ(description["inputs"][0]["name"], "left_axle.torque");
  EXPECT_EQ(description["directions"], 2);
  write("study.toml",
        "system = [{ name = \"" + name + "\", velocity = [0.5] }]\nstep = [0.01]\nuntil = 1\n");
  const Outcome study = run({"study", file("study.toml"), "-o", file("study"), "--quiet"});
  EXPECT_EQ(study.status, 0) << study.err;
}

/// A free root, and a ball: a body that balances, whose height the wheel gives.
TEST_F(Urdf, HangsOnTheGroundAsRootSpecifies) {
  const std::string path = robot();
  EXPECT_EQ(answer({"describe", path, "--wheel", "left", "--root", "free"})["group"], "se3*so2");
  EXPECT_EQ(answer({"describe", path, "--wheel", "left"})["group"], "se2*so2");
  EXPECT_EQ(answer({"describe", path, "--root", "fixed"})["group"], "so2");
  const std::string toml = run({"describe", path, "--wheel", "left", "--toml"}).out;
  EXPECT_THAT(toml, HasSubstr("at = [0, 0, 0.1], radius = 0.1"));
  EXPECT_THAT(toml, HasSubstr("# angles within 0.002 rad of a right angle"));
  const std::string ball =
      robot(inertial(0.2) + R"(<visual><geometry><sphere radius="0.1"/></geometry></visual>)",
            R"(<joint name="j" type="floating"><parent link="base"/><child link="left"/></joint>)");
  EXPECT_THAT(run({"describe", ball, "--wheel", "left", "--toml"}).out, HasSubstr("ball = ["));
}

/// A robot of which no wheel is named slides like a puck, which a note says.
TEST_F(Urdf, WithoutAWheelSlidesAndSaysSo) {
  const std::string without = answer({"run", robot(), "--until", "0.1"})["notes"].dump(),
                    with = answer({"run", robot(), "--wheel", "left", "--until", "0.1"})["notes"]
                               .dump();
  EXPECT_THAT(without, HasSubstr("no --wheel is given"));
  EXPECT_THAT(with, testing::Not(HasSubstr("no --wheel is given")));
}

/// What a mechanism does not have is in a note of the run.
TEST_F(Urdf, NotesWhatItLeavesOut) {
  const json record = answer(
      {"run",
       robot(
           kWheel + R"(<visual><geometry><mesh filename="package://a/b.stl"/></geometry></visual>)",
           R"(<joint name="axle" type="revolute"><parent link="base"/><child link="left"/>
                <axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="2" velocity="1"/>
                <dynamics damping="0.1" friction="0.3"/></joint>)"),
       "--root", "fixed", "--until", "0.1"});
  const std::string notes = record["notes"].dump();
  for (const char* note :
       {"limits of position and velocity are not kept: \\\"axle\\\"",
        "friction is left out (--joint-friction keeps it), damping is kept: \\\"axle\\\"",
        "meshes are not drawn: \\\"left\\\""})
    EXPECT_THAT(notes, HasSubstr(note));
  EXPECT_THAT(run({"describe", file("robot.urdf"), "--toml"}).out,
              HasSubstr("cylinder = [0.1, 0.02]"));  // its collision instead
}

TEST_F(Urdf, RefusesWithNames) {
  const std::string drive = example("diff_drive.urdf");
  refuses({drive, "--wheel", "left_weel"},
          "wheel 'left_weel': unknown link 'left_weel': expected one of base_footprint, base_link, "
          "caster, left_wheel, right_wheel; did you mean 'left_wheel'?");
  refuses({drive, "--wheel", "base_link"}, "wheel 'base_link': it has no cylinder or sphere");
  refuses({drive, "--wheel", "caster"}, "fixed to the root link 'base_footprint', it cannot roll");
  refuses({drive, "--wheel", "left_wheel:rolls"}, "expected one of wheel, ball");
  refuses({drive, "--wheel", "left_wheel:ball"}, "a ball is a sphere, got a cylinder");
  refuses({drive, "--root", "planer"},
          "unknown root 'planer': expected one of planar, free, fixed; did you mean 'planar'?");
  refuses({drive + "?whel=left_wheel"}, "unknown option of");
  refuses({robot(kWheel, "<joint name=\"ax\x7fle\" type=\"continuous\">" +
                             kJoint.substr(kJoint.find('>') + 1))},
          "joint 'ax\\u007fle': expected a name without");
  refuses({drive + "?wheel"}, "is not name=value");
  refuses({"suslov", "--wheel", "left"},
          "--wheel: for a robot, FILE.urdf; got the system 'suslov'");
  refuses({robot("<visual><geometry><mesh filename=\"a.stl\"/></geometry></visual>" + inertial(1)),
           "--wheel", "left"},
          "wheel 'left': its geometry is a mesh");
  refuses({robot("")}, "link 'left': it and all that it carries have no mass");
  refuses({robot(kWheel, R"(<joint name="axle" type="continuous"><parent link="base"/>
                            <child link="left"/><mimic joint="axle"/></joint>)")},
          "joint 'axle': mimic");
  refuses({robot(kWheel, "")}, "Two root links found");
  refuses(
      {robot(
          kWheel,
          R"(<joint name="axle" type="screw"><parent link="base"/><child link="left"/></joint>)")},
      "has no known type [screw]");
  refuses({robot(kWheel, R"(<joint name="axle" type="continuous"><origin xyz="0, 0.1, 0"/>
                            <parent link="base"/><child link="left"/></joint>)")},
          "separate numbers by blanks, without commas");
  refuses({robot(kWheel, R"(<joint name="axle" type="prismatic"><parent link="base"/>
                            <child link="left"/></joint>)")},
          "without limits; add <limit effort=\"0\" velocity=\"0\"/> to the joint");
  refuses({write("robot.urdf", "<robot name=\"r\"><link name=\"base\"></robot>")},
          "robot.urdf:1: not a robot as URDF has it: </robot>, expected </link>");
  refuses({write("robot.urdf", "")}, "robot.urdf: not a robot as URDF has it");
  refuses({write("robot.urdf", std::string(100, '<') + "a")}, "robot.urdf:1: not a robot");
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  refuses({write("robot.urdf", deep)}, "elements nested more than 64 deep");
  refuses({write("robot.urdf", "<robot name=\"r\">\n<link name=\"b\xe9\"/></robot>")},
          "robot.urdf:2: is no UTF-8");
  refuses({file("none.urdf")}, "there is no such file");
}

}  // namespace
