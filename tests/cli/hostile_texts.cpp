// Texts that a user did not write with care: markup, terminal escapes, bytes that are no UTF-8,
// NUL, numbers that no double holds, records with entries of the wrong type. Each has its place in
// the message, or is harmless where it is shown.
#include "program.hpp"

namespace {

using namespace hamel::test;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

class HostileTexts : public CommandLine {
 protected:
  // The scooter of tests/examples with another potential, and another name.
  std::string scooter(const std::string& potential,
                      const std::string& name = "kick scooter") const {
    std::string text = source_file("tests/examples/scooter_by_rows.toml");
    const auto replace = [&](const std::string& key, const std::string& value) {
      const size_t from = text.find(key + " = \""), end = text.find('\n', from);
      text.replace(from, end - from, key + " = \"" + value + "\"");
    };
    replace("potential", potential);
    replace("name", name);
    return text;
  }
  static bool without_page(const Outcome& o) {
    return o.err.find("without the page") != std::string::npos;
  }
};

/// A script that is opened within a comment does not end with the data: the page was empty.
TEST_F(HostileTexts, NoMarkupBeginsWithinAPage) {
  write(scooter("0", "</script><!--<script> & \\u2028"));
  const Outcome o = run({"run", "system.toml", "--until", "0.1", "--quiet", "--report", "a.html"});
  if (without_page(o)) return;
  ASSERT_EQ(o.status, 0) << o.err;
  const std::string page = contents(file("a.html")), head = "id=\"hamel-data\">";
  const size_t from = page.find(head) + head.size(), end = page.find("</script>", from);
  EXPECT_EQ(page.substr(from, end - from).find('<'), std::string::npos);
  EXPECT_THAT(page_data(page)["title"].get<std::string>(), HasSubstr("</script><!--<script>"));
}

TEST_F(HostileTexts, NoTerminalIsDriven) {
  const std::string escapes = "\\u001b]0;title\\u0007\\u001b[31mred\\u009b31m\\u007f\\r";
  const std::string shown = "\\u001b]0;title\\u0007\\u001b[31mred\\u009b31m\\u007f\\u000d";
  write(scooter("0", escapes));
  const auto harmless = [&](const std::string& text) {
    for (const char* control : {"\x1b", "\x07", "\x7f", "\r", "\xc2\x9b"})
      EXPECT_EQ(text.find(control), std::string::npos) << text;
  };
  for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
           {"run", "system.toml", "--until", "0.1"}, {"describe", "system.toml"}}) {
    const Outcome o = run(words);
    ASSERT_EQ(o.status, 0) << o.err;
    EXPECT_THAT(o.out, HasSubstr(shown));
    harmless(o.out);
  }
  // JSON is what it was.
  EXPECT_EQ(record({"system.toml", "--until", "0.1"})["system"].get<std::string>(),
            Json::parse("\"" + escapes + "\"").get<std::string>());
  write("config.toml", "system = \"suslov\"\nscheme = \"" + escapes + "\"\n");
  const Outcome o = run({"run", "--config", "config.toml"});
  EXPECT_EQ(o.status, 2);
  EXPECT_THAT(o.err, HasSubstr(shown));
  harmless(o.err);
}

TEST_F(HostileTexts, NamesOfFilesThatAreNoUtf8) {
  const std::string name = "caf\xe9";
  write(name + ".toml", scooter("0"));
  write(name + ".csv", "t,value\n0,0\n20,0\n");
  const auto refused = [&](const std::vector<std::string>& words, const std::string& why) {
    const Outcome o = run(words);
    EXPECT_EQ(o.status, 2);
    EXPECT_EQ(o.err, "hamel: " + why + "\n");
  };
  refused({"run", name + ".toml", "-o", "a.h5"}, "system: the name 'caf\\xe9.toml' is no UTF-8");
  refused({"run", "segway", "--input", "right_torque=" + name + ".csv", "--json"},
          "input right_torque: the name 'caf\\xe9.csv' is no UTF-8");
  // What is written may be called so, and compared.
  write("s.toml", scooter("0"));
  std::vector<std::string> report = {"report", "-o", name + ".html"};
  for (const std::string& output : {name + ".h5", name + "2.h5"}) {
    const Outcome o = run({"run", "s.toml", "--until", "0.1", "--quiet", "-o", output});
    if (o.err.find("no HDF5") != std::string::npos) return;
    ASSERT_EQ(o.status, 0) << o.err;
    report.push_back(output);
  }
  const Outcome o = run(report);
  EXPECT_TRUE(o.status == 0 || without_page(o)) << o.err;
}

TEST_F(HostileTexts, FormulasAndNumbers) {
  refused(scooter("1 \\u0000 garbage"), "system.toml:13:16: potential: a character U+0000");
  refused(scooter("2*x + 1e400"), "system.toml:13:20: potential: the number 1e400 is too large");
  refused(scooter("1e+400*x"), "system.toml:13:14: potential: the number 1e+400 is too large");
  refused(scooter("x + 1e-400"), "system.toml:13:18: potential: the number 1e-400 is too large or");
  EXPECT_THAT(run({"run", "suslov", "--set", "inertia=1,2,1e400"}).err,
              HasSubstr("'1e400' in '1,2,1e400' is too large"));
  for (const char* number : {"1e400", "1e-400"}) {
    const Outcome o = run({"run", "suslov", "--until", number});
    EXPECT_EQ(o.status, 2) << o.out;
    EXPECT_EQ(o.err, std::string("hamel: --until: '") + number +
                         "' is too large or too small for a number (2.3e-308 to 1.7e308)\n");
  }
}

