// The JSON schemas of the six kinds of TOML files: every file of the repository fits its own, and
// each schema has the keys that the reader of its files accepts, no more and no fewer.
#include <filesystem>
#include <regex>
#include <set>

#include <gmock/gmock.h>
#include <toml++/toml.h>
#include <nlohmann/json.hpp>
#include <valijson/adapters/nlohmann_json_adapter.hpp>
#include <valijson/schema.hpp>
#include <valijson/schema_parser.hpp>
#include <valijson/validation_results.hpp>
#include <valijson/validator.hpp>

#include "program.hpp"

#include <hamel/framework/ensemble/ensemble.hpp>
#include <hamel/framework/inverse/motion_plan.hpp>
#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/framework/study/study.hpp>
#include <hamel/systems/mechanisms/contact.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace {

using nlohmann::json;
using testing::HasSubstr;

const std::vector<std::string> kKinds = {"run", "system", "study", "ensemble", "mechanism", "plan"};

std::filesystem::path root() {
  const char* source = std::getenv("HAMEL_SOURCE");
  EXPECT_NE(source, nullptr) << "set HAMEL_SOURCE to the source tree (ctest does)";
  return source == nullptr ? "." : source;
}

json schema(const std::string& kind) {
  const auto program = std::filesystem::path(std::getenv("HAMEL_PROGRAM"));
  return json::parse(hamel::test::contents(program.parent_path() / "schema" / (kind + ".json")));
}

json data_of(const std::string& toml_text) {
  std::ostringstream out;
  out << toml::json_formatter(toml::parse(toml_text));
  return json::parse(out.str());
}

// '' where the data fit, else what does not.
std::string misfit(const std::string& kind, const json& data) {
  const json description = schema(kind);
  valijson::Schema parsed;
  valijson::SchemaParser().populateSchema(valijson::adapters::NlohmannJsonAdapter(description),
                                          parsed);
  valijson::ValidationResults results;
  if (valijson::Validator().validate(parsed, valijson::adapters::NlohmannJsonAdapter(data),
                                     &results))
    return "";
  std::string out = "misfit";
  for (valijson::ValidationResults::Error error; results.popError(error);) {
    out += "\n ";
    for (const std::string& step : error.context) out += step;
    out += ": " + error.description;
  }
  return out;
}

std::string kind_of(const json& data) {
  if (data.contains("keep")) return "ensemble";
  if (data.contains("to")) return "plan";
  if (data.contains("system")) return data["system"].is_array() ? "study" : "run";
  return data.contains("body") ? "mechanism" : "system";
}

TEST(Schemas, EveryFileOfTheRepositoryFits) {
  std::set<std::string> seen;
  for (const char* folder : {"tests", "tools/studies", "systems"}) {
    for (const auto& entry : std::filesystem::recursive_directory_iterator(root() / folder)) {
      if (entry.path().extension() != ".toml") continue;
      const json data = data_of(hamel::test::contents(entry.path()));
      seen.insert(kind_of(data));
      EXPECT_EQ(misfit(kind_of(data), data), "") << entry.path();
    }
  }
  EXPECT_EQ(seen, std::set<std::string>(kKinds.begin(), kKinds.end()));
}

TEST(Schemas, ExamplesOfTheDocumentationFit) {
  int found = 0;
  for (const char* file :
       {"tools/README.md", "systems/README.md", "systems/mechanisms/README.md"}) {
    const std::string text = hamel::test::contents(root() / file);
    const std::string fence = "```toml\n";
    for (size_t at = text.find(fence); at != std::string::npos; at = text.find(fence, at + 1)) {
      const size_t begin = at + fence.size(), end = text.find("```", begin);
      const json data = data_of(text.substr(begin, end - begin));
      EXPECT_EQ(misfit(kind_of(data), data), "") << file << ": " << data;
      ++found;
    }
  }
  EXPECT_GE(found, 4);
}

// A text as a reader of its kind takes it.
auto reader(const std::string& kind, const std::string& text) {
  return [=] {
    using namespace hamel;
    if (kind == "run") Config::from_toml(text);
    else if (kind == "ensemble") parse_ensemble(text, "ensemble", registry());
    else if (kind == "plan") parse_plan(text, "plan");
    else if (kind == "study") parse_study(text, "study", registry());
    else data_system_maker(registry(), "file.toml", text)({});
  };
}

TEST(Schemas, RefuseWhatTheReadersRefuse) {
  const std::string root_body =
      "[[body]]\nname = 'a'\nmass = 1\nsphere = 1\n[[joint]]\nkind = 'planar'\nchild = 'a'\n";
  EXPECT_NO_THROW(reader("mechanism", root_body)());
  EXPECT_EQ(misfit("mechanism", data_of(root_body)), "");
  for (const auto& [kind, text] : std::vector<std::pair<std::string, std::string>>{
           {"run", "system = 'suslov'\nstep = 'small'"},
           {"run", "system = 'suslov'\nscheme = 'lfit'"},
           {"run", "system = 'suslov'\nshceme = 'lift'"},
           {"run", "system = 'suslov'\n[inputs]\nu = true"},
           {"system", "group = 'se2'"},
           {"system", "group = 'se2'\ninertia = [1, 2, true]"},
           {"system", "group = 'se2'\ninertia = [1, 2, 3]\n[parameters]\nm = { unit = 'kg' }"},
           {"study", "until = 1"},
           {"study", "mode = 'zippd'\n[[system]]\nname = 'suslov'"},
           {"study", "step = [true]\n[[system]]\nname = 'suslov'"},
           {"mechanism",
            "[[body]]\nname = 'a'\nmass = 1\nmas = 1\n[[joint]]\nkind='free'\nchild='a'"},
           {"mechanism", "[[body]]\nname = 'a'\nmass = 1\n[[joint]]\nkind='fere'\nchild='a'"},
           {"mechanism", root_body + "[parameters]\nm = '2*3'"},
           {"mechanism", root_body + "[parameters]\nm = { value = 1, least = '0' }"},
           {"mechanism", root_body + "[events]\ne = { value = 'x', direction = 2 }"},
           {"mechanism", root_body + "[[spring]]\nb = 'a'"},
           {"mechanism", root_body + "[[loop]]\na = 'a'"},
           {"mechanism", root_body + "[[force]]\nbody = 'a'"}}) {
    if (kind == "mechanism") {
      EXPECT_THROW(reader(kind, text)(), hamel::ConfigError) << text;
    }
    EXPECT_NE(misfit(kind, data_of(text)), "") << kind << ": " << text;
  }
}

