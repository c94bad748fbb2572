// JSON of hamel steady: a motion with its eigenvalues and linearisation; a sweep with its
// crossings, ends and branches.
#include "words/steady_json.hpp"

#include <optional>

#include <hamel/framework/analysis/linearisation.hpp>
#include <hamel/framework/run/names/registry.hpp>

namespace hamel::tools {
namespace {

using Json = nlohmann::ordered_json;

// To the digits that are known.
Json eigenvalues_of(const SteadyMotion& motion) {
  Json out = Json::array();
  for (size_t i = 0; i < motion.eigenvalues.size(); ++i) {
    const auto x = motion.eigenvalues[i];
    out.push_back({round_to_known(x.real(), motion.round_off[i]),
                   round_to_known(x.imag(), motion.round_off[i])});
  }
  return out;
}

// Null where an error covers the verdict.
Json growing_of(const SteadyMotion& motion) {
  const std::optional<int> growing = motion.decided_growing();
  return growing ? Json(*growing) : Json();
}

// Parts of the mode of each eigenvalue, velocities first.
Json modes_of(const SteadyMotion& motion) {
  Json out = Json::array();
  for (const std::vector<ModePart>& mode : motion.modes) {
    Json& parts = out.emplace_back(Json::object());
    for (const ModePart& part : mode) parts[part.name] = part.size;
  }
  return out;
}

Json json_of(const SteadyPlace& place) {
  return {{"value", place.value}, {"element", place.element}, {"velocity", place.velocity}};
}

Json json_of(const NumberMatrix& m) {
  Json out = Json::array();
  for (int i = 0; i < m.rows; ++i) {
    Json row = Json::array();
    for (int j = 0; j < m.columns; ++j) row.push_back(m(i, j));
    out.push_back(row);
  }
  return out;
}

Json json_of(const Linearisation& linear, const std::optional<double>& sample_time) {
  Json out = {{"states", linear.states},
              {"inputs", linear.inputs},
              {"quantities", linear.quantities},
              {"A", json_of(linear.a)},
              {"B", json_of(linear.b)},
              {"C", json_of(linear.c)},
              {"errors",
               {{"A", json_of(linear.a_error)},
                {"B", json_of(linear.b_error)},
                {"C", json_of(linear.c_error)}}},
              {"values", linear.values},
              {"embedding", json_of(linear.embedding)},
              {"unused_inputs", linear.unused}};
  if (sample_time) {
    const DiscretePair pair = linear.sampled(*sample_time);
    out["discrete"] = {
        {"sample_time", *sample_time}, {"A", json_of(pair.a)}, {"B", json_of(pair.b)}};
  }
  return out;
}

Json json_of(const SteadySweep& sweep) {
  Json out = {{"vary", Json::array()}, {"crossings", Json::array()}};
  for (size_t i = 0; i < sweep.values.size(); ++i) {
    const SteadyMotion& motion = sweep.motions[i];
    Json& entry = out["vary"].emplace_back(Json{{"value", sweep.values[i]},
                                                {"found", motion.found},
                                                {"eigenvalues", eigenvalues_of(motion)},
                                                {"eigenvalue_errors", motion.round_off},
                                                {"round_off", motion.round_off},
                                                {"growing", growing_of(motion)}});
    if (motion.found)
      entry["motion"] = {{"element", motion.element}, {"velocity", motion.velocity}};
  }
  for (const SteadyCrossing& crossing : sweep.crossings) {
    out["crossings"].push_back(
        {{"value", round_to_known(crossing.value, crossing.round_off)},
         {"round_off", crossing.round_off},
         {"kind", crossing.pair ? "pair" : "real"},
         {"bifurcation", name_of(crossing.kind)},
         {"supercritical", crossing.supercritical ? Json(*crossing.supercritical) : Json()},
         {"other", crossing.other ? json_of(*crossing.other) : Json()}});
  }
  out["ends"] = Json::array();
  for (const SteadyEnd& end : sweep.ends) {
    out["ends"].push_back({{"value", round_to_known(end.value, end.round_off)},
                           {"round_off", end.round_off},
                           {"towards", end.towards_last ? "last" : "first"},
                           {"bifurcation", name_of(end.kind)},
                           {"other", end.other ? json_of(*end.other) : Json()}});
  }
  out["end"] = sweep.ends.empty() ? Json() : out["ends"][0];
  return out;
}

}  // namespace

Json steady_json(const SteadyOptions& options, const Simulation& first, const SystemModel& system,
                 const SteadyMotion& motion, const SteadySweep* sweep) {
  Json out = {{"system", options.config.system},
              {"parameters", Json::object()},
              {"motion", {{"element", motion.element}, {"velocity", motion.velocity}}},
              {"residual", motion.residual},
              {"eigenvalues", eigenvalues_of(motion)},
              {"eigenvalue_errors", motion.round_off},
              {"round_off", motion.round_off},
              {"growing", growing_of(motion)},
              {"modes", modes_of(motion)},
              {"neutral", motion.neutral}};
  for (const Field& field : system.fields) out["parameters"][field.name] = field.value;
  if (motion.found && sweep == nullptr)
    out["linearisation"] = json_of(linearisation(registry(), first), options.sample_time);
  if (sweep != nullptr) {
    out.update(json_of(*sweep));
    if (options.branches) out["branches"] = Json::array();
    for (const SteadySweep& branch : sweep->branches) {
      Json& entry = out["branches"].emplace_back(json_of(branch));
      entry["start"] = json_of(*branch.start);
    }
  }
  return out;
}

}  // namespace hamel::tools
