// Inputs from the command line: constants, tables, TOML; the record, and what `hamel describe`
// prints of them.
#include <cmath>

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include "program.hpp"

namespace {

using namespace hamel::test;
using Json = nlohmann::json;
using testing::HasSubstr;

class InputsOfTheProgram : public CommandLine {};

// M v' = 2 u / R, M = 7 kg, R = 0.1 m: 0.5 m/s and an impulse of 0.14 N m s later 0.9 m/s.
const std::vector<std::string> kCart = {"differential_drive", "--velocity", "0,0.5,0,5,5",
                                        "--until", "1"};

TEST_F(InputsOfTheProgram, DriveARun) {
  write("held.csv", "t,value\n0,0.2\n0.7,0\n1,0\n");
  write("ramp.csv", "t,value\n0,0\n1,0.28\n");
  const auto speed = [&](const std::string& given) {
    std::vector<std::string> arguments = kCart;
    for (const char* name : {"right_torque", "left_torque"}) {
      arguments.push_back("--input");
      arguments.push_back(std::string(name) + "=" + given);
    }
    const Json r = record(arguments);
    EXPECT_EQ(r["diagnostics"]["exact_error_max"], nullptr);
    EXPECT_NEAR(r["diagnostics"]["work"].get<double>(), 3.5 * (0.81 - 0.25), 1e-5);
    EXPECT_EQ(r["inputs"]["left_torque"], given == "0.14" ? Json(0.14) : Json(given));
    return r["final"]["velocity"][1].get<double>();
  };
  EXPECT_NEAR(speed("0.14"), 0.9, 1e-12);
  EXPECT_NEAR(speed("held.csv:hold"), 0.9, 1e-12);
  EXPECT_NEAR(speed("ramp.csv"), 0.9, 1e-12);
}

/// As they act: a stair where a table is held, lines between the rows else, over the run.
TEST_F(InputsOfTheProgram, StandOnThePage) {
  write("held.csv", "t,value\n-1,0.1\n0.7,0\n2,0\n");
  write("ramp.csv", "t,value\n-1,-0.1\n3,0.3\n");
  std::vector<std::string> arguments = kCart;
  for (const char* given :
       {"--input", "right_torque=held.csv:hold", "--input", "left_torque=ramp.csv"})
    arguments.emplace_back(given);
  const Json page = page_of(arguments);
  if (page.is_null()) HAMEL_SKIP_WITHOUT("page");
  const Json figure = figure_of(page, "Inputs");
  ASSERT_EQ(figure["series"].size(), 2) << figure;
  const Json &right = figure["series"][0], &left = figure["series"][1];
  EXPECT_EQ(right["name"], "right_torque [N m]");
  EXPECT_EQ(right["x"], Json({0.0, 0.7, 0.7, 1.0}));
  EXPECT_EQ(right["y"], Json({0.1, 0.1, 0.0, 0.0}));
  EXPECT_EQ(left["x"], Json({0.0, 1.0}));
  EXPECT_NEAR(left["y"][0].get<double>(), 0, 1e-15);
  EXPECT_NEAR(left["y"][1].get<double>(), 0.1, 1e-15);
  EXPECT_TRUE(figure_of(page_of(kCart), "Inputs").is_null());
}

TEST_F(InputsOfTheProgram, ComeFromAFileAndGoOn) {
  write("run.toml", R"(
system = "differential_drive"
velocity = [0, 0.5, 0, 5, 5]
until = 1
[inputs]
right_torque = 0.14
left_torque = {t = [0, 0.7, 2], value = [0.2, 0, 0], hold = true}
)");
  const Json r = record({"--config", "run.toml", "-o", "first.json"});
  EXPECT_NEAR(r["final"]["velocity"][1].get<double>(), 0.9, 1e-2);
  EXPECT_EQ(r["inputs"]["left_torque"]["hold"], true);
  const Json over = record({"--config", "run.toml", "--input", "right_torque=0"});
  EXPECT_EQ(over["inputs"]["right_torque"], 0.0);
  const Json on = record({"--continue", "first.json"});
  EXPECT_EQ(on["inputs"], r["inputs"]);
  EXPECT_EQ(on["time"], 2.0);
  EXPECT_EQ(record({"differential_drive", "--until", "1"})["inputs"], Json::object());
}

TEST_F(InputsOfTheProgram, BadOnesAreRefused) {
  write("short.csv", "t,value\n0,1\n0.5,1\n");
  write("text.csv", "t,value\n0,1\n0.5,fast\n1,1\n");
  const auto refusal = [&](const std::string& given) {
    std::vector<std::string> arguments = kCart;
    arguments.insert(arguments.begin(), "run");
    arguments.insert(arguments.end(), {"--input", given, "-o", "never.csv"});
    const Outcome outcome = run(arguments);
    EXPECT_EQ(outcome.status, 2) << given;
    return outcome.err;
  };
  EXPECT_THAT(refusal("left_torqe=1"), HasSubstr("did you mean 'left_torque'?"));
  EXPECT_THAT(refusal("torqe=1"), HasSubstr("_torque'?"));  // near a last word
  EXPECT_THAT(refusal("left_torque"), HasSubstr("--input: 'left_torque' is not name=value"));
  EXPECT_THAT(refusal("left_torque=nan"), HasSubstr("got nan, expected a finite number"));
  EXPECT_THAT(refusal("left_torque=none.csv"), HasSubstr("none.csv"));
  EXPECT_THAT(refusal("left_torque=short.csv:hold"), HasSubstr("covers t = 0 to 0.5"));
  EXPECT_THAT(refusal("left_torque=text.csv"), HasSubstr("text.csv:3: got '0.5,fast'"));
  EXPECT_EQ(run({"run", "suslov", "--input", "torque=1"}).status, 2);
  EXPECT_THAT(files(), testing::UnorderedElementsAre("short.csv", "text.csv"));
}

TEST_F(InputsOfTheProgram, AreDescribed) {
  const Json segway = answer({"describe", "segway"});
  ASSERT_EQ(segway["inputs"].size(), 2u);
  EXPECT_EQ(segway["inputs"][0]["name"], "right_torque");
  EXPECT_EQ(segway["inputs"][0]["unit"], "N m");
  EXPECT_THAT(run({"describe", "roller_racer"}).out, HasSubstr("handlebar_torque"));
  EXPECT_EQ(answer({"describe", "suslov"})["inputs"], Json::array());
}

// Each system of a study has its own; both are the runs by themselves.
TEST_F(InputsOfTheProgram, OfAStudy) {
  write("torque.csv", "t,value\n0,0\n0.5,0.3\n1,-0.1\n");
  write("study.toml", R"(
until = 1
repeats = 1
reference = false
step = [0.02, 0.01]
[[system]]
name = "segway"
label = "pushed"
inputs = { right_torque = "torque.csv:hold", left_torque = 0.5 }
[[system]]
name = "segway"
label = "not"
[[system]]
name = "differential_drive"
label = "drive"
inputs = { right_torque = "torque.csv" }
)");
  const Outcome done = run({"study", "study.toml", "-o", "out", "--threads", "2", "--json"});
  ASSERT_EQ(done.status, 0) << done.err;
  write("bad.toml", R"(
until = 2
step = 0.01
[[system]]
name = "segway"
inputs = { right_torque = "torque.csv" }
)");
  const Outcome bad = run({"study", "bad.toml", "-o", "bad"});
  EXPECT_EQ(bad.status, 2);
  EXPECT_THAT(bad.err, HasSubstr("bad.toml:6:"));
  EXPECT_THAT(bad.err, HasSubstr("covers t = 0 to 1, expected the whole run, 0 to 2"));
}

}  // namespace
