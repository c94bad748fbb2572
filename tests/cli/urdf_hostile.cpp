// Robot descriptions from anywhere: texts that are built to take time or the stack, mountings and
// names of published robots, and numbers with round-off.
#include <cmath>
#include <functional>
#include <random>

#include "program.hpp"

namespace {

using namespace hamel::test;
using nlohmann::json;
using testing::HasSubstr;

std::string repeated(const std::string& word, size_t count) {
  std::string out;
  for (size_t i = 0; i < count; ++i) out += word;
  return out;
}

class HostileUrdf : public CommandLine {
 protected:
  static std::string inertial(const std::string& moments = "0.1 0 0 0.1 0 0.1") {
    const auto m = split(moments, ' ');
    return "<inertial><mass value=\"1\"/><inertia ixx=\"" + m[0] + "\" ixy=\"" + m[1] +
           "\" ixz=\"" + m[2] + "\" iyy=\"" + m[3] + "\" iyz=\"" + m[4] + "\" izz=\"" + m[5] +
           "\"/></inertial>";
  }
  static std::string link(const std::string& name, const std::string& inside = inertial()) {
    return "<link name=\"" + name + "\">" + inside + "</link>";
  }
  static std::string joint(const std::string& kind, const std::string& name,
                           const std::string& parent, const std::string& child) {
    return "<joint name=\"" + name + "\" type=\"" + kind + "\"><origin xyz=\"0 0 0.4\"/><parent " +
           "link=\"" + parent + "\"/><child link=\"" + child + "\"/><axis xyz=\"0 1 0\"/></joint>";
  }
  std::string robot(const std::string& inside) const {
    return write("robot.urdf", "<robot name=\"r\">" + inside + "</robot>");
  }
  /// Runs, and so does the TOML that is written of it.
  json runs(const std::string& path, const std::string& root = "planar") const {
    const std::string name = root.empty() ? path : path + "?root=" + root;
    const Outcome o = run({"run", name, "--until", "0.01", "--quiet"}, "timeout 20 ");
    EXPECT_EQ(o.status, 0) << o.err;
    const Outcome toml = run({"describe", "--toml", name});
    EXPECT_EQ(toml.status, 0) << toml.err;
    const std::string written = write("written.toml", toml.out);
    EXPECT_EQ(run({"run", written, "--until", "0.01", "--quiet"}).status, 0) << toml.out;
    return answer({"describe", name});
  }
};

/// Half a megabyte each. TinyXML takes a stack frame a level and time of the square of the
/// attributes; what only looks closed, or never closes, counts as what it is.
TEST_F(HostileUrdf, TextsThatTakeTime) {
  std::string attributes = "<link name=\"b\"";
  for (int i = 0; i < 40'000; ++i) attributes += " a" + std::to_string(i) + "=\"\"";
  const std::string nested = "<a b=\"/>\">";
  for (const auto& [text, message] : std::vector<std::pair<std::string, std::string>>{
           {repeated(nested, 50'000), "nested more than 64 deep"},
           {repeated(nested, 25'000) + repeated("</a>", 25'000), "nested more than 64 deep"},
           {repeated("x" + nested, 25'000), "nested more than 64 deep"},
           {repeated("<a b='\"/>'>", 50'000), "nested more than 64 deep"},
           {repeated("<a><!--</a>-->", 40'000), "nested more than 64 deep"},
           {repeated("<a><![CDATA[</a>]]>", 30'000), "nested more than 64 deep"},
           {attributes + "/>", "<link> has more than 64 attributes"},
           {repeated("<", 500'000), "expected a name behind '<'"},
           {repeated("<a ", 160'000), "<a>: expected name=\"value\", > or />"},
           {repeated("<!--", 120'000), "a comment without its -->"},
           {"<!-->", "a comment without its -->"},
           {repeated("<a b=", 100'000), "<a b>: expected a value in quotes"},
           {"<a b=\"" + repeated("x", 500'000), "a value without its \""},
           {repeated("</a>", 120'000), "</a>, expected </robot>"},
           {repeated("<link name=\"a\"/>", 30'000), "more than 5000 links"},
           {std::string("<link\0", 6) + "name=\"a\"/>", "a zero byte"}}) {
    for (const char* verb : {"describe", "run"}) {
      const Outcome o = run({verb, robot(text)}, "timeout 20 ");
      EXPECT_EQ(o.status, 2) << text.substr(0, 40);
      EXPECT_THAT(o.err, HasSubstr(message)) << text.substr(0, 40);
      EXPECT_THAT(o.err, HasSubstr("robot.urdf:1: not a robot as URDF has it"));
    }
  }
  // Many parts are no mistake: shapes, and links that are welded.
  std::string many = link("l0");
  for (int i = 1; i < 2000; ++i) {
    const std::string name = "l" + std::to_string(i);
    many += link(name) + joint("fixed", "j" + name, "l" + std::to_string(i - 1), name);
  }
  EXPECT_EQ(run({"describe", robot(many)}, "timeout 20 ").status, 0);
  const std::string shape = "<visual><geometry><sphere radius=\"1\"/></geometry></visual>";
  EXPECT_EQ(run({"describe", robot(link("l0", inertial() + repeated(shape, 8000)))}, "timeout 20 ")
                .status,
            0);
}

/// Texts at random, of what XML is made of: read or refused, at once.
TEST_F(HostileUrdf, TextsAtRandom) {
  std::mt19937 random(12);
  const std::vector<std::string> pieces = {"<a>",
                                           "</a>",
                                           "<a b=\"/>\">",
                                           "<a b='>'/>",
                                           "<!--",
                                           "-->",
                                           "<![CDATA[",
                                           "]]>",
                                           "<?",
                                           "?>",
                                           "<!",
                                           ">",
                                           "\"",
                                           "'",
                                           "=",
                                           "/",
                                           "<",
                                           "x",
                                           "&#x",
                                           ";",
                                           "\n",
                                           link("l"),
                                           "<joint name=\"j\" type=\"fixed\">",
                                           "<parent link=\"l\"/>",
                                           "</joint>"};
  for (int k = 0; k < 80; ++k) {
    std::string text = "<robot name=\"r\">";
    const size_t count = random() % 3 == 0 ? 20'000 : 30, kinds = 1 + random() % 4;
    std::vector<std::string> some;
    for (size_t i = 0; i < kinds; ++i) some.push_back(pieces[random() % pieces.size()]);
    for (size_t i = 0; i < count; ++i) text += some[random() % kinds];
    const Outcome o = run({"describe", write("robot.urdf", text + "</robot>")}, "timeout 20 ");
    EXPECT_TRUE(o.status == 0 || o.status == 2) << o.status << text.substr(0, 200);
  }
}

/// A link `world` with a fixed joint to the arm, the mounting of UR, xArm and Z1: a frame of the
/// arm's there is the ground too, and the arm's first body is welded to it.
TEST_F(HostileUrdf, MountedOnTheWorld) {
  const std::string arm = link("base") + joint("fixed", "mount", "world", "base") + link("upper") +
                          joint("continuous", "shoulder", "base", "upper");
  const json d = runs(robot("<link name=\"world\"/>" + arm), "");
  EXPECT_EQ(d["group"], "so2");
  EXPECT_EQ(d["inputs"][0]["name"], "shoulder.torque");
  // Frames between, and one that hangs beside.
  const std::string frames = "<link name=\"world\"/><link name=\"table\"/>" +
                             joint("fixed", "stand", "world", "table") + link("base") +
                             joint("fixed", "mount", "table", "base") + link("upper") +
                             joint("continuous", "shoulder", "base", "upper") +
                             "<link name=\"tool\"/>" + joint("fixed", "flange", "upper", "tool");
  EXPECT_EQ(runs(robot(frames), "")["group"], "so2");
  EXPECT_EQ(runs(robot("<link name=\"world\"/><link name=\"eye\"/>" +
                       joint("fixed", "camera", "world", "eye") + link("arm") +
                       joint("continuous", "hinge", "eye", "arm")),
                 "")["group"],
            "so2");
}

/// The ground has its own name, and a link of it another one.
TEST_F(HostileUrdf, ALinkNamedGround) {
  const std::string arm = link("ground_") + joint("continuous", "hinge", "ground", "ground_");
  const json fixed = runs(robot(link("ground") + arm), "fixed");
  EXPECT_EQ(fixed["group"], "so2");
  EXPECT_EQ(fixed["parts"], json({"ground__", "ground_"}));
  EXPECT_EQ(runs(robot(link("ground") + arm), "free")["group"], "se3*so2");
  const Outcome o = run({"run", robot(link("ground") + arm), "--until", "0.01"});
  EXPECT_THAT(o.out + o.err, HasSubstr("goes by another name"));
  EXPECT_EQ(runs(robot("<link name=\"world\"/>" + link("ground") +
                       joint("continuous", "turn", "world", "ground")),
                 "")["group"],
            "so2");
}

/// Moments that are zero but for round-off, of a body that has mass: those of iCub are -1e-20.
TEST_F(HostileUrdf, MomentsOfRoundOff) {
  for (const std::string moments : {"-5.4e-20 0 0 -5.4e-20 0 0", "0 0 1.4e-20 0 0 0",
                                    "1e-17 0 0 -2e-17 1e-17 0", "0.1 0 0 -1e-15 0 0.1"}) {
    const std::string path =
        robot(link("base") +
              link("foot", "<inertial><origin xyz=\"0.2 0 0\"/>" + inertial(moments).substr(10)) +
              joint("continuous", "ankle", "base", "foot"));
    EXPECT_EQ(runs(path, "fixed")["group"], "so2") << moments;
  }
  for (const std::string moments : {"-0.01 0 0 0.1 0 0.1", "-1e-9 0 0 -1e-9 0 0"}) {
    const Outcome o = run({"run", robot(link("base") + link("foot", inertial(moments)) +
                                        joint("continuous", "ankle", "base", "foot"))});
    EXPECT_EQ(o.status, 2) << moments;
    EXPECT_THAT(o.err, HasSubstr("about some axis, expected none below 0")) << moments;
  }
}

/// Every TAB of the shell describes: no motion is followed. An analysis follows motions, each up to
/// a limit of steps, which a note states.
TEST_F(HostileUrdf, DescribesWithoutAMotion) {
  std::string chain = link("l0");
  for (int i = 1; i < 36; ++i) {
    const std::string name = "l" + std::to_string(i);
    chain += link(name) + joint("continuous", "j" + name, "l" + std::to_string(i - 1), name);
  }
  const Outcome o = run({"describe", robot(chain) + "?root=free"}, "timeout 20 ");
  EXPECT_EQ(o.status, 0) << o.err;
  EXPECT_EQ(o.out.find("verdict"), std::string::npos);
  const Outcome free = run({"describe", "bicycle"});
  EXPECT_EQ(free.out.find("verdict"), std::string::npos);
  // x'' = 1e9 sin(1e9 x): steps of 1e-10 s.
  const std::string stiff = write("stiff.toml",
                                  "group = \"r2\"\ninertia = [1, 1]\nconstraints = [[0, \"1\"]]\n"
                                  "force = [\"-1e9*sin(1e9*x1)\", 0]\nconfiguration = [0.3, 0]\n"
                                  "velocity = [1, 0]\n");
  const Outcome a = run({"describe", "--analyse", stiff}, "timeout 60 ");
  EXPECT_EQ(a.status, 0) << a.err;
  EXPECT_THAT(a.out, HasSubstr("ended after 10000 steps"));
}

/// Trees of links at random: the world or not, frames, links named ground, fixed joints: as many
/// freedoms as joints that move, and the TOML is read.
TEST_F(HostileUrdf, TreesAtRandom) {
  std::mt19937 random(3);
  for (int k = 0; k < 40; ++k) {
    const size_t count = 2 + random() % 7;
    const bool world = random() % 2 == 0;
    std::string text;
    std::vector<std::string> names;
    int moving = 0;
    std::string list;
    for (size_t i = 0; i < count; ++i) {
      std::string name = "l" + std::to_string(i);
      if (i == 0 && world) name = "world";
      else if (random() % 8 == 0 && list.find("ground,") == std::string::npos) name = "ground";
      else if (random() % 8 == 0) name = "l shape " + std::to_string(i);
      list += name + ",";
      names.push_back(name);
      // A frame may be welded; what moves has a mass of its own.
      const bool hinge = i > 0 && random() % 2 == 0;
      const bool frame = (i == 0 && world) || (i > 0 && !hinge && random() % 2 == 0);
      text += frame ? "<link name=\"" + name + "\"/>" : link(name);
      if (i == 0) continue;
      const std::string parent = names[random() % i];
      text += joint(hinge ? "continuous" : "fixed", "j" + std::to_string(i), parent, name);
      moving += hinge ? 1 : 0;
    }
    if (moving == 0) continue;
    const json d = runs(robot(text), world ? "" : "fixed");
    EXPECT_EQ(d["dimension"], moving) << text;
  }
}

}  // namespace
