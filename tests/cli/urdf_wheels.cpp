// Robots in URDF: links that roll.
#include <cmath>

#include "urdf_robots.hpp"

namespace {

using namespace hamel::test;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class UrdfWheels : public UrdfRobots {};

/// Meshes have no radius; given one, they roll as cylinders do, by either spelling.
TEST_F(UrdfWheels, WheelsOfGivenRadius) {
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
            "unknown value 'raduis': expected one of radius, angle, friction; did you mean "
            "'radius'?"},
           {"left:omny",
            "unknown kind of wheel 'omny': expected one of wheel, ball, omni, mecanum"},
           {"left:angle=1", "angle: of the rollers of an omni or mecanum wheel"},
           {"lft:radius=1", "unknown link 'lft'"}})
    EXPECT_THAT(mistake({round, "--wheel", given}), HasSubstr(message)) << given;
}

/// Wheels whose rows are those of a mecanum base: r w = vx -+ vy -+ (lx + ly) omega; the rates that
/// follow from a motion of the base, by either direction of the hinges.
TEST_F(UrdfWheels, MecanumAndOmniWheels) {
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
    const json d = answer({"describe", written});
    std::map<std::string, double> out;
    for (size_t i = 0; i < d["rates"].size(); ++i)
      out[d["rates"][i].get<std::string>()] = d["start"]["velocity"][i].get<double>();
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

TEST_F(UrdfWheels, WheelsThatCannotRoll) {
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

/// A caster whose swivel has no <axis>, which is along x then, behind drive wheels that are fixed
/// (pioneer3dx as it is published): what has to be changed is said. With an upright swivel the
/// caster is taken, as is a wheel on a swinging arm.
TEST_F(UrdfWheels, AutoLeavesAForkThatTips) {
  const auto caster = [&](const std::string& axis) {
    return link("fork", inertial(0.5)) +
           joint("continuous", "swivel", "base", "fork", "-0.2 0 0.15", axis) +
           wheel("caster_wheel", "-0.03 0 -0.05", "", kCylinder, "fork");
  };
  const std::string base = link("base", inertial(5));
  const std::string fixed =
      base + link("left_wheel") + joint("fixed", "l", "base", "left_wheel", "0 0.2 0.1");
  EXPECT_THAT(mistake({robot(fixed + caster("1 0 0")), "--wheel", "auto"}),
              AllOf(HasSubstr("'caster_wheel' is left out, since the hinge 'swivel' of its fork is "
                              "along the way that it rolls"),
                    HasSubstr("called wheels, but on fixed joints: \"left_wheel\"")));
  EXPECT_THAT(toml({robot(fixed + caster("0 0 1"), "upright.urdf"), "--wheel", "auto"}),
              HasSubstr("--wheel auto takes \"caster_wheel\""));
  EXPECT_THAT(toml({robot(fixed + caster("0 1 0"), "arm.urdf"), "--wheel", "auto"}),
              HasSubstr("--wheel auto takes \"caster_wheel\""));
  EXPECT_THAT(
      toml({robot(base + wheel("left", "0 0.2 0.1") + caster("1 0 0"), "both.urdf"), "--wheel",
            "auto"}),
      AllOf(HasSubstr("--wheel auto takes \"left\""), HasSubstr("'caster_wheel' is left out")));
}

/// A centre beside the axis of the joint by a millimetre, and an axle that leans by hundredths, are
/// of the drawing: the wheel turns about its joint, as one that is drawn so.
TEST_F(UrdfWheels, WheelsTurnAboutTheirJoints) {
  const auto drawn = [&](const std::string& origin, const std::string& name) {
    return robot(link("base", inertial(5)) +
                     link("w", inertial(1) + "<collision><origin " + origin + "/><geometry>" +
                                   kCylinder + "</geometry></collision>") +
                     joint("continuous", "axle", "base", "w", "0 0.2 0.101"),
                 name);
  };
  const std::string off = drawn("xyz=\"0 0 -0.001\" rpy=\"1.55 0 0\"", "off.urdf");
  EXPECT_THAT(
      toml({off, "--wheel", "w"}),
      HasSubstr("# wheel 'w': its cylinder leans by 0.0208 rad against the axis of joint "
                "'axle', which is taken as its axle\n# wheel 'w': its centre is 0.001 m off "
                "the axis of joint 'axle'"));
  same_end({off, "--wheel", "w"}, {drawn("rpy=\"1.5707963267948966 0 0\"", "on.urdf") + "?wheel=w"},
           {"--input", "axle.torque=0.1", "--speed", "0.3"});
}

/// Heights that differ by a little more than round-off are of the drawing, others are mistakes.
TEST_F(UrdfWheels, WheelsAtOtherHeights) {
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
TEST_F(UrdfWheels, ARootThatRolls) {
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

TEST_F(UrdfWheels, NamesWhatLooksLikeWheels) {
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
  // Round parts of another height are none of the wheels.
  const std::string legs = robot(two_wheels() + wheel("motor", "0.5 0 0.12"));
  EXPECT_THAT(toml({legs, "--wheel", "auto"}), HasSubstr("takes \"left\", \"right\"\n"));
  EXPECT_THAT(mistake({legs, "--wheel", "left,motor"}), HasSubstr("does not touch the ground"));
  EXPECT_THAT(toml({robot(two_wheels(kMesh))}),
              HasSubstr("these may be wheels: --wheel left:radius=0.1 --wheel right:radius=0.1"));
  EXPECT_THAT(mistake({robot(two_wheels(kMesh)), "--wheel", "auto"}),
              HasSubstr("without a cylinder or sphere: --wheel left:radius=0.1 --wheel "
                        "right:radius=0.1"));
}

/// A rail, a stand: its root has no mass, and does not slide.
TEST_F(UrdfWheels, ARootWithoutMassIsFixed) {
  const std::string path =
      robot(link("rail", "") + link("plate", "") +
            joint("fixed", "bolt", "rail", "plate", "0 0 0.1") + link("cart") +
            joint("prismatic", "slide", "plate", "cart", "0 0 0", "1 0 0",
                  "<limit effort=\"1\" velocity=\"1\" lower=\"-9\" upper=\"9\"/>"));
  EXPECT_EQ(answer({"describe", path})["group"], "r1");
  EXPECT_THAT(toml({path}), HasSubstr("the root has no mass and is fixed to the ground (--root "
                                      "planar or free): \"rail\""));
  EXPECT_THAT(mistake({path, "--root", "planar"}), HasSubstr("nothing that has inertia moves"));
}

}  // namespace
