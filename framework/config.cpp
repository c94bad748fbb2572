#include <toml++/toml.h>
#include <fmt/core.h>
#include <nlohmann/json.hpp>
#include <hamel/framework/types.hpp>
#include <string>
namespace hamel { std::string config(); 
std::string config() { auto t = toml::parse("a = 1"); nlohmann::json j; j["a"]=1; return fmt::format("{} {}", t["a"].value_or(0), j.dump()); } }