// The keys that a reader offers in place of an unknown one, 'zzz'.
template <class Read>
std::set<std::string> keys_of(const Read& read) {
  std::string message;
  try {
    read();
    ADD_FAILURE() << "an unknown key is accepted";
  } catch (const hamel::ConfigError& error) {
    message = error.what();
  }
  std::smatch list;
  EXPECT_TRUE(std::regex_search(message, list, std::regex("'zzz': expected one of ([^;\n]*)")))
      << message;
  std::set<std::string> out;
  std::istringstream words(list.str(1));
  for (std::string word; std::getline(words, word, ',');)
    out.insert(word.substr(word.find_first_not_of(' ')));
  return out;
}
std::set<std::string> keys_of(const json& object) {
  std::set<std::string> out;
  EXPECT_EQ(object["additionalProperties"], json(false)) << object;
  for (const auto& [key, value] : object["properties"].items()) out.insert(key);
  return out;
}

TEST(Schemas, HaveTheKeysOfTheReaders) {
  const std::string system = "group = 'se2'\ninertia = [1, 1, 1]\n";
  const std::string body = "[[body]]\nname = 'a'\nmass = 1\n",
                    joint = "[[joint]]\nkind = 'free'\nchild = 'a'\n";
  // Kind, text with the unknown key, and the place of its table in the schema.
  std::vector<std::tuple<std::string, std::string, std::string>> cases = {
      {"run", "zzz = 1", ""},
      {"run", "[inputs]\nu = { zzz = 1 }", "/properties/inputs/additionalProperties/anyOf/2"},
      {"study", "zzz = 1", ""},
      {"study", "[[system]]\nzzz = 1", "/properties/system/items"},
      {"study", "[[exclude]]\nzzz = 1", "/properties/exclude/items"},
      {"ensemble", "zzz = 1\nsystem = 'suslov'\nkeep = ['end.t']", ""},
      {"ensemble", "system = 'suslov'\nkeep = [{ name = 'a', formula = 'b', zzz = 1 }]",
       "/properties/keep/items/anyOf/1"},
      {"ensemble", "system = 'suslov'\nkeep = ['end.t']\nclass = { zzz = 1 }", "/properties/class"},
      {"ensemble", "system = 'suslov'\nkeep = ['end.t']\nhistograms = { a = { zzz = 1 } }",
       "/properties/histograms/additionalProperties/anyOf/1"},
      {"plan", "zzz = 1\nsystem = 'suslov'", ""},
      {"system", "zzz = 1\n" + system, ""},
      {"system", system + "[[state]]\nzzz = 1", "/properties/state/items"},
      {"system", system + "[parameters]\nm = { value = 1, zzz = 1 }",
       "/properties/parameters/additionalProperties/anyOf/1"},
      {"system", system + "[inputs]\nu = { zzz = 1 }", "/properties/inputs/additionalProperties"},
      {"system", system + "[events]\ne = { value = 'x', zzz = 1 }",
       "/properties/events/additionalProperties/anyOf/1"},
      {"system", system + "[outputs]\ne = { value = 'x', zzz = 1 }",
       "/properties/outputs/additionalProperties/anyOf/1"},
      {"system", system + "[[draw]]\nzzz = 1", "/properties/draw/items"},
      {"system", system + "[[draw]]\nshapes = [{ zzz = 1 }]",
       "/properties/draw/items/properties/shapes/items"},
      {"mechanism", "zzz = 1\n" + body + joint, ""},
      {"mechanism", body + "zzz = 1\n" + joint, "/properties/body/items"},
      {"mechanism", body + joint + "zzz = 1", "/properties/joint/items"},
      {"mechanism", body + joint + "[parameters]\nm = { value = 1, zzz = 1 }",
       "/properties/parameters/additionalProperties/anyOf/1"},
      {"mechanism", body + joint + "[events]\ne = { value = 'x', zzz = 1 }",
       "/properties/events/additionalProperties/anyOf/1"},
      {"mechanism", body + joint + "[outputs]\ne = { value = 'x', zzz = 1 }",
       "/properties/outputs/additionalProperties/anyOf/1"},
      {"mechanism", body + joint + "[ground]\nzzz = 1", "/properties/ground"}};
  std::vector<std::string> parts = hamel::mechanisms::names_of(hamel::mechanisms::contact_kinds());
  for (const char* part : {"loop", "prescribed", "spring", "motor", "brake", "force", "torque",
                           "coupling", "sensor", "state"})
    parts.emplace_back(part);
  for (const std::string& part : parts)
    cases.emplace_back("mechanism", body + joint + "[[" + part + "]]\nzzz = 1",
                       "/properties/" + part + "/items");
  for (const auto& [kind, text, pointer] : cases) {
    EXPECT_EQ(keys_of(schema(kind).at(json::json_pointer(pointer))), keys_of(reader(kind, text)))
        << kind << " " << pointer;
  }
}

}  // namespace