/// The commands beside run: CLI11 took 1e-400 for 0.
TEST_F(HostileTexts, NumbersOfOptions) {
  const auto refused = [&](std::vector<std::string> arguments, const std::string& option,
                           const std::string& before = "", const std::string& behind = "") {
    for (const std::string number : {"1e400", "1e-400"}) {
      std::vector<std::string> line = arguments;
      line.insert(line.end(), {option, before + number + behind});
      const Outcome o = run(line);
      EXPECT_EQ(o.status, 2) << o.out;
      EXPECT_EQ(o.err, "hamel: " + option + ": '" + number +
                           "' is too large or too small for a number (2.3e-308 to 1.7e308)\n");
    }
  };
  const std::vector<std::string> section = {"section", "suslov",  "--event",
                                            "xi1=0",   "--count", "2"};
  refused(section, "--energy");
  refused(section, "--until");
  refused(section, "--step");
  const std::vector<std::string> steady = {"steady", "bicycle", "--json"};
  refused(steady, "--speed");
  refused(steady, "--sample-time");
  refused(steady, "--vary", "speed=", ":8:7");
  refused(steady, "--vary", "speed=1:");
  const auto whole = [&](const std::vector<std::string>& arguments, const std::string& option) {
    std::vector<std::string> line = arguments;
    line.insert(line.end(), {option, "1e-400"});
    const Outcome o = run(line);
    EXPECT_EQ(o.status, 2) << o.out;
    EXPECT_EQ(o.err, "hamel: " + option + ": '1e-400' is not a whole number\n");
  };
  whole({"section", "suslov", "--event", "xi1=0"}, "--count");
  whole({"ensemble", "x.toml"}, "--member");
}

/// Where they are, whatever stands before them: toml++ took 1e-400 for 0.
TEST_F(HostileTexts, NumbersOfFiles) {
  const auto refused = [&](const std::string& line, const std::string& place) {
    write("a.toml", "system = \"suslov\"\n" + line + "\n");
    const Outcome o = run({"run", "--config", "a.toml", "--step", "0.1", "--until", "1"});
    EXPECT_EQ(o.status, 2) << o.out;
    EXPECT_EQ(o.err, "hamel: a.toml:" + place + " is too large or too small\n");
  };
  refused("until = 1e400", "2:9: the number 1e400");
  refused("until = 1e-400", "2:9: the number 1e-400");
  refused("# 1e999\nset = { inertia = [1, 2, -1_0.0e+9_99] }", "3:27: the number 10.0e+999");
  refused("\"caf\u00e9 1e999\" = 1e-999", "2:16: the number 1e-999");
  write("a.toml", "system = \"suslov\"\nuntil = 1_0e-1  # 1e-400\nstep = 0.1\n");
  EXPECT_EQ(run({"run", "--config", "a.toml"}).status, 0);
}

TEST_F(HostileTexts, RecordsOfAnotherType) {
  const Json good = record({"suslov", "--until", "0.1"});
  const auto refused = [&](const char* pointer, const Json& value, const std::string& why) {
    Json bad = good;
    bad[Json::json_pointer(pointer)] = value;
    write("bad.json", bad.dump());
    const Outcome o = run({"run", "--continue", "bad.json", "--quiet"});
    EXPECT_EQ(o.status, 2) << pointer;
    EXPECT_THAT(o.err, AllOf(HasSubstr("bad.json: "), HasSubstr(why))) << pointer;
    EXPECT_THAT(o.err, Not(HasSubstr("json.exception")));
  };
  refused("/final", Json::array(), "final: expected an object, got []");
  refused("/final/velocity/1", "a", "final.velocity[1]: expected a number, got \"a\"");
  refused("/final/velocity", 5, "final.velocity: expected a list, got 5");
  refused("/parameters", 5, "parameters: expected an object, got 5");
  refused("/parameters/inertia", "a", "parameters.inertia: expected a number, got \"a\"");
  refused("/time", nullptr, "time: expected a number, got null");
  refused("/system", 7, "system: expected a text, got 7");
  refused("/step", {{"a", 1}}, "step: '{\"a\":1}' is not a number");
  refused("/inputs", {{"a", {{"t", {0, 1}}}}}, "inputs.a.value is missing");
  for (const auto& [number, why] : {std::pair{"-1.0e-400", "the number -1.0e-400 is too small"},
                                    {"1e400", "number overflow parsing '1e400'"}}) {
    std::string text = good.dump();
    const size_t place = text.find("\"velocity\":[", text.find("\"final\"")) + 12;
    text.insert(place, number + std::string(","));
    write("bad.json", text);
    const Outcome o = run({"run", "--continue", "bad.json", "--quiet"});
    EXPECT_EQ(o.status, 2) << number;
    EXPECT_THAT(o.err, HasSubstr(why)) << number;
  }
}

}  // namespace
