// Equations of motion as text: C that is compiled gives the rates of the equations, for all systems
// that have formulas; LaTeX is balanced.
#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <vector>

#include <hamel/framework/analysis/equations.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/systems/simulate.hpp>

namespace {

using hamel::Equations;
using hamel::Simulation;
using testing::HasSubstr;

// Systems without recorded formulas, and why.
const std::map<std::string, std::string> kRefused = {
    {"roller_racer", "its formulas are a type in C++"},
};

std::string example(const std::string& name) {
  const char* const root = std::getenv("HAMEL_SOURCE");
  return std::string(root == nullptr ? "." : root) + "/tests/examples/" + name + ".toml";
}

std::string refusal(const Equations& e, const std::string& notation = "c") {
  try {
    e.formulas(notation);
  } catch (const hamel::ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

// The functions of one system, compiled.
class CompiledEquations {
 public:
  explicit CompiledEquations(const Equations& e) {
    std::string name = e.name();
    for (char& c : name)
      if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    const std::string stem = (std::filesystem::temp_directory_path() /
                              ("hamel_equations_" + name + std::to_string(getpid())))
                                 .string();
    std::ofstream(stem + ".c") << e.formulas("c");
    const std::string command =
        "cc -std=c99 -pedantic -Wall -Wextra -Werror -O1 -ffp-contract=off -shared -fPIC -o '" +
        stem + ".so' '" + stem + ".c' -lm";
    EXPECT_EQ(std::system(command.c_str()), 0) << command;
    handle_ = dlopen((stem + ".so").c_str(), RTLD_NOW | RTLD_LOCAL);
    if (handle_ == nullptr) return;
    rate_ = reinterpret_cast<Rate*>(dlsym(handle_, (name + "_rate").c_str()));
    coordinate_rates_ =
        reinterpret_cast<CoordinateRates*>(dlsym(handle_, (name + "_coordinate_rates").c_str()));
    std::filesystem::remove(stem + ".c");
    std::filesystem::remove(stem + ".so");
  }
  ~CompiledEquations() {
    if (handle_ != nullptr) dlclose(handle_);
  }
  CompiledEquations(const CompiledEquations&) = delete;
  CompiledEquations& operator=(const CompiledEquations&) = delete;
  bool ready() const { return rate_ != nullptr && coordinate_rates_ != nullptr; }

  std::vector<double> rate(double t, const hamel::Snapshot& at,
                           const std::vector<double>& u) const {
    std::vector<double> out(at.velocity.size());
    rate_(t, at.coordinates.data(), at.velocity.data(), u.data(), out.data());
    return out;
  }
  std::vector<double> coordinate_rates(const hamel::Snapshot& at) const {
    std::vector<double> out(at.coordinates.size());
    coordinate_rates_(at.coordinates.data(), at.velocity.data(), out.data());
    return out;
  }

 private:
  using Rate = void(double, const double*, const double*, const double*, double*);
  using CoordinateRates = void(const double*, const double*, double*);
  void* handle_ = nullptr;
  Rate* rate_ = nullptr;
  CoordinateRates* coordinate_rates_ = nullptr;
};

double largest(const std::vector<double>& x) {
  double out = 0;
  for (const double one : x) out = std::max(out, std::abs(one));
  return out;
}

// Rates of the text at states along a motion, with every input held at another value.
void expect_rates_of(Simulation simulation) {
  std::vector<double> u;
  const hamel::Run described = simulation.build();
  for (const hamel::InputField& input : described.system().inputs) {
    u.push_back(0.05 * static_cast<double>(u.size() + 1));
    simulation.input(input.name, u.back());
  }
  const Equations e(simulation);
  const CompiledEquations compiled(e);
  ASSERT_TRUE(compiled.ready());
  hamel::Run run =
      Simulation(simulation).scheme("dop853").tolerance({.relative = 1e-12}).until(0.5).build();
  for (const double t : {0.0, 0.07, 0.2, 0.5}) {
    ASSERT_TRUE(run.advance_to(t).ok);
    const hamel::Snapshot at = run.state();
    const std::vector<double> expected =
        e.rate(t, {.configuration = at.coordinates, .velocity = at.velocity});
    const std::vector<double> got = compiled.rate(t, at, u);
    for (size_t i = 0; i < got.size(); ++i)
      EXPECT_NEAR(got[i], expected[i], 1e-12 * (1 + largest(expected)))
          << e.velocities()[i] << "' at t = " << t;
  }
  // q' along the motion, by differences.
  constexpr double h = 1e-4;
  ASSERT_TRUE(run.advance_to(0.5).ok);
  const hamel::Snapshot end = run.state(), before = run.at(0.5 - h), last = run.at(0.5 - 2 * h);
  const std::vector<double> q_rate = compiled.coordinate_rates(before);
  for (size_t i = 0; i < q_rate.size(); ++i)
    EXPECT_NEAR((end.coordinates[i] - last.coordinates[i]) / (2 * h), q_rate[i],
                1e-5 * (1 + largest(q_rate)))
        << e.columns()[i];
}

TEST(EquationsText, COfAllSystemsGivesTheirRates) {
  int systems = 0;
  for (const std::string& name : hamel::systems()) {
    SCOPED_TRACE(name);
    const auto refused = kRefused.find(name);
    if (refused != kRefused.end()) {
      EXPECT_THAT(refusal(Equations(hamel::simulate(name))), HasSubstr(refused->second));
      continue;
    }
    expect_rates_of(hamel::simulate(name));
    ++systems;
  }
  EXPECT_GE(systems, 25);
}

TEST(EquationsText, OfFiles) {
  for (const char* file :
       {"ball_in_a_pipe", "cart_and_trailer", "contact_oscillator", "diff_drive", "lagging_sleigh",
        "particle_in_potential", "scooter_by_rows", "skate_in_a_bowl"}) {
    SCOPED_TRACE(file);
    expect_rates_of(hamel::simulate(example(file)));
  }
}

TEST(EquationsText, IsShortForASleigh) {
  const Equations e(hamel::simulate("chaplygin_sleigh"));
  EXPECT_THAT(e.formulas("latex"), HasSubstr("\\dot{v_{1}} &= 0.2 \\, \\omega^{2} \\\\\n"
                                             "v_{2} &= 0 \\\\\n"));
  EXPECT_THAT(e.formulas("numpy"), HasSubstr("    rate[1] = 0.2 * omega**2\n"));
  EXPECT_THAT(e.formulas("c"), HasSubstr("  rate[1] = 0.2 * omega * omega;\n"));
  EXPECT_THAT(e.formulas("sympy"), HasSubstr("    v1 * sympy.cos(theta),\n"));
}

TEST(EquationsText, LatexIsBalanced) {
  for (const std::string& name : hamel::systems()) {
    if (kRefused.contains(name)) continue;
    SCOPED_TRACE(name);
    const std::string text = Equations(hamel::simulate(name)).formulas("latex");
    const auto count = [&text](const std::string& part) {
      int out = 0;
      for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1))
        ++out;
      return out;
    };
    EXPECT_EQ(count("{"), count("}"));
    EXPECT_EQ(count("\\left"), count("\\right"));
    EXPECT_EQ(count("\\begin"), count("\\end"));
    EXPECT_EQ(text.find("nan"), std::string::npos);
    for (size_t from = 0, depth = 0; from < text.size(); ++from) {
      if (text[from] == '{') ++depth;
      if (text[from] == '}') {
        ASSERT_GT(depth--, 0u);
      }
    }
  }
}

// The sines of a steered wheel: sin^2 + cos^2 is 1, what cancels is left out.
TEST(EquationsText, LeavesOutWhatCancels) {
  for (const std::string& name : hamel::systems()) {
    if (kRefused.contains(name)) continue;
    SCOPED_TRACE(name);
    const std::string text = Equations(hamel::simulate(name)).formulas("latex");
    for (const char* part : {"\\frac{0}", "\\frac{0 ", " 0 \\,", "\\sqrt{1}"})
      EXPECT_EQ(text.find(part), std::string::npos) << part;
  }
  const std::string scooter = Equations(hamel::simulate("kick_scooter")).formulas("latex");
  EXPECT_THAT(scooter, testing::Not(HasSubstr("\\sqrt")));
  EXPECT_THAT(scooter, HasSubstr("k_{1} &= "));
}

TEST(EquationsText, RefusesWhatHasNoFormulas) {
  EXPECT_THAT(refusal(Equations(hamel::simulate("suslov")), "latx"),
              testing::AllOf(HasSubstr("'latx'"), HasSubstr("did you mean 'latex'")));
  const auto of = [](const char* file) {
    return refusal(Equations(hamel::simulate(example(file))));
  };
  EXPECT_THAT(of("ball_on_hills"), HasSubstr("the height of the ground"));
  EXPECT_THAT(of("relaxing_tyres"), HasSubstr("the force front tyre"));
  EXPECT_THAT(of("door_with_friction"), HasSubstr("which contacts and joints slide"));
}

}  // namespace
