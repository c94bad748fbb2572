// hamel report of recordings by a program with a system, a group, a retraction and a scheme of its
// own: the page has everything that the file has, and its notes name what it lacks.
#include <algorithm>

#include <hamel/hamel.hpp>

#include "program.hpp"

namespace {

using namespace hamel::test;
using nlohmann::json;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;

struct Sledge {  // v2 = 0 at the runner
  using Group = hamel::SE2;
  double mass = 2;  // kg
  static std::string name() { return "my_sledge"; }
  hamel::Mat<3, 3> inertia() const { return hamel::Vec<3>(0.5, mass, mass).asDiagonal(); }
  hamel::Mat<1, 3> constraints() const { return {0, 0, 1}; }
  void fields(auto& f) { f("mass", mass, "kg"); }
};

struct Impostor : Sledge {  // on another group than the library's of this name
  static std::string name() { return "suslov"; }
};

struct MyExp;
struct Heisenberg : hamel::GroupDefaults<Heisenberg, 3> {
  using V = hamel::Vec<3>;
  using M = hamel::Mat<3, 3>;
  template <class T>
  using Element = hamel::VecT<T, 3>;
  using Retractions = hamel::TypeList<MyExp>;
  static std::string name() { return "my_heisenberg"; }
  template <class T = double>
  static Element<T> identity() {
    return Element<T>::Zero();
  }
  static std::vector<std::string> columns() { return {"x", "y", "z"}; }
  static std::vector<std::string> units() { return {"m", "m", "m^2"}; }
  static std::vector<hamel::Component> components() {
    return {{"u", "m/s"}, {"v", "m/s"}, {"w", "m^2/s"}};
  }
  static V compose(const V& g, const V& h) { return g + h + 0.5 * ad(g) * h; }
  static V inverse(const V& g) { return -g; }
  static M ad(const V& xi) { return M{{0, 0, 0}, {0, 0, 0}, {-xi[1], xi[0], 0}}; }
  static M Ad(const V& g) { return M::Identity() + ad(g); }
};
struct MyExp : hamel::RetractionDefaults<MyExp, Heisenberg> {
  using V = hamel::Vec<3>;
  using M = hamel::Mat<3, 3>;
  static constexpr bool symmetric = true, one_parameter = true;
  static std::string name() { return "my_exp"; }
  static V tau(const V& xi) { return xi; }
  static V tau_inverse(const V& g) { return g; }
  static M dtau_right_inverse(const V& xi) { return M::Identity() - 0.5 * Heisenberg::ad(xi); }
  static M dtau_right_inverse_transpose_derivative(const V& /*xi*/, const V& p) {
    return -0.5 * Heisenberg::coad(p);
  }
};
struct Particle {
  using Group = Heisenberg;
  static std::string name() { return "my_particle"; }
  hamel::Mat<3, 3> inertia() const { return hamel::Mat<3, 3>::Identity(); }
  hamel::Mat<1, 3> constraints() const { return {0, 0, 1}; }
};

// lift by another name: `hamel` has none of it.
struct MyLift : hamel::Lift {
  static std::string name() { return "my_lift"; }
};

constexpr double kOnPage = 1e-6;  // numbers of about 1 have seven digits there

class RecordedOwn : public CommandLine {
 protected:
  json page_of_recording(const std::string& name = "x.h5") {
    return page_by({"report", name, "-o", "page.html"});
  }
  static std::vector<std::string> titles(const json& page) {
    std::vector<std::string> out;
    for (const json& section : page["sections"])
      for (const json& block : section["blocks"])
        if (block.contains("title")) out.push_back(block["title"]);
    return out;
  }
  static std::string notes(const json& page) { return page["sections"][0].dump(); }
  // Runs and records; the numbers of the page are those of the run.
  hamel::Result recorded(hamel::Simulation simulation, const std::string& name = "x.h5") {
    hamel::Result result = simulation.step(0.01).until(3).run();
    EXPECT_TRUE(result) << result.report();
    result.write(file(name));
    return result;
  }
};

TEST_F(RecordedOwn, SystemOnAGroupOfTheLibrary) {
  const auto result = recorded(hamel::simulate(Sledge{}).start({.velocity = {0.7, 1, 0}}));
  const json page = page_of_recording();
  if (page.is_null()) HAMEL_SKIP_WITHOUT("page");
  EXPECT_THAT(std::string(page["title"]), HasSubstr("my_sledge"));
  EXPECT_THAT(notes(page), AllOf(HasSubstr("the system 'my_sledge' is none of this program"),
                                 HasSubstr("energy error at most"), Not(HasSubstr("null"))));
  EXPECT_THAT(titles(page), IsSupersetOf({"Path in the plane", "Angular velocity", "Velocity",
                                          "Reaction forces", "Energy error"}));
  EXPECT_THAT(titles(page), Not(Contains("Motion"))) << "its bodies are drawn by its program";
  const json omega = figure_of(page, "Angular velocity")["series"][0];
  EXPECT_EQ(omega["name"], "omega [rad/s]");
  EXPECT_NEAR(omega["y"].back(), result.trajectory.column("omega").back(), kOnPage);
  const json path = figure_of(page, "Path in the plane")["series"][0];
  EXPECT_NEAR(path["x"].back(), result.trajectory.column("x").back(), kOnPage);
}

TEST_F(RecordedOwn, GroupWithItsRetraction) {
  hamel::add_group<Heisenberg>(hamel::registry());
  const auto result =
      recorded(hamel::simulate(Particle{}).start({.velocity = {0.3, 0.4, 0}}).retraction("my_exp"));
  const json page = page_of_recording();
  if (page.is_null()) HAMEL_SKIP_WITHOUT("page");
  EXPECT_THAT(std::string(page["title"]), HasSubstr("my_exp"));
  EXPECT_THAT(titles(page), IsSupersetOf({"Path in the plane", "Velocity", "Reaction forces"}));
  EXPECT_EQ(figure_of(page, "Velocity")["series"].size(), 2u) << "u and v have one unit";
  EXPECT_NEAR(figure_of(page, "Path in the plane")["series"][0]["y"].back(),
              result.trajectory.column("y").back(), kOnPage);
}

TEST_F(RecordedOwn, SchemeOnASystemOfTheLibrary) {
  hamel::add_scheme<MyLift>(hamel::registry());
  recorded(hamel::simulate("chaplygin_sleigh").scheme("my_lift"));
  const json page = page_of_recording();
  if (page.is_null()) HAMEL_SKIP_WITHOUT("page");
  EXPECT_THAT(std::string(page["title"]), HasSubstr("my_lift"));
  EXPECT_THAT(titles(page), Contains("Motion")) << "nothing is lacking";
  EXPECT_THAT(notes(page), Not(HasSubstr("none of this program")));
  // All else is the page of lift.
  recorded(hamel::simulate("chaplygin_sleigh").scheme("lift"), "lift.h5");
  EXPECT_EQ(titles(page_of_recording("lift.h5")), titles(page));
}

TEST_F(RecordedOwn, AnotherSystemOfANameOfTheLibrary) {
  recorded(hamel::simulate(Impostor{}).start({.velocity = {0.7, 1, 0}}));
  const json page = page_of_recording();
  if (page.is_null()) HAMEL_SKIP_WITHOUT("page");
  EXPECT_THAT(notes(page), HasSubstr("the system 'suslov' of this program is another"));
  EXPECT_THAT(titles(page), Contains("Path in the plane"));
}

TEST_F(RecordedOwn, BesideARunOfTheLibrary) {
  recorded(hamel::simulate(Sledge{}).start({.velocity = {0.7, 1, 0}}));
  recorded(hamel::simulate("chaplygin_sleigh"), "y.h5");
  const json page = page_by({"report", "x.h5", "y.h5", "-o", "page.html"});
  if (page.is_null()) HAMEL_SKIP_WITHOUT("page");
  EXPECT_EQ(page["subtitle"], "of my_sledge, chaplygin_sleigh");
  EXPECT_THAT(page.dump(), HasSubstr("is none of this program"));
  EXPECT_EQ(figure_of(page, "omega")["series"].size(), 2u);
}

}  // namespace
