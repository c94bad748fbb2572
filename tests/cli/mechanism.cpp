// Mechanisms in files: hamel run, describe and steady.
#include <cmath>
#include <cstdlib>
#include <fstream>

#include <nlohmann/json.hpp>

#include "program.hpp"

namespace {

using namespace hamel::test;
using nlohmann::json;
using testing::HasSubstr;

using MechanismFile = CommandLine;

constexpr const char* kSleigh = R"(name = "sleigh"
[parameters]
offset = { value = 0.2, unit = "m", meaning = "blade to mass centre" }
[[body]]
name = "body"
mass = 1
at = ["offset", 0, 0]
inertia = [0, 0, 0.1]
[[joint]]
kind = "planar"
child = "body"
[[blade]]
body = "body"
[start]
speed = -1
omega = 0.9
)";

/// The sleigh of the registry, from parts; its parameter is set by name.
TEST_F(MechanismFile, RunsAsTheSystem) {
  for (const std::string offset : {"0.2", "0.35"}) {
    const json parts = answer({"run", write(kSleigh), "--set", "offset=" + offset});
    const json system =
        answer({"run", "chaplygin_sleigh", "--set", "offset=" + offset, "--velocity", "0.9,-1,0"});
    for (int i = 0; i < 3; ++i) {
      EXPECT_NEAR(parts["final"]["velocity"][i], system["final"]["velocity"][i], 1e-11);
    }
    EXPECT_EQ(parts["parameters"]["offset"], std::stod(offset));
  }
}

/// Every file of the library runs a second and keeps its energy or its balance; its columns carry
/// the parts' names.
TEST_F(MechanismFile, OfTheLibraryRun) {
  int seen = 0;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::string(std::getenv("HAMEL_SOURCE")) + "/systems/mechanisms")) {
    if (entry.path().extension() != ".toml") continue;
    ++seen;
    const json record = answer(
        {"run", entry.path().string(), "--until", "1", "--step", "0.002", "--compose", "suzuki4"});
    EXPECT_EQ(record["status"], "ok") << entry.path();
    EXPECT_LT(record["diagnostics"]["energy_error_max"].get<double>(), 1e-6) << entry.path();
    EXPECT_LT(record["diagnostics"]["constraint_max"].get<double>(), 1e-10) << entry.path();
    EXPECT_EQ(record["system"], entry.path().stem().string());
  }
  EXPECT_EQ(seen, 9);
  const Outcome o =
      run({"run", "bicycle", "--speed", "5", "--until", "0.1", "-o", file("x.csv"), "--quiet"});
  EXPECT_EQ(o.status, 0) << o.err;
  const std::string head = lines(contents(file("x.csv")))[0];
  for (const char* column :
       {"steer.angle", "rear.reaction1,rear.reaction2,rear.reaction3,front.reaction1",
        "front.reaction3", "R33,x,y,z"}) {
    EXPECT_THAT(head, HasSubstr(column));
  }
}

/// A speed on the command line, in a file, as the few numbers of --velocity; the record has the
/// start that it is.
TEST_F(MechanismFile, StartsAtASpeed) {
  const json by_speed = answer({"run", "bicycle", "--speed", "5", "--until", "0.02"});
  EXPECT_NEAR(by_speed["start"]["velocity"][3], 5, 1e-12);
  EXPECT_NEAR(by_speed["start"]["velocity"][7], 5 / 0.3, 1e-11);  // rear wheel
  const json few = answer({"run", "bicycle", "--velocity", "5", "--until", "0.02"});
  EXPECT_EQ(few["final"]["velocity"], by_speed["final"]["velocity"]);
  const std::string config = write("system = \"bicycle\"\nspeed = 5\nuntil = 0.02\n");
  EXPECT_EQ(answer({"run", "--config", config})["final"]["velocity"],
            by_speed["final"]["velocity"]);
  EXPECT_NEAR(answer({"run", "--config", config, "--speed", "4"})["start"]["velocity"][3], 4,
              1e-12);
  EXPECT_NEAR(
      answer({"run", "falling_disk", "--speed", "2", "--until", "0.02"})["start"]["velocity"][2],
      2 / 0.5, 1e-12);
  EXPECT_NEAR(answer({"run", "segway", "--speed", "2", "--until", "0.02"})["start"]["velocity"][1],
              2, 1e-12);
  EXPECT_THAT(run({"run", "suslov", "--speed", "1"}).err,
              HasSubstr("speed: suslov defines no straight motion; give velocity"));
  EXPECT_THAT(run({"run", "segway", "--speed", "1", "--velocity", "0,1,0"}).err,
              HasSubstr("speed: give it alone"));
  EXPECT_EQ(run({"run", "bicycle", "--speed", "fast"}).status, 2);
}

