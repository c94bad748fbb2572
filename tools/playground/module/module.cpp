// The library for a page, as functions of C: texts of JSON in and out, numbers as addresses.
#include <emscripten.h>
#include <cmath>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include <hamel/framework/figures/figures.hpp>
#include <hamel/framework/figures/json.hpp>
#include <hamel/framework/io/version.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/pages/run_verdict.hpp>
#include <hamel/systems/by_name.hpp>

#include "description.hpp"
#include "request.hpp"

namespace hamel::playground {
namespace {

// Rows that a run keeps; longer ones are thinned.
constexpr size_t kRows = 20000;

Result result;
std::vector<figures::Figure> drawn;  // of the result, but for its motion
std::vector<double> motion;          // times; poses of each body; each force

// The block of an animation without its numbers, which go to `motion`: of each time t, of each body
// x y z qw qx qy qz, of each force where it acts and the force.
Json take_motion(figures::Figure figure) {
  auto& animation = std::get<figures::Animation>(figure.drawing);
  motion = animation.times;
  for (figures::MovingBody& body : animation.bodies) {
    for (const auto& [x, q] : body.poses)
      motion.insert(motion.end(), {x[0], x[1], x[2], q[0], q[1], q[2], q[3]});
    body.poses.clear();
  }
  for (figures::MovingForce& force : animation.forces) {
    for (const auto& value : force.values) motion.insert(motion.end(), value.begin(), value.end());
    force.values.clear();
  }
  const size_t times = animation.times.size();
  animation.times.clear();
  Json out = figures::json_of(figure);
  out["times"] = times;
  return out;
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json run(const Json& request) {
  result = simulation_of(request).keep_rows(kRows).run();
  drawn = figures::of_run(registry(), result);
  Json out = {{"ok", true},
              {"system", description_of(*result.system)},
              {"method", result.method()},
              {"steps_in_words", result.steps_in_words()},
              {"failure", result.status.ok ? "" : result.status.reason},
              {"time", result.last.time},
              {"steps", result.steps},
              {"seconds", number(result.seconds)},
              {"notes", result.notes},
              {"columns", result.trajectory.columns()},
              {"rows", result.trajectory.rows()},
              {"motion", nullptr}};
  Config::fields([&](const Option& option, auto) {  // as it was run
    out["options"][option.name] = result.config.text(option.name);
  });
  const pages::RunVerdict verdict = pages::run_verdict(result);
  out["verdict"] = {{"kind", "verdict"}, {"status", verdict.status}, {"text", verdict.text}};
  for (size_t i = 0; i < drawn.size(); ++i) {
    if (!std::holds_alternative<figures::Animation>(drawn[i].drawing)) continue;
    out["motion"] = take_motion(std::move(drawn[i]));
    drawn.erase(drawn.begin() + static_cast<std::ptrdiff_t>(i));
    break;
  }
  return out;
}

// The figures beside the motion, as sections of a report page.
Json sections() {
  Json out = Json::array();
  for (const figures::Figure& figure : drawn) {
    if (out.empty() || out.back()["title"] != figure.section)
      out.push_back({{"title", figure.section}, {"blocks", Json::array()}});
    out.back()["blocks"].push_back(figures::json_of(figure));
  }
  return out;
}

}  // namespace
}  // namespace hamel::playground

extern "C" {

/// {version, git, systems, options}.
EMSCRIPTEN_KEEPALIVE const char* hamel_catalogue() {
  using namespace hamel::playground;
  return answer("null", [](const Json&) {
    return Json{{"ok", true},
                {"version", hamel::version()},
                {"git", hamel::git_hash()},
                {"systems", list_of_systems()},
                {"options", list_of_options()}};
  });
}

/// {text} of a registered system, {"name"}.
EMSCRIPTEN_KEEPALIVE const char* hamel_text(const char* request) {
  using namespace hamel::playground;
  return answer(request, [](const Json& of) {
    return Json{{"ok", true}, {"text", text_of_system(of.at("name"))}};
  });
}

/// A run to its end: its verdict, its notes, its system, its motion without the numbers.
EMSCRIPTEN_KEEPALIVE const char* hamel_run(const char* request) {
  return hamel::playground::answer(request, hamel::playground::run);
}

/// The numbers of its motion, hamel_motion_size() of them.
EMSCRIPTEN_KEEPALIVE const double* hamel_motion() { return hamel::playground::motion.data(); }
EMSCRIPTEN_KEEPALIVE size_t hamel_motion_size() { return hamel::playground::motion.size(); }

/// {sections} of the figures of the last run.
EMSCRIPTEN_KEEPALIVE const char* hamel_figures() {
  using namespace hamel::playground;
  return answer("null", [](const Json&) { return Json{{"ok", true}, {"sections", sections()}}; });
}

/// Its rows, one after the other.
EMSCRIPTEN_KEEPALIVE const double* hamel_rows() {
  return hamel::playground::result.trajectory.values().data();
}

/// Its record as JSON.
EMSCRIPTEN_KEEPALIVE const char* hamel_record() {
  using namespace hamel::playground;
  return answer("null", [](const Json&) { return Json::parse(result.record()); });
}
}
