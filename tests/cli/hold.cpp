// --hold: joints of a mechanism that are locked, whatever its file says.
#include "urdf_robots.hpp"

namespace {

using namespace hamel::test;
using nlohmann::json;
using testing::HasSubstr;

class Hold : public UrdfRobots {};

/// The joint rests at the value given, or where the start has it, and the motion is that of a file
/// with `held = true`.
TEST_F(Hold, LocksAJoint) {
  const json at = answer({"run", "kick_scooter", "--hold", "steer=0.1", "--until", "1"});
  const json named = answer({"run", "kick_scooter?hold=steer=0.1", "--until", "1"});
  EXPECT_EQ(at["system"], "kick_scooter?hold=steer=0.1");
  EXPECT_EQ(at["final"], named["final"]);
  const Words whole = {"kick_scooter", "--hold", "steer=0.1", "--until", "1", "-o", file("a.h5")};
  Words begun = {"run"};
  begun.insert(begun.end(), whole.begin(), whole.end());
  if (run(begun).status == 0) {  // where there is HDF5
    const Outcome page = run({"report", file("a.h5"), "-o", file("a.html")});
    if (page.err.find("without the page") == std::string::npos) {  // run() knows where it must be
      EXPECT_EQ(page.status, 0) << page.err;
      EXPECT_THAT(contents(file("a.html")), HasSubstr("kick_scooter?hold=steer=0.1"));
    }
  }
  EXPECT_NEAR(at["final"]["velocity"][3].get<double>(), 0, 1e-14);
  std::string text = run({"describe", "kick_scooter", "--toml"}).out;
  const std::string steer = "name = \"steer\"";
  text.replace(text.find(steer), steer.size(), steer + ", held = true");
  const json held = answer({"run", write("held.toml", text), "--until", "1"});
  const json where = answer({"run", "kick_scooter", "--hold", "steer", "--until", "1"});
  EXPECT_EQ(where["final"]["velocity"], held["final"]["velocity"]);
  EXPECT_EQ(where["final"]["element"], held["final"]["element"]);
}

/// Of files in TOML and URDF too, several at once, and in a file of --config.
TEST_F(Hold, OfEveryFile) {
  const std::string arm = robot(
      two_wheels() + link("arm", inertial(0.4)) +
      joint("continuous", "shoulder", "base", "arm", "0.2 0 0.3", "0 0 1") +
      link("tip", inertial(0.1)) + joint("continuous", "wrist", "arm", "tip", "0.3 0 0", "0 0 1"));
  const auto end = [&](const Words& more) {
    Words all = {"--wheel", "left,right", "--input", "left_axle.torque=0.2"};
    all.insert(all.end(), more.begin(), more.end());
    return end_of({arm}, all);
  };
  const auto held = end({"--hold", "shoulder=0.4", "--hold", "wrist"});
  EXPECT_NEAR(held.at("shoulder.angle"), 0.4, 1e-12);
  EXPECT_NEAR(held.at("wrist.angle"), 0, 1e-12);
  EXPECT_GT(std::abs(end({}).at("wrist.angle")), 1e-4);
  const std::string toml = write("bicycle.toml", run({"describe", "bicycle", "--toml"}).out);
  const json rides = answer({"run", "--config",
                             write("run.toml", "system = \"" + toml +
                                                   "\"\nhold = [\"steer\"]\nspeed = 3\n"
                                                   "until = 0.5\n")});
  EXPECT_NEAR(rides["final"]["velocity"][6].get<double>(), 0, 1e-14);
}

TEST_F(Hold, RefusesWhatItCannotHold) {
  const auto said = [&](const Words& words) {
    Words all = {"run"};
    all.insert(all.end(), words.begin(), words.end());
    const Outcome o = run(all);
    EXPECT_EQ(o.status, 2);
    return o.err;
  };
  EXPECT_THAT(said({"kick_scooter", "--hold", "ster"}), HasSubstr("did you mean 'steer'?"));
  EXPECT_THAT(said({"kick_scooter", "--hold", "steer=a"}),
              HasSubstr("hold: 'steer=a': expected JOINT or JOINT=value, rad or m"));
  EXPECT_THAT(said({"kick_scooter?hodl=steer"}), HasSubstr("did you mean 'hold'?"));
  EXPECT_THAT(said({"suslov", "--hold", "a"}), HasSubstr("'suslov' takes no options"));
  const std::string data = write("d.toml", "group = \"r2\"\ninertia = [1, 1]\nvelocity = [1, 0]\n");
  EXPECT_THAT(said({data, "--hold", "a"}), HasSubstr("hold is an option of mechanisms, and this "
                                                     "file is a system by data"));
  EXPECT_THAT(run({"describe", "bicycle", "--hold", "steer", "--toml"}).err,
              HasSubstr("set held = true at the joint"));
}

}  // namespace