/// A motor without an effort is an input; a contact's event carries the name of its part.
TEST_F(MechanismFile, IsDrivenAndWatched) {
  const json free = answer({"run", "bicycle", "--speed", "5", "--until", "0.1"});
  const json steered =
      answer({"run", "bicycle", "--speed", "5", "--until", "0.1", "--input", "steer.torque=0.5"});
  EXPECT_GT(std::abs(steered["final"]["velocity"][6].get<double>() -
                     free["final"]["velocity"][6].get<double>()),
            1e-3);
  const json d = answer({"describe", "bicycle"});
  EXPECT_EQ(d["inputs"][0]["name"], "steer.torque");
  EXPECT_EQ(d["inputs"][0]["unit"], "N m");
  EXPECT_EQ(d["events"][0]["name"], "rear.contact_lost");
  EXPECT_EQ(d["events"][1]["name"], "front.contact_lost");
  EXPECT_THAT(run({"run", "bicycle", "--input", "steer.torqe=1"}).err,
              HasSubstr("did you mean 'steer.torque'?"));
  EXPECT_THAT(run({"run", "bicycle", "--events", "frnt.contact_lost"}).err,
              HasSubstr("did you mean 'front.contact_lost'?"));
}

TEST_F(MechanismFile, DescribesItself) {
  const json d = answer({"describe", "bicycle"});
  EXPECT_EQ(d["group"], "se3*so2^3");
  EXPECT_EQ(d["directions"], 3);
  EXPECT_EQ(d["rates"][6], "steer.rate");
  EXPECT_EQ(d["reactions"].size(), 6u);
  EXPECT_EQ(d["parts"][0], "rear frame");
  EXPECT_EQ(d["parameters"][0]["name"], "front_radius");
  const json a = answer({"describe", "--analyse", "bicycle"});
  EXPECT_THAT(a["verdict"].get<std::string>(), HasSubstr("nonholonomic"));
}

TEST_F(MechanismFile, RefusesAParameterItDoesNotHave) {
  const Outcome o = run({"run", write(kSleigh), "--set", "ofset=1"});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr("did you mean 'offset'?"));
}

/// A named input in a force and in another joint's motor, that of a motor in a force; not driven
/// they are 0.
TEST_F(MechanismFile, FormulasUseInputs) {
  const std::string cart = write(R"toml([[body]]
name = "cart"
mass = 2
inertia = [1, 1, 1]
[[body]]
name = "arm"
mass = 1
at = [1, 0, 0]
inertia = [1, 1, 1]
[[joint]]
name = "floor"
kind = "planar"
child = "cart"
[[joint]]
name = "turn"
kind = "hinge"
parent = "cart"
child = "arm"
[[motor]]
joint = "turn"
[[motor]]
joint = "turn"
effort = "-2*wind"
[[force]]
name = "wind"
body = "cart"
along = ["wind*(1 + t)", "turn.torque", 0]
[inputs]
wind = { unit = "N", meaning = "along x", least = -5, most = 5 }
)toml");
  const auto driven = [&](std::vector<std::string> inputs) {
    std::vector<std::string> words = {"run", cart, "--until", "1", "--step", "0.005"};
    for (std::string& input : inputs) words.insert(words.end(), {"--input", std::move(input)});
    return answer(words);
  };
  // The momentum of the whole in the world: the wind's impulse is 2 (1 + 1/2) N s, that along y 0.5
  // N s.
  const json end = driven({"wind=2", "turn.torque=0.5"})["final"];
  const double theta = end["configuration"][0], angle = end["configuration"][3];
  const double omega = end["velocity"][0], v1 = end["velocity"][1], v2 = end["velocity"][2],
               rate = end["velocity"][3];
  const double along = 3 * v1 - (omega + rate) * std::sin(angle),
               across = 3 * v2 + (omega + rate) * std::cos(angle);
  EXPECT_NEAR(std::cos(theta) * along - std::sin(theta) * across, 3, 1e-4);
  EXPECT_NEAR(std::sin(theta) * along + std::cos(theta) * across, 0.5, 1e-4);
  EXPECT_NE(rate, 0);
  EXPECT_EQ(driven({})["final"]["velocity"], json({0.0, 0.0, 0.0, 0.0}));
  const json inputs = answer({"describe", cart})["inputs"];
  ASSERT_EQ(inputs.size(), 2u);
  EXPECT_EQ(inputs[0]["name"], "turn.torque");
  EXPECT_EQ(inputs[1]["name"], "wind");
  EXPECT_EQ(inputs[1]["unit"], "N");
  EXPECT_EQ(run({"run", cart, "--input", "wind=6"}).status, 2);
}

/// By name, and as a file.
TEST_F(MechanismFile, OfTheLibraryGoByName) {
  EXPECT_THAT(run({"list", "systems"}).out, HasSubstr("two_trailer_truck"));
  const json by_name = answer({"run", "kick_scooter", "--until", "0.1"});
  const json file = answer(
      {"run", std::string(std::getenv("HAMEL_SOURCE")) + "/systems/mechanisms/kick_scooter.toml",
       "--until", "0.1"});
  EXPECT_EQ(by_name["final"]["velocity"], file["final"]["velocity"]);
}

/// The contract's record; speeds of the published bicycle.
TEST_F(MechanismFile, SteadyBicycle) {
  const json s = answer({"steady", "bicycle", "--speed", "5"});
  EXPECT_EQ(s["neutral"], 6);
  ASSERT_EQ(s["eigenvalues"].size(), 4u);
  EXPECT_NEAR(s["eigenvalues"][0][0], -0.32286642900409, 1e-8);
  EXPECT_NEAR(s["eigenvalues"][1][0], -0.77534188219585, 1e-8);
  EXPECT_NEAR(s["eigenvalues"][1][1], 4.46486771378823, 1e-8);
  EXPECT_NEAR(s["motion"]["velocity"][3], 5, 1e-12);
  EXPECT_EQ(s["parameters"]["wheelbase"][0], 1.02);
  const json v = answer({"steady", "bicycle", "--vary", "speed=1:8:8"});
  EXPECT_EQ(v["vary"].size(), 8u);
  ASSERT_EQ(v["crossings"].size(), 2u);
  EXPECT_NEAR(v["crossings"][0]["value"], 4.29238253634111, 1e-9);
  EXPECT_EQ(v["crossings"][0]["kind"], "pair");
  EXPECT_NEAR(v["crossings"][1]["value"], 6.02426201538837, 1e-9);
  EXPECT_EQ(v["crossings"][1]["kind"], "real");
  const Outcome o = run({"steady", "bicycle", "--speed", "5"});
  EXPECT_THAT(o.out, HasSubstr("no growing mode"));
  EXPECT_THAT(o.out, HasSubstr("steer.rate"));
}

TEST_F(MechanismFile, SteadySaysWhatItCannotDo) {
  EXPECT_THAT(run({"steady", "suslov", "--speed", "1"}).err,
              HasSubstr("defines no straight motion"));
  EXPECT_THAT(run({"steady", "segway", "--vary", "height=1"}).err,
              HasSubstr("expected name=from:to:count"));
  EXPECT_THAT(run({"steady", "segway", "--speed", "1", "--vary", "hight=1:2:3"}).err,
              HasSubstr("did you mean 'height'?"));
  EXPECT_THAT(run({"steady", "snakeboard"}).err, HasSubstr("depends on time"));
  const Outcome page = run({"steady", "segway", "--report", "a.html"});  // before anything is found
  EXPECT_THAT(page.err, HasSubstr("give --vary"));
  EXPECT_EQ(page.out, "");
  EXPECT_EQ(run({"steady", "snakeboard"}).status, 2);
}

}  // namespace
